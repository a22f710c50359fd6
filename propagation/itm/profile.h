/// ITM: parameters of a path from its terrain profile: horizons, irregularity, effective heights [Hufford
/// 1995, sec. 2].
///
/// Distances along the profile are doubles whatever Real is: the method truncates them to whole posts, and a
/// different rounding would select other posts.
#pragma once

#include <cmath>

#include "base/math/simd.h"
#include "emscape/base/host_device.h"
#include "propagation/itm/path.h"

namespace emscape::propagation {

/// A product with separate rounding. If a compiler fused it with an addition, other posts than in the
/// reference might be selected, which changes the loss by a tenth of a dB.
EMSCAPE_HD inline double itmProduct(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  volatile double product = a * b;
  return product;
#endif
}

/// Evenly spaced terrain heights from one end of a path to the other.
template <class Height>
struct ItmProfile {
  const Height* heights_msl_m = nullptr;  ///< `intervals` + 1 of them
  int intervals = 0;                      ///< >= 2
  double step_m = 0;                      ///< > 0

  EMSCAPE_HD double length_m() const { return itmProduct(intervals, step_m); }
};

namespace itm_detail {

/// Four partial sums, for independent additions.
constexpr int kLanes = 4;

/// Sum over the posts first..last of the heights above `base_m`.
template <class Real, class Height>
EMSCAPE_HD Real sumHeights(const Height* heights_m, int first, int last, Real base_m) {
  Real sum[kLanes] = {};
  int i = first;
  for (; i + kLanes - 1 <= last; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) sum[lane] += Real(heights_m[i + lane]) - base_m;
  }
  for (; i <= last; ++i) sum[0] += Real(heights_m[i]) - base_m;
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// The same, and the sum of the heights times the post's distance from `center` (in posts).
template <class Real>
struct HeightSums {
  Real plain;
  Real weighted;
};
template <class Real, class Height>
EMSCAPE_HD HeightSums<Real> sumHeights(const Height* heights_m, int first, int last, Real base_m,
                                       Real center) {
  Real plain[kLanes] = {};
  Real weighted[kLanes] = {};
  Real from_center[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) from_center[lane] = Real(first + lane) - center;
  int i = first;
  for (; i + kLanes - 1 <= last; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const Real height_m = Real(heights_m[i + lane]) - base_m;
      plain[lane] += height_m;
      weighted[lane] += height_m * from_center[lane];
      from_center[lane] += kLanes;
    }
  }
  for (; i <= last; ++i) {
    const Real height_m = Real(heights_m[i]) - base_m;
    plain[0] += height_m;
    weighted[0] += height_m * (Real(i) - center);
  }
  return {(plain[0] + plain[1]) + (plain[2] + plain[3]),
          (weighted[0] + weighted[1]) + (weighted[2] + weighted[3])};
}

/// A straight line over a profile: its heights at post 0 and at the last post.
template <class Real>
struct FittedLine {
  Real at_start_m = 0;
  Real at_end_m = 0;
};

/// Posts within begin..end (in posts), at least two intervals apart where there are as many.
struct PostRange {
  int first, last;

