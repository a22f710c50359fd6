/// A battlefield that another program streams, in the window.
#include <fmt/format.h>

#include "apps/view/session/session.h"
#include "base/text/failure_text.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::view {
namespace {

constexpr double kStatus_s = 0.25;  ///< between two readings of the stream's status
constexpr double kMoving_s = 1.0 / 30, kResting_s = 0.25;

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
  if (!is_other && !stream_.is_moving) return;
  stream_.poses = now.poses;
  stream_.arrival_s = now.arrival_s;
  if (is_other) {
    stream_.scenario = now.scenario;
    adoptStreamed();
  } else {
    live_.pose(playback::posesOf(stream_.indices, *stream_.poses, stream_.arrival_s));
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
  live_.pose(playback::posesOf(indices, *stream_.poses, stream_.arrival_s), shown_scenario_);
}

double Session::untilStream_s() const {
  return stream_.is_moving ? kMoving_s : kResting_s;
}

}  // namespace emscape::view
