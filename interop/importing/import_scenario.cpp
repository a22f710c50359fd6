#include "interop/import_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include "base/files/folder.h"
#include "base/files/whole_file.h"
#include "base/text/count_text.h"
#include "base/text/utc.h"
#include "document/schema_check.h"
#include "document/text_edit.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/terrain/terrain.h"
#include "interop/emitters/emitter_database.h"
#include "interop/importing/emitter_nodes.h"
#include "interop/importing/held_beams.h"
#include "interop/importing/platforms.h"
#include "interop/importing/scenario_text.h"
#include "interop/importing/type_text.h"
#include "recording/common/ticks.h"
#include "recording/dis/pdu.h"

namespace emscape::interop {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPlatforms = 10000;  ///< of the scenario format

/// Why an object is not imported; empty if it is.
std::string reasonToLeaveOut(const RecordedObject& object, bool has_beams, const ImportOptions& options,
                             const TimeSpan& window) {
  const bool is_chosen =
      std::any_of(options.only.begin(), options.only.end(), [&](const std::string& pattern) {
        return matchesPattern(pattern, object.name) || matchesPattern(pattern, object.type) ||
               matchesPattern(pattern, object.keys.acmi_name);
      });
  if (!options.only.empty() && !is_chosen) return "not named by --only";
  const bool is_within = object.poses.front().t_s <= window.end_s &&
                         (object.poses.back().t_s >= window.begin_s || object.poses.size() == 1);
  if (!is_within) return "outside the chosen times";
  if (options.only.empty() && object.domain == Domain::scenery && !has_beams) return "scenery";
  if (options.only.empty() && object.domain == Domain::weapon && !has_beams)
    return "weapons without emission";
  return "";
}

/// A step (s) of 1, 2 or 5 times a power of ten that makes about 120 volumes.
double stepOf(double duration_s) {
  const double wanted = std::max(duration_s / 120, 0.1);
  const double power = std::pow(10.0, std::floor(std::log10(wanted) + 1e-9));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (wanted <= factor * power * 1.0001) return factor * power;
  }
  return 10 * power;
}

/// The part of a recording that is imported.
TimeSpan windowOf(const Recording& recording, const ImportOptions& options) {
  const TimeSpan recorded = spanOf(recording);
  if (!options.times) return recorded;
  if (options.times->begin_s > recorded.end_s || options.times->end_s < recorded.begin_s) {
    throw Error(ErrorCode::usage,
                fmt::format("--times {}:{} is outside the recording, {:.3f} to {:.3f} s",
                            options.times->begin_s, options.times->end_s, recorded.begin_s, recorded.end_s));
  }
  return {options.times->begin_s, std::min(options.times->end_s, recorded.end_s)};
}

/// The first names of a list and the number of the others.
std::string firstOf(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kShown));
  std::string text = fmt::format("'{}'", fmt::join(names.begin(), end, "', '"));
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

/// An object that becomes a platform.
struct Chosen {
  const RecordedObject* object = nullptr;
  std::vector<const RecordedBeam*> beams;
  std::string name;                    ///< of its platform
  std::optional<std::size_t> moves{};  ///< the platform of the base that it moves
  std::vector<DocumentNodePtr> emitters;
  std::vector<PoseSample> track;
};

class Importer {
 public:
  Importer(const Recording& recording, const ImportOptions& options, const ProgressSink& progress)
      : recording_(recording),
        options_(options),
        progress_(progress),
        window_(windowOf(recording, options)),
        folder_(fs::absolute(options.scenario).parent_path()),
        stem_(fs::path(options.scenario).stem().string()) {}

  ImportResult run() {
    choose();
    makeEmitters();
    loadTerrain();
    makeTracks();
    tellWhatIsMissing();
    write();
    return std::move(result_);
  }

 private:
  void tell(const std::string& step, double part) const {
    if (progress_) progress_(step, part);
  }

  void choose();
  void placeInTime();
  void makeEmitters();
  void loadTerrain();
  void makeTracks();
  void addSilentEmitter();
  void tellNames(const std::vector<std::string>& numbered);
  void tellWhatIsMissing();
  void write();
  std::string headerText() const;

  const Recording& recording_;
  const ImportOptions& options_;
  const ProgressSink& progress_;
  TimeSpan window_;
  fs::path folder_;
  std::string stem_;
  double origin_s_ = 0, duration_s_ = 0;
  std::shared_ptr<const scenario::Scenario> base_;
  std::vector<RecordedObject> shifted_;  ///< the chosen objects, with times from origin_s_ on
  std::vector<RecordedBeam> beams_;      ///< the same of beams
  std::vector<Chosen> chosen_;
  std::vector<double> raise_m_;
  scenario::TerrainPtr terrain_;
  ImportResult result_;
};

