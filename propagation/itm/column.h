/// Statistics of the profile of a column for all its receivers, by vector instructions; on the CPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/math/simd.h"
#include "propagation/itm/itm.h"
#include "propagation/itm/profile.h"

namespace emscape::propagation {

/// As itm_detail::ProfileStatistics. What does not depend on the receiver's height is computed once. The
/// horizons are the same except where the elevations of two posts differ by less than their rounding, and
/// the interdecile range within its 65535th part.
class ItmColumn {
 public:
  /// @param link    with the transmitter's height
  /// @param slope   for the slopes from the receiver: intervals + 1 elements
  /// @param per_m   the same, for 1 over the ranges from it
  ItmColumn(const ItmProfile<float>& profile, const ItmLink<float>& link, float* slope, float* per_m)
      : profile_(profile), slope_(slope), per_m_(per_m) {
    const float* const heights_m = profile.heights_msl_m;
    const int last = profile.intervals;
    int missing = 0;
    EMSCAPE_SIMD(reduction(| : missing))
    for (int i = 0; i <= last; ++i) missing |= heights_m[i] - heights_m[i] == 0 ? 0 : 1;
    has_every_height_ = missing == 0;
    if (!has_every_height_) return;
    const int tenth = static_cast<int>(0.1 * last);
    const float base_m = heights_m[tenth];
    const float mean_m = base_m + sums(heights_m, tenth, last - tenth, base_m, 0).plain /
                                      static_cast<float>(last - 2 * tenth + 1);
    itmSetMedium(medium_, link.frequency_hz, link.vertical_polarization, link.relative_permittivity,
                 link.conductivity_s_m, link.sea_level_refractivity, mean_m);
    half_curvature_ = 1 / (2 * medium_.effective_earth_radius_m);
    setTransmitterHorizon(link.height_agl_m[0]);
    setReceiverSlopes();
  }

  bool hasEveryHeight() const { return has_every_height_; }
  ItmPath<float> medium(const ItmLink<float>&) const { return medium_; }

  itm_detail::HorizonDistances findHorizons(ItmPath<float>& path) const {
    const int last = profile_.intervals;
    const float *const slopes = slope_, *const per_m = per_m_;
    const float from_m = profile_.heights_msl_m[last] + path.terminal[1].height_agl_m;
    const float above_m = from_m - profile_.heights_msl_m[last];
    float highest = -HUGE_VALF;
    EMSCAPE_SIMD(reduction(max : highest))
    for (int i = 1; i < last; ++i) {
      const float slope = slopes[i] - above_m * per_m[i];
      highest = slope > highest ? slope : highest;
    }
    int post = last;
    EMSCAPE_SIMD(reduction(min : post))
    for (int i = 1; i < last; ++i) {
      const int here = slopes[i] - above_m * per_m[i] == highest ? i : last;
      post = here < post ? here : post;
    }
    return itm_detail::setHorizons(profile_, path, transmitter_, rangeOf(transmitter_.post),
                                   horizonAt(post, from_m, rangeOf(last - post)), rangeOf(last - post));
  }

  float irregularityBetween_m(double begin_m, double end_m) {
    if (!(begin_m == begin_m_ && end_m == end_m_)) {
      begin_m_ = begin_m;
      end_m_ = end_m;
      const double begin = begin_m / profile_.step_m, end = end_m / profile_.step_m;
      irregularity_m_ = end - begin >= 2 ? itm_detail::irregularityOf_m(
                                               interdecileRange_m({profile_, begin, end}), begin_m, end_m)
                                         : 0;
    }
    return irregularity_m_;
  }
  itm_detail::FittedLine<float> fitLine(double begin, double end) const {
    return lineOver(profile_.heights_msl_m, profile_.intervals, {profile_.intervals, begin, end});
  }

 private:
  using Sampled = itm_detail::SampledProfile<float, float>;

  float rangeOf(int post) const { return static_cast<float>(post * profile_.step_m); }

  static itm_detail::HeightSums<float> sums(const float* heights_m, int first, int last, float base_m,
                                            float center) {
    float plain = 0, weighted = 0;
    EMSCAPE_SIMD(reduction(+ : plain, weighted))
    for (int i = first; i <= last; ++i) {
      const float height_m = heights_m[i] - base_m;
      plain += height_m;
      weighted += height_m * (static_cast<float>(i) - center);
    }
    return {plain, weighted};
  }
  static itm_detail::FittedLine<float> lineOver(const float* heights_m, int intervals,
                                                const itm_detail::PostRange& posts) {
    const float base_m = heights_m[posts.first];
    return itm_detail::lineOf(posts, intervals, base_m,
                              sums(heights_m, posts.first, posts.last, base_m, posts.center<float>()),
                              heights_m[posts.last] - base_m);
  }

