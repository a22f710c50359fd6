#include "emscape/scenario/model/interval.h"

#include <fmt/format.h>

namespace emscape::scenario {

std::string describe(const IntervalSpec& interval, const Clock& clock) {
  const std::string duration =
      interval.turns ? fmt::format("{:g} turn{}", *interval.turns, *interval.turns == 1 ? "" : "s")
                     : fmt::format("{:g} s", interval.seconds.value_or(clock.step_s));
  switch (interval.kind) {
    case IntervalKind::max_hold:
      return "largest in " + duration;
    case IntervalKind::mean:
      return "mean of " + duration;
    case IntervalKind::cumulative:
      return "all looks in " + duration;
    case IntervalKind::instant:
      break;
  }
  return "";
}

}  // namespace emscape::scenario