void Importer::choose() {
  base_ = options_.loaded_base;
  if (!base_ && !options_.base.empty())
    base_ = scenario::loadScenario(options_.base, {}, scenario::ReadFor::chosen_times);
  std::vector<int> beam_counts(recording_.objects.size());
  for (const RecordedBeam& beam : recording_.beams) ++beam_counts[beam.object];
  std::vector<std::size_t> kept_as(recording_.objects.size(), recording_.objects.size());
  for (std::size_t i = 0; i < recording_.objects.size(); ++i) {
    const RecordedObject& object = recording_.objects[i];
    const std::string reason = reasonToLeaveOut(object, beam_counts[i] > 0, options_, window_);
    if (!reason.empty()) {
      ++result_.left_out[reason];
      continue;
    }
    kept_as[i] = shifted_.size();
    shifted_.push_back(object);
  }
  if (shifted_.empty())
    throw Error(ErrorCode::bad_input, {recording_.file, 0, 0},
                "no object is left; --only chooses by name and type");
  if (shifted_.size() > kMaxPlatforms) {
    throw Error(
        ErrorCode::bad_input, {recording_.file, 0, 0},
        fmt::format("{} objects, more than the {} platforms of a scenario; choose with --only or --times",
                    shifted_.size(), kMaxPlatforms));
  }
  placeInTime();
  for (const RecordedBeam& beam : recording_.beams) {
    if (kept_as[beam.object] == recording_.objects.size()) continue;
    beams_.push_back(beam);
    beams_.back().states = withDirections(beam, recording_.objects);
    beams_.back().object = kept_as[beam.object];
    for (BeamState& state : beams_.back().states) state.t_s -= origin_s_;
  }
}

void Importer::placeInTime() {
  // Without --times t = 0 is the first position of a chosen object, so that one is there then.
  origin_s_ = window_.begin_s;
  if (!options_.times) {
    origin_s_ = window_.end_s;
    for (const RecordedObject& object : shifted_) origin_s_ = std::min(origin_s_, object.poses.front().t_s);
  }
  for (RecordedObject& object : shifted_) {
    for (PresenceSample& sample : object.presence) sample.t_s -= origin_s_;
    for (PoseSample& pose : object.poses) pose.t_s -= origin_s_;
  }
  // To the millisecond before the last position, but for the rounding of a recording's ticks.
  const double length_s = window_.end_s - origin_s_ + kTickRounding_s / 2;
  duration_s_ = std::max(std::floor(length_s * 1000) / 1000, 0.0);
}