  EMSCAPE_HD PostRange(int intervals, double begin, double end)
      : first(begin > 0 ? static_cast<int>(begin) : 0),
        last(intervals - (end < intervals ? static_cast<int>(intervals - end) : 0)) {
    if (last > first) return;
    first = first > 1 ? first - 1 : 0;
    last = last + 1 < intervals ? last + 1 : intervals;
  }
  template <class Real>
  EMSCAPE_HD Real center() const {
    return first + Real(last - first) / 2;
  }
};

/// The line of least squares over such posts, the two outermost with half weight.
/// @param sums    of the posts, above the first one, about PostRange::center()
/// @param last_m  height of the last one above the first one
template <class Real>
EMSCAPE_HD FittedLine<Real> lineOf(const PostRange& posts, int intervals, Real base_m,
                                   const HeightSums<Real>& sums, Real last_m) {
  const Real length = Real(posts.last - posts.first), half = length / 2, center = posts.center<Real>();
  const Real mean_m = base_m + (sums.plain - last_m / 2) / length;
  const Real slope_m = (sums.weighted - half * last_m / 2) * 12 / ((length * length + 2) * length);
  return {mean_m - slope_m * center, mean_m + slope_m * (Real(intervals) - center)};
}
template <class Real, class Height>
EMSCAPE_HD FittedLine<Real> fitLine(const Height* heights_m, int intervals, double begin, double end) {
  const PostRange posts(intervals, begin, end);
  const Real base_m = heights_m[posts.first];
  return lineOf<Real>(posts, intervals, base_m,
                      sumHeights(heights_m, posts.first, posts.last, base_m, posts.center<Real>()),
                      Real(heights_m[posts.last]) - base_m);
}

template <class Height>
EMSCAPE_HD bool hasEveryHeight(const ItmProfile<Height>& profile) {
  int missing = 0;
  for (int i = 0; i <= profile.intervals; ++i) {
    missing |= !(profile.heights_msl_m[i] - profile.heights_msl_m[i] == 0);  // NaN and infinity
  }
  return missing == 0;
}

/// Mean of the profile without the tenth at either end.
template <class Real, class Height>
EMSCAPE_HD Real meanHeight_m(const ItmProfile<Height>& profile) {
  const int tenth = static_cast<int>(0.1 * profile.intervals);
  const Real base_m = profile.heights_msl_m[tenth];
  const int posts = profile.intervals - 2 * tenth + 1;
  return base_m + sumHeights(profile.heights_msl_m, tenth, profile.intervals - tenth, base_m) / Real(posts);
}

/// Distance of each terminal's horizon.
struct HorizonDistances {
  double distance_m[2];
};

/// Sets the horizons of both terminals: the posts at the largest elevation from each. Without an obstacle the
/// horizon is the other terminal.
template <class Real, class Height>
EMSCAPE_HD HorizonDistances findHorizons(const ItmProfile<Height>& profile, ItmPath<Real>& path) {
  const double length_m = profile.length_m();
  const Real half_curvature = 1 / (2 * path.effective_earth_radius_m);
  const Real transmitter_m = Real(profile.heights_msl_m[0]) + path.terminal[0].height_agl_m;
  const Real receiver_m = Real(profile.heights_msl_m[profile.intervals]) + path.terminal[1].height_agl_m;
  const Real slope = (receiver_m - transmitter_m) / Real(length_m);
  Real transmitter_angle = slope - Real(length_m) * half_curvature;
  Real receiver_angle = -slope - Real(length_m) * half_curvature;
  HorizonDistances horizons{{length_m, length_m}};
  double from_transmitter_m = 0;
  double from_receiver_m = length_m;
  for (int i = 1; i < profile.intervals; ++i) {
    from_transmitter_m += profile.step_m;
    from_receiver_m -= profile.step_m;
    const Real height_m = profile.heights_msl_m[i];
    // divided only if the post is higher than all before it
    const Real forth_m = Real(from_transmitter_m);
    const Real rise_forth_m = height_m - transmitter_m - forth_m * forth_m * half_curvature;
    if (rise_forth_m > transmitter_angle * forth_m) {
      transmitter_angle = rise_forth_m / forth_m;
      horizons.distance_m[0] = from_transmitter_m;
    }
    const Real back_m = Real(from_receiver_m);
    const Real rise_back_m = height_m - receiver_m - back_m * back_m * half_curvature;
    if (rise_back_m > receiver_angle * back_m) {
      receiver_angle = rise_back_m / back_m;
      horizons.distance_m[1] = from_receiver_m;
    }
  }
  const Real angle_rad[2] = {transmitter_angle, receiver_angle};
  for (int end = 0; end < 2; ++end) {
    path.terminal[end].horizon_angle_rad = angle_rad[end];
    path.terminal[end].horizon_distance_m = Real(horizons.distance_m[end]);
  }
  return horizons;
}

/// The post that is highest from an end, of several the first; and its height above the level there.
struct HorizonPost {
  int post = -1;
  float slope = 0, rise_m = 0;
};
/// Sets the horizons of both terminals from these posts.
/// @param forth_m, back_m  ranges of the posts, of the transmitter's from it and of the receiver's from it
EMSCAPE_HD inline HorizonDistances setHorizons(const ItmProfile<float>& profile, ItmPath<float>& path,
                                               const HorizonPost& of_transmitter, float forth_m,
                                               const HorizonPost& of_receiver, float back_m) {
  const int last = profile.intervals;
  const double length_m = profile.length_m();
  const float half_curvature = 1 / (2 * path.effective_earth_radius_m);
  const float transmitter_m = profile.heights_msl_m[0] + path.terminal[0].height_agl_m;
  const float receiver_m = profile.heights_msl_m[last] + path.terminal[1].height_agl_m;
  const float slope = (receiver_m - transmitter_m) / static_cast<float>(length_m);
  const float bulge = static_cast<float>(length_m) * half_curvature;
  HorizonDistances horizons{{length_m, length_m}};
  const auto set = [&](int end, float line, const HorizonPost& found, int away, float range_m) {
    const bool is_higher = found.rise_m > line * range_m;
    if (is_higher) horizons.distance_m[end] = away * profile.step_m;
    path.terminal[end].horizon_angle_rad = is_higher ? found.slope : line;
    path.terminal[end].horizon_distance_m = static_cast<float>(horizons.distance_m[end]);
  };
  set(0, slope - bulge, of_transmitter, of_transmitter.post, forth_m);
  set(1, -slope - bulge, of_receiver, last - of_receiver.post, back_m);
  return horizons;
}

/// The value of a rank (from 0) among few values. Sorts them in ascending order.
template <class Real>
EMSCAPE_HD Real valueAtRank(Real* values, int count, int rank) {
  for (int i = 1; i < count; ++i) {
    const Real value = values[i];
    int place = i;
    for (; place > 0 && values[place - 1] > value; --place) values[place] = values[place - 1];
    values[place] = value;
  }
  return values[rank];
}

/// Difference of the `tenth`-th largest and the `tenth`-th smallest of the values.
///
/// Values are counted in buckets, and only those of the two buckets that contain the result are sorted. 0
/// below a micrometre.
/// @tparam kMaxCount  largest count, <= 255
template <int kMaxCount, class Real>
EMSCAPE_HD Real interdecileRange(const Real* values, int count, int tenth) {
  constexpr int kBuckets = 128;
  static_assert(kMaxCount <= 255, "places and counts are bytes");
  // in lanes, for independent comparisons
  Real lane_least[kLanes] = {values[0], values[0], values[0], values[0]};
  Real lane_most[kLanes] = {values[0], values[0], values[0], values[0]};
  for (int i = 0; i < count; i += kLanes) {
    const int first = i + kLanes <= count ? i : count - kLanes;
    for (int lane = 0; lane < kLanes; ++lane) {
      lane_least[lane] = smaller(lane_least[lane], values[first + lane]);
      lane_most[lane] = larger(lane_most[lane], values[first + lane]);
    }
  }
  const Real least = smaller(smaller(lane_least[0], lane_least[1]), smaller(lane_least[2], lane_least[3]));
  const Real most = larger(larger(lane_most[0], lane_most[1]), larger(lane_most[2], lane_most[3]));
  constexpr Real kFlat_m = Real(1e-6);
  if (!(most - least > kFlat_m)) return 0;

  unsigned char bucket[kMaxCount];
  unsigned char members[kBuckets] = {};
  unsigned char more_members[kBuckets] = {};  // used alternately, so that equal buckets are independent
  const Real scale = (kBuckets - 1) / (most - least);
  for (int i = 0; i < count; ++i)
    bucket[i] = static_cast<unsigned char>(static_cast<int>((values[i] - least) * scale));
  for (int i = 0; i + 1 < count; i += 2) {
    ++members[bucket[i]];
    ++more_members[bucket[i + 1]];
  }
  if (count % 2 == 1) ++members[bucket[count - 1]];
  for (int i = 0; i < kBuckets; ++i) members[i] = static_cast<unsigned char>(members[i] + more_members[i]);
  int low = 0;
  int low_rank = tenth - 1;
  for (; low_rank >= members[low]; ++low) low_rank -= members[low];
  int high = kBuckets - 1;
  int high_rank = tenth - 1;
  for (; high_rank >= members[high]; --high) high_rank -= members[high];
  high_rank = members[high] - 1 - high_rank;  // from below

  Real low_values[kMaxCount];
  Real high_values[kMaxCount];
  int low_count = 0;
  int high_count = 0;
  for (int i = 0; i < count; ++i) {
    if (bucket[i] != low && bucket[i] != high) continue;
    if (bucket[i] == low) low_values[low_count++] = values[i];
    if (bucket[i] == high) high_values[high_count++] = values[i];
  }
  return valueAtRank(high_values, high_count, high_rank) - valueAtRank(low_values, low_count, low_rank);
}

/// Heights of a profile at equal distances, between two of its posts by a line. Positions are in posts, in
/// fixed point: 32 bits for the fraction.
template <class Real, class Height>
class SampledProfile {
 public:
  static constexpr int kMostSamples = 10 * 25 - 5;

