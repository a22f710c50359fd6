/// What decides at the end of a path, with how much is missing there.
#pragma once

#include <array>

#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/link/path_cause.h"

namespace emscape::emfield {

/// What a signal would gain (dB) without one of the losses of its path.
struct LossCause {
  PathCause cause;
  double gain_db;
};

/// Ground cover, terrain and pointing, in this order.
/// @param pattern_db  gain of the antenna relative to its maximum, <= 0
/// @param ways        1 for a signal, 2 for an echo
std::array<LossCause, 3> lossesOf(const PathExcess& excess, double pattern_db, double ways);

/// The jammer without which the others leave the most detection; of equal ones the stronger.
/// @param jamming  with a jammer
const PathJammer& decisiveJammer(const PathJamming& jamming);

struct Decision {
  PathCause cause = PathCause::covered;
  /// To the threshold (dB): infinity of a silent emitter, or without a value; 0 if a range limit or jamming
  /// decides; -infinity if the point is covered.
  double missing_db = 0;
  double gain_db = 0;      ///< without the cause; of terrain, clutter and pointing
  bool by_filter = false;  ///< of clutter: the filter against it removes the echo as well

  /// True if another emitter is farther from covering the point, whatever the order of both.
  bool isNearerThan(const Decision& other) const {
    return missing_db != other.missing_db ? missing_db < other.missing_db : cause > other.cause;
  }
};

/// @see causeOf()
Decision decide(const PathBudget& budget, scenario::Quantity quantity, double threshold);

}  // namespace emscape::emfield