void Importer::makeEmitters() {
  tell("matching emitters", 0);
  EmitterDatabase database = loadEmitterDatabase(options_.emitters);
  describeRecording(database, shifted_, beams_);
  UniqueNames platform_names, emitter_names;
  if (base_) {
    for (const scenario::Platform& platform : base_->platforms) platform_names.unique(platform.name);
    for (const scenario::Emitter& emitter : base_->emitters) emitter_names.unique(emitter.name);
  }
  // An end beyond the last step, as a time interval does not include its end.
  EmitterMaker maker(database, folder_, options_.beamwidth, {0, duration_s_ + 1}, emitter_names);
  std::vector<std::vector<const RecordedBeam*>> beams_of(shifted_.size());
  for (const RecordedBeam& beam : beams_) beams_of[beam.object].push_back(&beam);
  std::map<std::string, ImportedType> types;
  std::vector<std::string> names;
  for (const RecordedObject& object : shifted_) names.push_back(object.name);
  const auto moved = base_ ? movedPlatforms(names, *base_)
                           : std::vector<std::optional<std::size_t>>(shifted_.size(), std::nullopt);
  for (std::size_t i = 0; i < shifted_.size(); ++i) {
    Chosen chosen;
    chosen.object = &shifted_[i];
    chosen.moves = moved[i];
    std::vector<const scenario::Emitter*> present;
    if (moved[i]) {
      chosen.name = base_->platforms[*moved[i]].name;
      result_.moved.push_back(chosen.name);
      for (const scenario::Emitter& emitter : base_->emitters) {
        if (static_cast<std::size_t>(emitter.platform) == *moved[i]) present.push_back(&emitter);
      }
    } else {
      chosen.name = platform_names.unique(shifted_[i].name);
    }
    chosen.beams = std::move(beams_of[i]);
    double height_m = 0;
    chosen.emitters = maker.make(*chosen.object, chosen.beams, chosen.name, present, height_m);
    if (moved[i]) height_m = 0;  // a platform of the base is where its antennas are
    raise_m_.push_back(height_m);
    result_.platforms.push_back({chosen.object->id, chosen.name, height_m});
    ImportedType& type = types[shifted_[i].type];
    type.type = shifted_[i].type.empty() ? "without a type" : shifted_[i].type;
    type.text = typeText(shifted_[i]);
    type.domain = shifted_[i].domain;
    ++type.objects;
    type.emitters += static_cast<int>(chosen.emitters.size());
    chosen_.push_back(std::move(chosen));
  }
  for (auto& [name, type] : types) result_.types.push_back(type);
  result_.emitters = maker.uses();
  result_.notes = maker.notes();
  tellNames(platform_names.numbered());
  const auto silent = std::count_if(chosen_.begin(), chosen_.end(), [](const Chosen& chosen) {
    return chosen.beams.empty() && chosen.emitters.empty() && !chosen.moves;
  });
  if (!database.starter_serves_objects && silent > 0) {
    result_.notes.push_back(
        fmt::format("objects that tell no emission, and that no row of {} matches: {}; they have no emitter",
                    fs::path(options_.emitters).filename().string(), silent));
  }
  const bool has_emitter =
      std::any_of(chosen_.begin(), chosen_.end(), [](const Chosen& c) { return !c.emitters.empty(); });
  if (has_emitter || base_) return;
  if (options_.adds_silent_emitter) return addSilentEmitter();
  std::string unmatched;
  for (const ImportedEmitters& use : result_.emitters)
    unmatched += (unmatched.empty() ? ": " : "; ") + use.name + " (" + use.fault + ")";
  throw Error(
      ErrorCode::bad_input, {recording_.file, 0, 0},
      fmt::format(
          "no emitter is left of {}{}. Add the objects to a scenario with emitters (--base FILE), give "
          "a database that matches them (--emitters FILE; docs/battlefield.md), or name the file as the "
          "track of a platform in a scenario: 'track: {{file: {}{}}}'",
          countText(shifted_.size(), "object", "objects"), unmatched.substr(0, 300),
          document::flowText(*textNode(fs::path(recording_.file).filename().string()), true),
          shifted_.size() == 1 ? ""
                               : ", object: " + document::flowText(*textNode(shifted_.front().name), true)));
}

void Importer::addSilentEmitter() {
  Chosen& first = chosen_.front();
  result_.silent_emitter = first.name + " transmitter";
  first.emitters.push_back(MapBuilder()
                               .set("name", textNode(result_.silent_emitter))
                               .set("platform", textNode(first.name))
                               .set("kind", textNode("transmitter"))
                               .set("enabled", booleanNode(false))
                               .set("frequency_hz", numberNode(300e6))
                               .set("power_w", numberNode(100))
                               .set("antenna", MapBuilder().set("pattern", textNode("isotropic")).node())
                               .node());
}

void Importer::tellNames(const std::vector<std::string>& numbered) {
  if (base_) {
    int emitters = 0;
    for (const Chosen& chosen : chosen_) emitters += static_cast<int>(chosen.emitters.size());
    std::string text;
    if (!result_.moved.empty()) {
      text =
          fmt::format("the recording moves {} of the base, whose emitters, receivers and targets stay: {}; ",
                      countText(result_.moved.size(), "platform", "platforms"), firstOf(result_.moved));
    }
    result_.notes.push_back(
        text + fmt::format("added to the base: {}, {}",
                           countText(chosen_.size() - result_.moved.size(), "platform", "platforms"),
                           countText(emitters, "emitter", "emitters")));
  }
  if (const std::string text = base_ ? farEpochText(recording_.epoch_ms, *base_) : ""; !text.empty())
    result_.notes.push_back(text);
  if (numbered.empty()) return;
  result_.notes.push_back(fmt::format("{} a name that is in use, and a number after it: {}",
                                      countText(numbered.size(), "object has", "objects have"),
                                      firstOf(numbered)));
}