  /// @param begin, end  in posts, at least 2 apart
  EMSCAPE_HD SampledProfile(const ItmProfile<Height>& profile, double begin, double end)
      : heights_msl_m_(profile.heights_msl_m), last_interval_(profile.intervals - 1) {
    tenth_ = static_cast<int>(0.1 * (end - begin + 8));
    tenth_ = tenth_ < 4 ? 4 : tenth_ > 25 ? 25 : tenth_;
    spacing_ = static_cast<long long>((end - begin) / (count() - 1) * kOne);
    first_ = static_cast<long long>(begin * kOne);
  }
  EMSCAPE_HD int tenth() const { return tenth_; }  ///< a tenth of the samples
  EMSCAPE_HD int count() const { return 10 * tenth_ - 5; }
  /// Of any but the last one.
  EMSCAPE_HD Real at(int i) const {
    const long long at = first_ + i * spacing_;
    return between(static_cast<int>(at >> 32), Real(static_cast<unsigned>(at)));
  }
  EMSCAPE_HD Real last() const {
    const long long at = first_ + (count() - 1) * spacing_;
    const int post = static_cast<int>(at >> 32), before = post < last_interval_ ? post : last_interval_;
    return between(before, Real(at - (static_cast<long long>(before) << 32)));
  }

 private:
  static constexpr double kOne = 4294967296.0;

