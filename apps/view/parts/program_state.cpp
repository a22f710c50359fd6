#include "apps/view/parts/program_state.h"

#include <fmt/format.h>

#include <cmath>

#include "emscape/base/enum_names.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/scenario/model/quantities.h"
#include "playback/frames/busy_field.h"

namespace emscape::view {
namespace {

/// Fields that take longer are explained.
constexpr double kExplainedAfter_s = 0.3;
/// A picture that is farther behind while playing is told.
constexpr double kToldLag_s = 0.5;

Activity activityOf(const ProgramFacts& facts, const playback::LiveStatus& status) {
  const bool begins = facts.has_input && (!facts.has_picture || (!facts.has_field && status.computing));
  if (facts.opening || begins) return Activity::opening;
  if (!facts.has_picture) return Activity::empty;
  if (facts.is_playing) return Activity::playing;
  const bool moves = status.column_step > 1 && !facts.has_pending_edits;
  if (moves) return Activity::busy;
  if (status.computing || status.searching || facts.has_pending_edits) return Activity::computing;
  switch (status.state) {
    case render::ControllerState::busy:
      return Activity::busy;
    case render::ControllerState::restore:
      return Activity::restore;
    case render::ControllerState::idle:
      break;
  }
  // Until the picture with the last rays is published.
  return status.exact || status.failed ? Activity::idle : Activity::restore;
}

/// Time (s, of the user) by which the picture is behind while playing; negative after a jump.
double lagOf(const ProgramFacts& facts, const playback::LiveStatus& status) {
  const bool is_known = facts.has_picture && facts.has_field && facts.rate != 0;
  return is_known ? (status.asked_s - status.shown_s) / facts.rate : 0;
}

/// With the title of the quantity in place of its name.
std::string textOf(const WorkProgress& progress) {
  std::string what = progress.what;
  const std::string name = what.substr(0, what.rfind(" at "));
  const std::string quantity = name.substr(0, name.find(':'));
  for (const scenario::QuantityInfo& info : scenario::quantityTable()) {
    if (info.name == quantity) what = render::quantityTitle(name, info.unit) + what.substr(name.size());
  }
  return progress.part.empty() ? what : what + ": " + progress.part;
}

std::string pictureText(const playback::LiveStatus& status, bool is_computing) {
  if (is_computing) return "the picture shows the field before";
  const char* const exactness = status.exact ? "exact" : "approximate";
  if (!status.cells.empty()) return fmt::format("{}, {}", exactness, status.cells);
  if (status.column_step > 1) return "approximate, " + playback::columnsText(status.column_step);
  if (status.exact) return fmt::format("exact, {} rays", render::toString(render::Pattern::full));
  // Complete, but a change of the view, or of what labels stand for, is not drawn yet.
  if (status.pattern == render::Pattern::full) return "the picture shows the view before";
  return fmt::format("approximate, {} rays ({:.0f} %)", render::toString(status.pattern),
                     100 * status.rays_fraction);
}

}  // namespace

ProgramState programState(const ProgramFacts& facts, const playback::LiveStatus& status) {
  ProgramState state;
  state.activity = activityOf(facts, status);
  state.stream = facts.stream;
  state.badge = emscape::toString(state.activity);
  const bool is_long = facts.computing_s > kExplainedAfter_s;
  switch (state.activity) {
    case Activity::opening: {
      const WorkProgress& progress = facts.opening ? facts.opening->progress : status.progress;
      state.what = textOf(progress);
      if (facts.opening) state.what = facts.opening->file + (state.what.empty() ? "" : ": " + state.what);
      state.fraction = progress.fraction;
      state.can_cancel = true;
      break;
    }
    case Activity::playing:
      state.what = fmt::format("× {:g}", facts.rate);
      if (const double lag_s = lagOf(facts, status); lag_s > kToldLag_s)
        state.what += fmt::format(", {:.1f} s behind", lag_s);
      if (status.fields_per_s > 0) state.what += fmt::format(", {:.1f} fields/s", status.fields_per_s);
      if (status.column_step > 1) state.what += ", " + playback::columnsText(status.column_step);
      if (status.computing && is_long && status.fields_per_s < 1) {
        state.what += ", " + textOf(status.progress);
        state.fraction = status.progress.fraction;
      }
      state.can_cancel = true;
      break;
    case Activity::computing:
      state.can_cancel = status.computing || facts.has_pending_edits;
      if (facts.has_pending_edits && !status.computing) {
        state.what = "the scenario is read with the change";
      } else if (is_long || status.searching) {
        state.what = textOf(status.progress);
        state.fraction = status.progress.fraction;
      }
      break;
    default:
      break;
  }
  if (state.fraction >= 0) state.badge += fmt::format(" {:.0f} %", std::floor(100 * state.fraction));
  if (facts.has_picture && !facts.has_field) {
    state.picture = "without the field";
  } else if (facts.has_picture && status.failed && state.activity == Activity::idle) {
    state.what = "NOT COMPUTED: " + status.error;
    state.picture = "the picture shows the field before";
  } else if (facts.has_picture && state.activity != Activity::playing) {
    state.picture = pictureText(status, state.activity == Activity::computing && status.computing);
  }
  return state;
}

}  // namespace emscape::view
