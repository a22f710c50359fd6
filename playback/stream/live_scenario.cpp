#include "playback/stream/live_scenario.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/files/folder.h"
#include "base/files/whole_file.h"
#include "base/geodesy/position_limits.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "interop/emitters/emitter_database.h"
#include "scenario/model/posed_platform.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

/// Height (m) above the ground to which positions below it are raised, as by `import`.
constexpr double kAboveGround_m = 2;

/// A folder for files of the running program: that of the user's session, which is in memory, or that for
/// temporary files.
fs::path runtimeFolder() {
  std::error_code ignored;
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  const bool is_usable =
      folder != nullptr && *folder == '/' && access(folder, W_OK) == 0 && fs::is_directory(folder, ignored);
  return is_usable ? fs::path(folder) : fs::temp_directory_path();
}

std::string makeTemporaryFolder() {
  std::string name = (runtimeFolder() / "emscape-live-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error(ErrorCode::other, {name, 0, 0}, "the temporary folder cannot be made");
  return name;
}

/// Lets an object move a platform.
void addObject(LiveScenario& scenario, std::uint64_t key, const std::string& platform, double raise_m,
               bool is_present = true) {
  scenario.objects[key] = {scenario.poses.size(), raise_m};
  scenario.poses.push_back({platform, {}, {}, is_present});
}

bool isThere(const interop::RecordedObject& object) {
  return object.presence.empty() || object.presence.back().is_present;
}

/// The platform of a base that each object moves: of several of one name the first, those that are there
/// before those that are gone.
std::vector<std::optional<std::size_t>> movedPlatforms(const std::vector<interop::RecordedObject>& objects,
                                                       const scenario::Scenario& base) {
  std::vector<std::optional<std::size_t>> moved(objects.size());
  std::vector<bool> is_moved(base.platforms.size());
  for (const bool there : {true, false}) {
    std::vector<std::string> names;
    for (const interop::RecordedObject& object : objects)
      names.push_back(isThere(object) == there ? object.name : "");
    const auto found = interop::movedPlatforms(names, base);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (names[i].empty() || !found[i] || is_moved[*found[i]]) continue;
      moved[i] = found[i];
      is_moved[*found[i]] = true;
    }
  }
  return moved;
}

}  // namespace

LiveScenarioMaker::LiveScenarioMaker(const StreamRequest& request)
    : request_(request), base_(loadScenarioWithTerrain(request.base)), last_(base_) {
  interop::loadEmitterDatabase(request.emitters);  // throws its faults
  if (request.folder.empty()) {
    folder_ = makeTemporaryFolder();
    file_ = (fs::path(folder_) / "live.yaml").string();
  } else {
    makeFolder(request.folder);
    file_ = (fs::path(request.folder) / "live.yaml").string();
    if (!request.replaces) requireNew({file_, fs::path(request.folder) / kLiveField});
  }
}

void LiveScenarioMaker::writeBase() const {
  scenario::saveScenario(*base_.scenario, file_);
  if (!request_.replaces) return;
  // The field is another one's from now on.
  const fs::path field = fs::path(file_).parent_path() / kLiveField;
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(field, ignored).type();
  if (type == fs::file_type::regular || type == fs::file_type::symlink) fs::remove(field, ignored);
}

LiveScenarioMaker::~LiveScenarioMaker() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::shared_ptr<const LiveScenario> LiveScenarioMaker::base() const {
  auto made = std::make_shared<LiveScenario>();
  made->loaded = base_;
  made->emitters = static_cast<int>(base_.scenario->emitters.size());
  keepBase(*made, {});
  return made;
}

/// Where the platforms of the base are that no object moves now.
void LiveScenarioMaker::keepBase(LiveScenario& made, const std::vector<NamedPose>& before) const {
  const auto poseIn = [](const std::vector<NamedPose>& poses, const std::string& platform) {
    return std::find_if(poses.begin(), poses.end(), [&](auto& pose) { return pose.platform == platform; });
  };
  for (const scenario::Platform& platform : base_.scenario->platforms) {
    const auto now = poseIn(made.poses, platform.name);
    if (now != made.poses.end()) {
      if (!now->is_present) made.silent.push_back(platform.name);
      continue;
    }
    const auto last = poseIn(before, platform.name);
    if (last == before.end() || !last->position.height_msl_m) {
      made.untold.push_back(platform.name);
      continue;
    }
    made.poses.push_back(*last);
    made.poses.back().is_present = false;
    made.silent.push_back(platform.name);
  }
}