void Importer::loadTerrain() {
  scenario::TerrainSpec spec;
  if (!options_.terrain.empty()) {
    spec.files = options_.terrain;
  } else if (base_ && base_->terrain) {
    spec = *base_->terrain;
  } else {
    return;
  }
  tell("reading terrain", 0);
  scenario::GeoBox box{90, -90, 0, 0};
  double west = 1e9, east = -1e9;
  const double centre = shifted_.front().poses.front().longitude_deg;
  for (const RecordedObject& object : shifted_) {
    for (const PoseSample& pose : object.poses) {
      box.south_deg = std::min(box.south_deg, pose.latitude_deg);
      box.north_deg = std::max(box.north_deg, pose.latitude_deg);
      const double longitude_deg = centre + std::remainder(pose.longitude_deg - centre, 360);
      west = std::min(west, longitude_deg);
      east = std::max(east, longitude_deg);
    }
  }
  constexpr double kMargin_deg = 0.01;
  box.south_deg = std::max(box.south_deg - kMargin_deg, -90.0);
  box.north_deg = std::min(box.north_deg + kMargin_deg, 90.0);
  const double turn_deg = 360 * std::floor((west + 180) / 360);
  box.west_deg = west - kMargin_deg - turn_deg;
  box.east_deg = std::min(east + kMargin_deg - turn_deg, box.west_deg + 360);
  terrain_ = scenario::Terrain::load(spec, box);
  for (const std::string& warning : terrain_->warnings()) result_.notes.push_back(warning);
}

void Importer::makeTracks() {
  Raised raised;
  const TimeSpan window{window_.begin_s - origin_s_, window_.end_s - origin_s_};
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    tell("writing tracks", static_cast<double>(i) / static_cast<double>(chosen_.size()));
    chosen_[i].track = trackOf(*chosen_[i].object, window, raise_m_[i], terrain_.get(), raised);
  }
  if (raised.without_ground > 0) {
    result_.notes.push_back(
        fmt::format("{} where the elevation files have no height; the ground is taken at mean sea level "
                    "there. Give more files (--terrain), or a part of the area (--region, --only)",
                    countText(raised.without_ground, "position is", "positions are")));
  }
  if (raised.positions > 0) {
    result_.notes.push_back(
        fmt::format("{} up to {:.1f} m below {} and raised to 2 m above it",
                    countText(raised.positions, "position was", "positions were"), raised.deepest_m,
                    terrain_ ? "the ground" : "mean sea level, the ground without terrain"));
  }
}

void Importer::tellWhatIsMissing() {
  if (base_) return;
  result_.notes.push_back(fmt::format(
      "recordings have no {}ground, atmosphere, targets or receivers: {}average ground and the standard "
      "atmosphere are assumed; {}a scenario that has them is given by --base",
      options_.terrain.empty() ? "terrain, " : "",
      options_.terrain.empty() ? "flat land at mean sea level, " : "",
      options_.terrain.empty() ? "elevation files are given by --terrain, " : ""));
}

std::string Importer::headerText() const {
  const auto nameOf = [](const std::string& file) { return fs::path(file).filename().string(); };
  std::string text =
      fmt::format("Imported from {} ({}) by emscape import", nameOf(recording_.file), recording_.format);
  if (!options_.base.empty()) text += ", added to " + nameOf(options_.base);
  text += fmt::format(": {}, {:.6g} s.\n", countText(chosen_.size(), "object", "objects"), duration_s_);
  for (const ImportedEmitters& use : result_.emitters) {
    if (use.fault.empty() && !use.source.empty())
      text += fmt::format("{} x {}: {}\n", use.count, use.name, use.source);
    if (!use.fault.empty()) text += fmt::format("left out, {} x {}: {}\n", use.count, use.name, use.fault);
  }
  return text;
}