  EMSCAPE_HD Real between(int post, Real fraction) const {
    const Real here_m = heights_msl_m_[post];
    return here_m + (Real(heights_msl_m_[post + 1]) - here_m) * (fraction * Real(1 / kOne));
  }

  const Height* heights_msl_m_;
  int last_interval_, tenth_;
  long long first_, spacing_;
};

/// Delta h of an interdecile range of the terrain's heights between two distances, above the line fitted to
/// them: scaled to that of a path of any length [Alg 3.9].
template <class Real>
EMSCAPE_HD Real irregularityOf_m(Real range_m, double begin_m, double end_m) {
  return range_m / (1 - Real(0.8) * Real(std::exp(-(end_m - begin_m) / 50e3)));
}
template <class Real, class Height>
EMSCAPE_HD Real irregularityBetween_m(const ItmProfile<Height>& profile, double begin_m, double end_m) {
  const double begin = begin_m / profile.step_m, end = end_m / profile.step_m;
  if (!(end - begin >= 2)) return 0;
  const SampledProfile<Real, Height> sampled(profile, begin, end);
  constexpr int kMaxSamples = SampledProfile<Real, Height>::kMostSamples;
  const int samples = sampled.count();
  Real above_m[kMaxSamples];
  EMSCAPE_SIMD()
  for (int i = 0; i < samples - 1; ++i) above_m[i] = sampled.at(i);
  above_m[samples - 1] = sampled.last();
  const FittedLine<Real> line = fitLine<Real>(above_m, samples - 1, 0, samples - 1);
  const Real slope_m = (line.at_end_m - line.at_start_m) / (samples - 1);
  for (int i = 0; i < samples; ++i) above_m[i] -= line.at_start_m + slope_m * i;
  return irregularityOf_m(interdecileRange<kMaxSamples>(above_m, samples, sampled.tenth()), begin_m, end_m);
}

/// Effective heights if the terminals are in line of sight; their horizons are then estimated from the
/// irregularity.
template <class Real, class Height, class Statistics>
EMSCAPE_HD void setLineOfSight(const ItmProfile<Height>& profile, const Statistics& statistics,
                               double begin_m, double end_m, ItmPath<Real>& path) {
  const FittedLine<Real> line = statistics.fitLine(begin_m / profile.step_m, end_m / profile.step_m);
  const Real above_m[2] = {larger(Real(0), Real(profile.heights_msl_m[0]) - line.at_start_m),
                           larger(Real(0), Real(profile.heights_msl_m[profile.intervals]) - line.at_end_m)};
  const auto estimateHorizons = [&path] {
    for (int end = 0; end < 2; ++end) {
      itmEstimateHorizon(path.terminal[end], path.smoothHorizonDistance_m(end), path.irregularity_m);
    }
  };
  for (int end = 0; end < 2; ++end) {
    path.terminal[end].effective_height_m = path.terminal[end].height_agl_m + above_m[end];
  }
  estimateHorizons();
  if (path.horizonDistance_m() <= path.distance_m) {
    // raised until the estimated horizons reach across the path
    const Real reach = path.distance_m / path.horizonDistance_m();
    for (int end = 0; end < 2; ++end) path.terminal[end].effective_height_m *= reach * reach;
    estimateHorizons();
  }
}

/// Effective heights if each terminal has its own horizon.
template <class Real, class Height, class Statistics>
EMSCAPE_HD void setBeyondHorizon(const ItmProfile<Height>& profile, const Statistics& statistics,
                                 double begin_m, double end_m, const HorizonDistances& horizons,
                                 ItmPath<Real>& path) {
  const double step_m = profile.step_m;
  const Real at_start_m =
      statistics.fitLine(begin_m / step_m, itmProduct(0.9, horizons.distance_m[0]) / step_m).at_start_m;
  const Real at_end_m =
      statistics
          .fitLine((profile.length_m() - itmProduct(0.9, horizons.distance_m[1])) / step_m, end_m / step_m)
          .at_end_m;
  path.terminal[0].effective_height_m =
      path.terminal[0].height_agl_m + larger(Real(0), Real(profile.heights_msl_m[0]) - at_start_m);
  path.terminal[1].effective_height_m =
      path.terminal[1].height_agl_m +
      larger(Real(0), Real(profile.heights_msl_m[profile.intervals]) - at_end_m);
}

/// Statistics of a profile, computed at each call; ItmColumn keeps them for several receivers.
template <class Real, class Height>
struct ProfileStatistics {
  const ItmProfile<Height>& profile;