std::shared_ptr<const LiveScenario> LiveScenarioMaker::make(interop::LiveRecording live,
                                                            const std::vector<NamedPose>& before) {
  auto made = std::make_shared<LiveScenario>();
  interop::Recording& recording = live.recording;
  std::vector<interop::LivePose> poses;
  for (std::size_t i = 0; i < recording.objects.size(); ++i)
    poses.push_back({live.keys[i], recording.objects[i].poses.front()});
  // Platforms of the base that the stream moves.
  const auto moved = movedPlatforms(recording.objects, *base_.scenario);
  std::vector<bool> is_of_base(recording.objects.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    is_of_base[i] = moved[i].has_value();
    if (!moved[i]) continue;
    addObject(*made, live.keys[i], base_.scenario->platforms[*moved[i]].name, 0,
              isThere(recording.objects[i]));
  }
  keepBase(*made, before);
  auto& beams = recording.beams;
  beams.erase(std::remove_if(beams.begin(), beams.end(),
                             [&](const interop::RecordedBeam& beam) { return is_of_base[beam.object]; }),
              beams.end());
  bool adds = !beams.empty();
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    const interop::Domain domain = recording.objects[i].domain;
    adds =
        adds || (!is_of_base[i] && domain != interop::Domain::scenery && domain != interop::Domain::weapon);
  }
  if (!adds) {
    scenario::saveScenario(*base_.scenario, file_);
    made->loaded = last_ = base_;
    made->emitters = static_cast<int>(base_.scenario->emitters.size());
    movePoses(*made, poses, made->poses);
    return made;
  }
  std::unordered_map<std::string, std::uint64_t> key_of;
  for (std::size_t i = 0; i < recording.objects.size(); ++i) {
    interop::RecordedObject& object = recording.objects[i];
    key_of[object.id] = live.keys[i];
    if (is_of_base[i]) {
      object.domain = interop::Domain::scenery;  // which is left out
      continue;
    }
    // Present over the time of the base.
    if (object.presence.empty()) object.presence.push_back({0, true});
    object.presence.push_back({base_.scenario->clock.duration_s, object.presence.back().is_present});
  }
  recording.file = request_.address.text();
  interop::ImportOptions options;
  options.scenario = file_;
  options.base = request_.base;
  options.loaded_base = base_.scenario;
  options.emitters = request_.emitters;
  options.beamwidth = request_.beamwidth;
  options.replace = true;
  options.keeps_name = true;
  const interop::ImportResult result = interop::importRecording(recording, options);
  scenario::ParseResult parsed = scenario::parseScenario(file_);
  if (!parsed.scenario) scenario::loadScenario(file_);  // throws
  made->loaded = last_ = withScenario(last_, parsed.scenario);
  for (const interop::ImportedPlatform& platform : result.platforms)
    addObject(*made, key_of[platform.object], platform.name, platform.raise_m);
  movePoses(*made, poses, made->poses);
  made->emitters = static_cast<int>(parsed.scenario->emitters.size());
  for (const interop::ImportedEmitters& use : result.emitters)
    made->unmatched += use.fault.empty() ? 0 : use.count;
  return made;
}

void movePoses(const LiveScenario& scenario, const std::vector<interop::LivePose>& live,
               std::vector<NamedPose>& poses) {
  const scenario::Terrain* const terrain = scenario.loaded.terrain.get();
  for (const interop::LivePose& object : live) {
    const auto found = scenario.objects.find(object.key);
    if (found == scenario.objects.end()) continue;
    const interop::PoseSample& at = object.pose;
    double ground_m = terrain == nullptr ? 0 : terrain->heightMsl_m(at.latitude_deg, at.longitude_deg);
    if (std::isnan(ground_m)) ground_m = 0;
    double height_m = std::min(at.height_msl_m + found->second.raise_m, PositionLimits::kHighest_m);
    if (height_m < ground_m) height_m = ground_m + kAboveGround_m;
    const scenario::SitePosition position =
        scenario::positionMsl(at.latitude_deg, at.longitude_deg, height_m);
    // Recordings may have no attitude.
    const bool has_attitude = !std::isnan(at.heading_deg);
    const scenario::Attitude attitude =
        has_attitude ? scenario::Attitude{at.heading_deg, at.pitch_deg, at.roll_deg} : scenario::Attitude{};
    if (!scenario::poseFault(position, attitude).empty()) continue;
    NamedPose& pose = poses[found->second.pose];
    pose.position = position;
    pose.attitude = attitude;
  }
}

}  // namespace emscape::playback
