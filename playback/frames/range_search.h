/// Search for the range of the values of a series. Internal to the module.
#pragma once

#include <optional>

#include "emscape/volume/dense_volume.h"
#include "emscape/volume/statistics.h"
#include "emscape/volume/value_range.h"

namespace emscape::playback {

/// Visits at most 24 steps of a series: beams repeat their motion, so a part of the steps is sufficient for
/// the range of the colours.
class RangeSearch {
 public:
  /// @param steps  of the series; 0: the search is done
  explicit RangeSearch(int steps = 0) : steps_(steps), stride_((steps + kMaxVisits - 1) / kMaxVisits) {}

  /// The step to visit; none: the search is done.
  std::optional<int> next() const { return next_ < steps_ ? std::optional(next_) : std::nullopt; }
  /// Adds the range of the values of the step next(), if it has any.
  void add(const volume::VolumeInfo& info) {
    if (!volume::holdsNothing(info)) range_.add({info.range_min, info.range_max});
    next_ += stride_;
  }
  const volume::ValueRange& range() const { return range_; }

 private:
  static constexpr int kMaxVisits = 24;
  int steps_, stride_, next_ = 0;
  volume::ValueRange range_;
};

}  // namespace emscape::playback
