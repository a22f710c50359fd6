/// Statistics of the profile of a column for all its receivers, by vector instructions; on the CPU.
#pragma once

#include <cmath>

#include "base/math/simd.h"
#include "propagation/itm/profile.h"

namespace emscape::propagation {

/// As itm_detail::ProfileStatistics. What does not depend on the receiver's height is computed once. The
/// horizons are the same except where the elevations of two posts differ by less than their rounding.
class ItmColumn {
 public:
  /// @param range_m  for the ranges of the posts: intervals + 1 elements
  /// @param slope    the same, for its own use
  ItmColumn(const ItmProfile<float>& profile, float* range_m, float* slope)
      : profile_(profile), range_m_(range_m), slope_(slope) {
    const double step_m = profile.step_m;
    EMSCAPE_SIMD()
    for (int i = 0; i <= profile_.intervals; ++i) range_m[i] = static_cast<float>(i * step_m);
    has_every_height_ = itm_detail::hasEveryHeight(profile_);
    mean_height_m_ = has_every_height_ ? itm_detail::meanHeight_m<float>(profile_) : 0;
  }

  bool hasEveryHeight() const { return has_every_height_; }
  float meanHeight_m() const { return mean_height_m_; }

  itm_detail::HorizonDistances findHorizons(ItmPath<float>& path) {
    const int last = profile_.intervals;
    const float half_curvature = 1 / (2 * path.effective_earth_radius_m);
    const float* const ranges_m = range_m_;
    if (transmitter_.post < 0) {
      transmitter_ = steepest(profile_.heights_msl_m[0] + path.terminal[0].height_agl_m, half_curvature,
                              [ranges_m](int i) { return ranges_m[i]; });
    }
    const itm_detail::HorizonPost receiver =
        steepest(profile_.heights_msl_m[last] + path.terminal[1].height_agl_m, half_curvature,
                 [ranges_m, last](int i) { return ranges_m[last - i]; });
    return itm_detail::setHorizons(profile_, path, transmitter_, ranges_m[transmitter_.post], receiver,
                                   ranges_m[last - receiver.post]);
  }

  float irregularityBetween_m(double begin_m, double end_m) {
    if (!(begin_m == begin_m_ && end_m == end_m_)) {
      begin_m_ = begin_m;
      end_m_ = end_m;
      irregularity_m_ = itm_detail::irregularityBetween_m<float>(profile_, begin_m, end_m);
    }
    return irregularity_m_;
  }
  itm_detail::FittedLine<float> fitLine(double begin, double end) const {
    return itm_detail::fitLine<float>(profile_.heights_msl_m, profile_.intervals, begin, end);
  }

 private:
  /// @param rangeOf  distance of a post from the end
  template <class RangeOf>
  itm_detail::HorizonPost steepest(float from_m, float half_curvature, const RangeOf& rangeOf) const {
    const float* const heights_m = profile_.heights_msl_m;
    float* const slopes = slope_;
    const int last = profile_.intervals;
    float highest = -HUGE_VALF;
    EMSCAPE_SIMD(reduction(max : highest))
    for (int i = 1; i < last; ++i) {
      const float range_m = rangeOf(i);
      const float slope = (heights_m[i] - from_m - range_m * range_m * half_curvature) / range_m;
      slopes[i] = slope;
      highest = slope > highest ? slope : highest;
    }
    int post = last;
    EMSCAPE_SIMD(reduction(min : post))
    for (int i = 1; i < last; ++i) {
      const int here = slopes[i] == highest ? i : last;
      post = here < post ? here : post;
    }
    const float range_m = rangeOf(post);
    return {post, highest, heights_m[post] - from_m - range_m * range_m * half_curvature};
  }

  const ItmProfile<float> profile_;
  float* range_m_;
  float* slope_;
  bool has_every_height_ = false;
  float mean_height_m_ = 0;
  itm_detail::HorizonPost transmitter_;
  double begin_m_ = NAN, end_m_ = NAN;
  float irregularity_m_ = 0;
};

}  // namespace emscape::propagation