  EMSCAPE_HD bool hasEveryHeight() const { return itm_detail::hasEveryHeight(profile); }
  /// A path with what depends on ground, atmosphere and frequency.
  template <class Link>
  EMSCAPE_HD ItmPath<Real> medium(const Link& link) const {
    ItmPath<Real> path;
    itmSetMedium(path, link.frequency_hz, link.vertical_polarization, link.relative_permittivity,
                 link.conductivity_s_m, link.sea_level_refractivity, meanHeight_m<Real>(profile));
    return path;
  }
  EMSCAPE_HD HorizonDistances findHorizons(ItmPath<Real>& path) const {
    return itm_detail::findHorizons(profile, path);
  }
  EMSCAPE_HD Real irregularityBetween_m(double begin_m, double end_m) const {
    return itm_detail::irregularityBetween_m<Real>(profile, begin_m, end_m);
  }
  EMSCAPE_HD FittedLine<Real> fitLine(double begin, double end) const {
    return itm_detail::fitLine<Real>(profile.heights_msl_m, profile.intervals, begin, end);
  }
};

}  // namespace itm_detail

/// Sets horizons, irregularity and effective heights from a profile. The path's heights above ground and its
/// effective earth must be set.
/// @param statistics  ProfileStatistics of the profile, or the like
template <class Real, class Height, class Statistics>
EMSCAPE_HD void itmSetTerrain(ItmPath<Real>& path, const ItmProfile<Height>& profile,
                              Statistics& statistics) {
  using namespace itm_detail;
  path.profile_is_known = true;
  path.distance_m = Real(profile.length_m());
  const HorizonDistances horizons = statistics.findHorizons(path);
  // terrain near a terminal is left out: up to 15 structural heights or a tenth of its horizon distance,
  // whichever is less
  const auto foreground_m = [&](int end) {
    const double near_m = itmProduct(15, static_cast<double>(path.terminal[end].height_agl_m));
    const double tenth_m = itmProduct(0.1, horizons.distance_m[end]);
    return near_m < tenth_m ? near_m : tenth_m;
  };
  const double begin_m = foreground_m(0);
  const double end_m = profile.length_m() - foreground_m(1);
  path.irregularity_m = statistics.irregularityBetween_m(begin_m, end_m);
  if (horizons.distance_m[0] + horizons.distance_m[1] > 1.5 * profile.length_m()) {
    setLineOfSight(profile, statistics, begin_m, end_m, path);
  } else {
    setBeyondHorizon(profile, statistics, begin_m, end_m, horizons, path);
  }
}

}  // namespace emscape::propagation
