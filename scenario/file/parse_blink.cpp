#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

void blink(Emitter& emitter, const Section& section, const Clock& clock, ParseContext& context) {
  constexpr double kMaxTimes = 10000;
  if (!section.sound()) return;
  const double on_s = section.number("on_s"), cycle_s = on_s + section.number("off_s");
  if (clock.duration_s / cycle_s > kMaxTimes) {
    context.problems.addError(
        section.locationOf("on_s"),
        fmt::format("'{}' blinks {:.0f} times in the {:g} s of the scenario, at most {:.0f}", emitter.name,
                    clock.duration_s / cycle_s, clock.duration_s, kMaxTimes));
    return;
  }
  std::vector<TimeInterval> active = emitter.active_s;
  if (active.empty()) active.push_back({0, clock.duration_s + clock.step_s});
  emitter.active_s.clear();
  const double begin_s = section.has("begin_s") ? section.number("begin_s") : 0;
  for (const TimeInterval& whole : active) {
    const double to_s = std::min(whole.end_s, clock.duration_s + clock.step_s);
    for (double n = std::floor((std::max(whole.begin_s, 0.0) - begin_s) / cycle_s);
         begin_s + n * cycle_s < to_s; ++n) {
      const TimeInterval on{std::max(begin_s + n * cycle_s, whole.begin_s),
                            std::min(begin_s + n * cycle_s + on_s, whole.end_s)};
      if (on.begin_s < on.end_s) emitter.active_s.push_back(on);
    }
  }
  // never: an empty list would be always
  if (emitter.active_s.empty()) emitter.enabled = false;
}

}  // namespace emscape::scenario
