/// What decides at the end of a path, with how much is missing there.
#pragma once

#include "emscape/emfield/link/path_cause.h"

namespace emscape::emfield {

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
