/// A battlefield that another program streams, in the window.
#include <fmt/format.h>

#include <algorithm>

#include "apps/view/session/session.h"
#include "base/text/failure_text.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::view {
namespace {

constexpr double kStatus_s = 0.25;  ///< between two readings of the stream's status
constexpr double kMoving_s = 1.0 / 30, kResting_s = 0.25;
constexpr double kTitle_s = 1;  ///< between two times in the title while nothing moves

}  // namespace

/// Shows the present battlefield: other platforms and emitters as another scenario, to which the user's edits
/// are applied, and movements as poses.
void Session::takeStream() {
  if (!options_.stream || !edits_) return;
  const double now_s = log_.now_s();
  if (now_s - stream_.told_s > kStatus_s) {
    stream_.told_s = now_s;
    const playback::StreamStatus status = options_.stream->status();
    const std::string text = status.text();
    if (text != stream_.text) touched_ = true;
    stream_.text = text;
    stream_.records = status.records;
    stream_.entities = status.entities;
    const bool has_trouble = !status.trouble.empty();
    if (has_trouble != stream_.has_trouble) {
      if (has_trouble) {
        tell("live: " + status.trouble, true);
      } else {
        tell("the stream is well again");
      }
    }
    stream_.has_trouble = has_trouble;
  }
  const playback::BattlefieldNow now = options_.stream->now();
  const bool is_other = now.scenario != stream_.scenario;
  if (is_other && (edit_queue_.isBusy() || isDragging())) return;  // after the edit
  stream_.is_moving = now.poses != stream_.poses;
  // Records that move nothing, and their end, are told by the title.
  const bool is_told = now.has_stopped == stream_.has_stopped && now.arrival_s < stream_.arrival_s + kTitle_s;
  if (!is_other && !stream_.is_moving && is_told) return;
  stream_.poses = now.poses;
  stream_.arrival_s = now.arrival_s;
  stream_.has_stopped = now.has_stopped;
  if (is_other) {
    stream_.scenario = now.scenario;
    adoptStreamed();
  } else {
    live_.pose(streamedPoses());
  }
}

void Session::adoptStreamed() {
  playback::ScenarioPtr scenario = stream_.scenario;
  const std::vector<scenario::Edit> edits = edits_->edits();
  try {
    if (!edits.empty()) scenario = playback::edited(scenario, edits);
  } catch (const Error& error) {
    tell("the edits do not apply to the present objects, and are dropped: " + failureText(error), true);
  }
  edit_queue_.clear(*edits_);
  edits_.emplace(scenario);
  undo_order_.forget(History::scenario);
  opened_unsaved_ = scenario != stream_.scenario;
  showScenario({});  // objects keep their names
  log_.write("stream", {{"platforms", scenario->platforms.size()}, {"emitters", scenario->emitters.size()}});
}

/// Finds the platforms that the stream moves in the shown scenario, and shows them where they are.
void Session::indexStreamed() {
  if (!options_.stream || !stream_.scenario) return;
  playback::PlatformIndices& indices = stream_.indices;
  indices = playback::platformIndices(*shown_scenario_);
  for (const scenario::Platform& platform : stream_.scenario->platforms) {
    const auto renamed = indices.find(playback::nameAfter(edits_->edits(), "platforms", platform.name));
    if (renamed != indices.end()) indices[platform.name] = renamed->second;
  }
  live_.pose(streamedPoses(), shown_scenario_);
}

playback::PosesPtr Session::streamedPoses() const {
  return playback::posesOf(stream_.indices, *stream_.poses, stream_.arrival_s, stream_.has_stopped);
}

std::string Session::streamTitle() const {
  if (!options_.stream) return "";
  return stream_.arrival_s <= 0 ? "live, nothing received" : stream_.has_stopped ? "live, stopped" : "live";
}

void Session::requireMovable(const std::string& platform) const {
  if (!options_.stream || !stream_.poses || !shown_scenario_) return;
  for (const playback::NamedPose& pose : *stream_.poses) {
    const auto at = stream_.indices.find(pose.platform);
    if (!pose.position.height_msl_m || at == stream_.indices.end()) continue;
    if (shown_scenario_->platforms[static_cast<std::size_t>(at->second)].name != platform) continue;
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' cannot be put elsewhere: it is where the stream has it", platform));
  }
}

void Session::requireMovable(const std::vector<scenario::Edit>& edits) const {
  if (!options_.stream || !shown_scenario_) return;
  for (const scenario::Platform& platform : shown_scenario_->platforms) {
    const std::string path = "platforms." + scenario::pathStep(platform.name) + ".";
    const auto isOfPlace = [&](const scenario::Edit& edit) {
      if (edit.path.compare(0, path.size(), path) != 0) return false;
      const std::string key = edit.path.substr(path.size(), edit.path.find('.', path.size()) - path.size());
      return key == "position" || key == "track" || key == "attitude";
    };
    if (std::any_of(edits.begin(), edits.end(), isOfPlace)) requireMovable(platform.name);
  }
}

double Session::untilStream_s() const {
  return stream_.is_moving ? kMoving_s : kResting_s;
}

}  // namespace emscape::view
