/// Interval of time that a volume represents, from its own time on.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "emscape/base/enum_names.h"
#include "emscape/scenario/model/clock.h"

namespace emscape::scenario {

using emscape::toString;

enum class IntervalKind {
  instant,    ///< the field at the volume's time
  max_hold,   ///< the largest value of each emitter in the interval
  mean,       ///< the mean power in the interval
  cumulative  ///< the probability of at least one detection in the interval
};
constexpr auto namesOf(IntervalKind) {
  return std::array{"instant", "max_hold", "mean", "cumulative"};
}

/// An interval that begins at the volume's time. At most one of seconds and turns is given; none: the step of
/// the clock.
struct IntervalSpec {
  IntervalKind kind = IntervalKind::instant;
  std::optional<double> seconds;  ///< > 0
  std::optional<double> turns;    ///< > 0; of each emitter's scan: turns, sweeps there and back, or cycles
};

/// For legends: "largest in 12 s", "mean of 2 turns"; empty for an instant.
std::string describe(const IntervalSpec& interval, const Clock& clock);

}  // namespace emscape::scenario
