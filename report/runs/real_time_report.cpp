#include "report/runs/real_time_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace emscape::report {
namespace {

using render::ControllerState;

/// Rounds to microseconds.
double rounded(double value) {
  return std::round(value * 1000) / 1000;
}

template <class Value>
Json optionalJson(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

double heldPerSecond(const RealTimeReport& report) {
  const auto frames = static_cast<double>(report.totals.busy);
  return report.due > 0 ? report.frames_per_s * frames / static_cast<double>(report.due) : 0;
}

/// Fraction of the busy frames with this pattern.
double fractionOf(render::Pattern pattern, const playback::RealTimeTotals& totals) {
  const auto found = totals.frames_of.find(pattern);
  if (found == totals.frames_of.end()) return 0;
  return static_cast<double>(found->second) / static_cast<double>(totals.busy);
}

/// {median, max} of the events; null if there are none.
Json abortLatencies(const std::vector<RealTimeEvent>& events) {
  std::vector<double> latencies_ms;
  for (const RealTimeEvent& event : events) {
    if (event.abort_latency_ms) latencies_ms.push_back(*event.abort_latency_ms);
  }
  if (latencies_ms.empty()) return nullptr;
  std::sort(latencies_ms.begin(), latencies_ms.end());
  return {{"median", rounded(latencies_ms[latencies_ms.size() / 2])}, {"max", rounded(latencies_ms.back())}};
}

Json toJson(const RealTimeEvent& event) {
  return {{"time_s", rounded(event.time_ms / 1000)},
          {"scenario_s", event.scenario_s},
          {"state", render::toString(event.state)},
          {"pattern", render::toString(event.pattern)},
          {"rays", event.rays},
          {"field_ms", rounded(event.field_ms)},
          {"column_step", event.column_step},
          {"prepare_ms", rounded(event.prepare_ms)},
          {"cast_ms", rounded(event.cast_ms)},
          {"interpolate_ms", rounded(event.interpolate_ms)},
          {"labels_ms", rounded(event.labels_ms)},
          {"abort_latency_ms", optionalJson(event.abort_latency_ms)},
          {"late", event.late},
          {"restored", event.restored},
          {"equals_full", optionalJson(event.equals_full)},
          {"reason", event.reason.empty() ? Json(nullptr) : Json(event.reason)}};
}

}  // namespace

std::string lineOf(const RealTimeEvent& event) {
  std::string line = fmt::format("{:8.3f} s  t = {:<8g} {:<7} {:<8}", event.time_ms / 1000, event.scenario_s,
                                 render::toString(event.state), render::toString(event.pattern));
  if (event.state == ControllerState::idle) {
    if (event.equals_full) line += *event.equals_full ? "  equals a full cast" : "  DIFFERS FROM A FULL CAST";
    return line;
  }
  line += fmt::format("  {:8} rays  cast {:6.1f} ms", event.rays, event.cast_ms);
  if (event.interpolate_ms > 0) line += fmt::format("  interpolate {:4.1f} ms", event.interpolate_ms);
  if (event.field_ms > 0) {
    line += fmt::format("  field {:5.1f} ms, ready after {:4.1f} ms", event.field_ms, event.prepare_ms);
  }
  if (event.labels_ms > 0) line += fmt::format("  labels {:5.1f} ms", event.labels_ms);
  if (event.abort_latency_ms)
    line += fmt::format("  begun {:.2f} ms after the event", *event.abort_latency_ms);
  if (event.state == ControllerState::restore && !event.restored) line += "  aborted";
  if (event.late) line += "  late";
  if (!event.reason.empty()) line += "  (" + event.reason + ")";
  return line;
}

std::string summaryOf(const RealTimeReport& report) {
  const playback::RealTimeTotals& totals = report.totals;
  std::string text = fmt::format(
      "{} frames in {:.1f} s; {:g} per second requested, {:.2f} achieved; {} late, {} dropped", totals.busy,
      report.seconds, report.frames_per_s, heldPerSecond(report), totals.late, report.due - totals.busy);
  for (const render::Pattern pattern : render::allPatterns()) {
    const double fraction = fractionOf(pattern, totals);
    if (fraction > 0) text += fmt::format("; {} {:.0f} %", render::toString(pattern), 100 * fraction);
  }
  text += fmt::format("\nrestored {}, aborted {}", totals.restores_done, totals.restores_aborted);
  if (totals.max_abort_latency_ms) {
    text += fmt::format(" (next frame at most {:.2f} ms after the event)", *totals.max_abort_latency_ms);
  }
  text += fmt::format("; settled {}", totals.settled);
  if (totals.compared > 0)
    text += fmt::format(", equal to a full cast {} of {}", totals.equal, totals.compared);
  if (report.field_updates_interpolated > 0) {
    text += fmt::format("\n{} of {} fields have interpolated columns; --rays full computes all of them",
                        report.field_updates_interpolated, report.field_updates);
  }
  if (report.field_steps_skipped > 0) {
    text += fmt::format("\n{} steps of the field came too fast and were skipped", report.field_steps_skipped);
  }
  return text;
}

Json toJson(const RealTimeReport& report) {
  const playback::RealTimeTotals& totals = report.totals;
  Json patterns = Json::object();
  for (const render::Pattern pattern : render::allPatterns())
    patterns[render::toString(pattern)] = rounded(fractionOf(pattern, totals));
  Json frames = Json::array();
  for (const RealTimeEvent& event : report.events) frames.push_back(toJson(event));
  return {{"seconds", rounded(report.seconds)},
          {"frames_per_s", {{"asked", report.frames_per_s}, {"held", rounded(heldPerSecond(report))}}},
          {"busy_frames", totals.busy},
          {"due", report.due},
          {"late", totals.late},
          {"dropped", report.due - totals.busy},
          {"patterns", patterns},
          {"restores", {{"done", totals.restores_done}, {"aborted", totals.restores_aborted}}},
          {"settled", totals.settled},
          {"settled_equal_full", totals.compared > 0 ? Json(totals.equal) : Json(nullptr)},
          {"abort_latency_ms", abortLatencies(report.events)},
          {"epsilon_ms", rounded(report.epsilon_ms)},
          {"field_updates", report.field_updates},
          {"field_updates_interpolated", report.field_updates_interpolated},
          {"field_steps_skipped", report.field_steps_skipped},
          {"frames", frames}};
}

}  // namespace emscape::report