  itm_detail::HorizonPost horizonAt(int post, float from_m, float range_m) const {
    const float rise_m = profile_.heights_msl_m[post] - from_m - range_m * range_m * half_curvature_;
    return {post, rise_m / range_m, rise_m};
  }
  void setTransmitterHorizon(float height_agl_m) {
    const float* const heights_m = profile_.heights_msl_m;
    float* const slopes = slope_;
    const int last = profile_.intervals;
    const float from_m = heights_m[0] + height_agl_m, half_curvature = half_curvature_;
    const double step_m = profile_.step_m;
    float highest = -HUGE_VALF;
    EMSCAPE_SIMD(reduction(max : highest))
    for (int i = 1; i < last; ++i) {
      const auto range_m = static_cast<float>(i * step_m);
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
    transmitter_ = horizonAt(post, from_m, rangeOf(post));
  }
  /// Sets the slopes from the ground below the receiver; they fall by per_m for each metre above it.
  void setReceiverSlopes() {
    const float* const heights_m = profile_.heights_msl_m;
    float *const slopes = slope_, *const per_m = per_m_;
    const int last = profile_.intervals;
    const float ground_m = heights_m[last], half_curvature = half_curvature_;
    const double step_m = profile_.step_m;
    EMSCAPE_SIMD()
    for (int i = 1; i < last; ++i) {
      const auto range_m = static_cast<float>((last - i) * step_m);
      const float per_range = 1 / range_m;
      slopes[i] = (heights_m[i] - ground_m) * per_range - range_m * half_curvature;
      per_m[i] = per_range;
    }
  }

  /// Difference of the tenth-th largest and the tenth-th smallest sample above the line fitted to them.
  static float interdecileRange_m(const Sampled& sampled) {
    constexpr int kSize = 256;
    static_assert(Sampled::kMostSamples <= kSize, "all samples");
    const int count = sampled.count();
    float above_m[kSize];
    EMSCAPE_SIMD()
    for (int i = 0; i < count - 1; ++i) above_m[i] = sampled.at(i);
    above_m[count - 1] = sampled.last();
    const itm_detail::FittedLine<float> line =
        lineOver(above_m, count - 1, {count - 1, 0, static_cast<double>(count - 1)});
    const float start_m = line.at_start_m,
                slope_m = (line.at_end_m - start_m) / static_cast<float>(count - 1);
    float least_m = HUGE_VALF, most_m = -HUGE_VALF;
    EMSCAPE_SIMD(reduction(min : least_m) reduction(max : most_m))
    for (int i = 0; i < count; ++i) {
      const float here_m = above_m[i] - (start_m + slope_m * static_cast<float>(i));
      above_m[i] = here_m;
      least_m = here_m < least_m ? here_m : least_m;
      most_m = here_m > most_m ? here_m : most_m;
    }
    constexpr float kFlat_m = 1e-6f;
    if (!(most_m - least_m > kFlat_m)) return 0;
    constexpr int kBits = 16, kLowest = -(1 << (kBits - 1));
    const float steps_per_m = ((1 << kBits) - 1) / (most_m - least_m);
    std::int16_t steps[kSize];
    EMSCAPE_SIMD()
    for (int i = 0; i < count; ++i)
      steps[i] = static_cast<std::int16_t>(static_cast<int>((above_m[i] - least_m) * steps_per_m) + kLowest);
    std::fill(steps + count, steps + kSize, static_cast<std::int16_t>(-kLowest - 1));
    // The largest numbers below which there are at most as many samples as the rank, bit by bit.
    const int low_rank = sampled.tenth() - 1, high_rank = count - sampled.tenth();
    int low = kLowest, high = kLowest;
    for (int bit = 1 << (kBits - 1); bit != 0; bit >>= 1) {
      const auto more_low = static_cast<std::int16_t>(low + bit),
                 more_high = static_cast<std::int16_t>(high + bit);
      std::int16_t below_low = 0, below_high = 0;
      EMSCAPE_SIMD(reduction(+ : below_low, below_high))
      for (int i = 0; i < kSize; ++i) {
        below_low = static_cast<std::int16_t>(below_low + (steps[i] < more_low ? 1 : 0));
        below_high = static_cast<std::int16_t>(below_high + (steps[i] < more_high ? 1 : 0));
      }
      if (below_low <= low_rank) low += bit;
      if (below_high <= high_rank) high += bit;
    }
    return static_cast<float>(high - low) / steps_per_m;
  }

  const ItmProfile<float> profile_;
  float *slope_, *per_m_;
  bool has_every_height_ = false;
  ItmPath<float> medium_;
  float half_curvature_ = 0;
  itm_detail::HorizonPost transmitter_;
  double begin_m_ = NAN, end_m_ = NAN;
  float irregularity_m_ = 0;
};

}  // namespace emscape::propagation