void Importer::write() {
  ScenarioParts parts;
  parts.header = headerText();
  if (!options_.keeps_name) parts.name = stem_.empty() ? "imported" : stem_;
  if (recording_.epoch_ms) parts.epoch_utc = utcText(*recording_.epoch_ms + std::llround(origin_s_ * 1000));
  parts.duration_s = duration_s_;
  parts.step_s = stepOf(duration_s_);
  parts.terrain = options_.terrain;
  std::vector<std::vector<PoseSample>> tracks;
  std::vector<OutputFile> files;
  const std::string tracks_name = stem_ + "_tracks";
  std::set<std::string> file_names;
  for (Chosen& chosen : chosen_) {
    std::string track_file;
    if (!isFixed(chosen.track)) {
      std::string name;
      for (const char c : chosen.name.substr(0, 60)) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
        name += is_plain ? c : '_';
      }
      // File systems may not distinguish upper and lower case.
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
      std::string unique = name;
      for (int n = 2; !file_names.insert(unique).second; ++n) unique = fmt::format("{}_{}", name, n);
      track_file = tracks_name + "/" + unique + ".csv";
      files.push_back(
          {folder_ / track_file, [&chosen](std::ostream& stream) { stream << trackCsv(chosen.track); }});
    }
    const DocumentNodePtr platform =
        platformNode(chosen.name, chosen.object->side, chosen.track.front(), track_file);
    if (chosen.moves) {
      parts.moved[*chosen.moves] = platform;
    } else {
      parts.platforms.push_back(platform);
    }
    parts.emitters.insert(parts.emitters.end(), chosen.emitters.begin(), chosen.emitters.end());
    tracks.push_back(chosen.track);
  }
  if (options_.region) {
    parts.region = regionOf(options_.region->latitude_deg, options_.region->longitude_deg,
                            options_.region->size_km * 1000, tracks);
  } else if (!base_) {
    parts.region = regionAround(tracks);
  }
  const std::string text = base_ ? scenarioTextOnBase(*base_, parts, folder_) : scenarioText(parts, folder_);
  result_.track_files = static_cast<int>(files.size());
  files.push_back({options_.scenario, [&text](std::ostream& stream) { stream << text; }});
  if (!options_.replace) {
    std::vector<fs::path> names;
    for (const OutputFile& file : files) names.push_back(file.path);
    requireNew(names);
  }
  if (result_.track_files > 0) {
    makeFolderIn(folder_, tracks_name);
    result_.tracks = (fs::path(options_.scenario).parent_path() / tracks_name).string();
  }
  try {
    writeWhole(files, options_.replace ? Replaces::any : Replaces::nothing);
  } catch (...) {
    std::error_code ignored;
    if (result_.track_files > 0) fs::remove(fs::path(folder_) / tracks_name, ignored);  // if it is empty
    throw;
  }
  result_.scenario = options_.scenario;
  result_.format = recording_.format;
  result_.epoch_utc = parts.epoch_utc;
  result_.recorded = spanOf(recording_);
  result_.duration_s = duration_s_;
  result_.tally = recording_.tally;
}

}  // namespace

std::vector<std::optional<std::size_t>> movedPlatforms(const std::vector<std::string>& objects,
                                                       const scenario::Scenario& base) {
  std::vector<std::optional<std::size_t>> moved(objects.size());
  std::vector<bool> is_moved(base.platforms.size());
  for (const bool is_exact : {true, false}) {
    std::unordered_multimap<std::string, std::size_t> platforms;  // of a name as it would be told
    for (std::size_t p = 0; p < base.platforms.size(); ++p) {
      const std::string& name = base.platforms[p].name;
      platforms.emplace(is_exact ? name : name.substr(0, dis::kMarkingBytes), p);
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (moved[i] || (!is_exact && objects[i].size() != dis::kMarkingBytes)) continue;
      std::optional<std::size_t> first;
      const auto [begin, end] = platforms.equal_range(objects[i]);
      for (auto found = begin; found != end; ++found) {
        if (!is_moved[found->second] && (!first || found->second < *first)) first = found->second;
      }
      if (!first) continue;
      moved[i] = first;
      is_moved[*first] = true;
    }
  }
  return moved;
}

RegionRequest parseRegion(const std::string& text) {
  RegionRequest request;
  double* const values[] = {&request.latitude_deg, &request.longitude_deg, &request.size_km};
  std::size_t begin = 0, count = 0;
  for (; count < 3 && begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto value = document::numberOf(text.substr(begin, end - begin));
    if (!value) break;
    *values[count] = *value;
    begin = end + 1;
  }
  const bool is_sound = count == 3 && begin == text.size() + 1 && std::abs(request.latitude_deg) <= 90 &&
                        std::abs(request.longitude_deg) <= 180 && request.size_km >= 0.1 &&
                        request.size_km <= 4000;
  if (!is_sound) {
    throw Error(
        ErrorCode::usage,
        fmt::format("--region '{}' is not auto or LAT,LON,SIZE_KM: latitude -90..90 deg, longitude -180..180 "
                    "deg, size 0.1..4000 km, such as 36.30,-84.25,80",
                    text));
  }
  return request;
}

ImportResult importRecording(const Recording& recording, const ImportOptions& options,
                             const ProgressSink& progress) {
  return Importer(recording, options, progress).run();
}

}  // namespace emscape::interop
