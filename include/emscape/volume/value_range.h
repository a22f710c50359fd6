/// A closed interval of values.
#pragma once

#include "emscape/base/host_device.h"

namespace emscape::volume {

/// Smallest and largest value; empty (min > max) if there is none.
struct ValueRange {
  float min = 0;
  float max = -1;

  EMSCAPE_HD bool empty() const { return min > max; }
  /// Extends the range by another one. Empty ranges and ranges with NaN have no effect.
  EMSCAPE_HD void add(const ValueRange& other) {
    if (!(other.min <= other.max)) return;
    const bool was_empty = empty();
    min = was_empty || other.min < min ? other.min : min;
    max = was_empty || other.max > max ? other.max : max;
  }
};

/// Empty ranges are equal.
inline bool operator==(const ValueRange& a, const ValueRange& b) {
  return (a.empty() && b.empty()) || (a.min == b.min && a.max == b.max);
}
inline bool operator!=(const ValueRange& a, const ValueRange& b) {
  return !(a == b);
}

}  // namespace emscape::volume
