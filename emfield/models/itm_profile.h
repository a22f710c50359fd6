/// ITM: what a terrain profile says of a path: horizons, irregularity, effective heights [Hufford 1995, sec.
/// 2].
///
/// Distances along the profile are doubles whatever Real is: the method cuts them to whole posts, and a
/// rounding that fell the other way would take other posts.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "emfield/models/itm_path.h"

namespace emscape::emfield {

/// Evenly spaced terrain heights from one end of a path to the other.
template <class Height>
struct ItmProfile {
  const Height* heights_msl_m = nullptr;  ///< `intervals` + 1 of them
  int intervals = 0;                      ///< >= 2
  double step_m = 0;                      ///< > 0

  EMSCAPE_HD double length_m() const { return intervals * step_m; }
};

namespace itm_detail {

/// Sums over the posts first..last: of the heights above `base_m`, and of the same times the post's distance
/// from `center`, in posts.
template <class Real>
struct HeightSums {
  Real plain = 0;
  Real weighted = 0;
};

/// In four lanes, so that additions need not wait for each other.
template <class Real, class Height>
EMSCAPE_HD HeightSums<Real> sumHeights(const Height* heights_m, int first, int last, Real base_m,
                                       Real center) {
  Real plain[4] = {};
  Real weighted[4] = {};
  int i = first;
  for (; i + 3 <= last; i += 4) {
    for (int lane = 0; lane < 4; ++lane) {
      const Real height_m = Real(heights_m[i + lane]) - base_m;
      plain[lane] += height_m;
      weighted[lane] += height_m * (Real(i + lane) - center);
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

/// Least squares over the posts that lie within begin..end (in posts), the two outermost with half their
/// weight.
template <class Real, class Height>
EMSCAPE_HD FittedLine<Real> fitLine(const Height* heights_m, int intervals, double begin, double end) {
  int first = begin > 0 ? static_cast<int>(begin) : 0;
  int last = intervals - (end < intervals ? static_cast<int>(intervals - end) : 0);
  if (last <= first) {
    first = first > 1 ? first - 1 : 0;
    last = last + 1 < intervals ? last + 1 : intervals;
  }
  const Real length = Real(last - first);
  const Real half = length / 2;
  const Real center = first + half;
  const Real base_m = heights_m[first];
  HeightSums<Real> sums = sumHeights(heights_m, first, last, base_m, center);
  const Real last_m = Real(heights_m[last]) - base_m;  // the first one is 0
  const Real mean_m = base_m + (sums.plain - last_m / 2) / length;
  const Real slope_m = (sums.weighted - half * last_m / 2) * 12 / ((length * length + 2) * length);
  return {mean_m - slope_m * center, mean_m + slope_m * (Real(intervals) - center)};
}

template <class Height>
EMSCAPE_HD bool hasEveryHeight(const ItmProfile<Height>& profile) {
  bool every = true;
  for (int i = 0; i <= profile.intervals; ++i) {
    every &= profile.heights_msl_m[i] - profile.heights_msl_m[i] == 0;  // false for NaN and infinity
  }
  return every;
}

/// Mean of the profile without the tenth at either end.
template <class Real, class Height>
EMSCAPE_HD Real meanHeight_m(const ItmProfile<Height>& profile) {
  const int tenth = static_cast<int>(0.1 * profile.intervals);
  const Real base_m = profile.heights_msl_m[tenth];
  const int posts = profile.intervals - 2 * tenth + 1;
  return base_m + sumHeights(profile.heights_msl_m, tenth, profile.intervals - tenth, base_m, Real(0)).plain /
                      Real(posts);
}

/// Distance of each terminal's horizon.
struct HorizonDistances {
  double distance_m[2];
};

/// Sets the horizons of both terminals: the posts that stand highest as seen from each. A terminal without an
/// obstacle sees the other one.
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
    // divided only where a post stands higher than all before it
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

/// The value that stands at place `rank` (from 0) when the values are put in descending order. Reorders them.
///
/// Each round sorts the values into buckets and keeps the one in which the value lies: two or three passes
/// over smooth data, whatever their order.
template <class Real>
EMSCAPE_HD Real valueAtRank(Real* values, int count, int rank) {
  constexpr int kBuckets = 64;
  constexpr int kFew = 12;
  while (count > kFew) {
    Real least = values[0];
    Real most = values[0];
    for (int i = 1; i < count; ++i) {
      least = values[i] < least ? values[i] : least;
      most = values[i] > most ? values[i] : most;
    }
    if (!(most > least)) return most;
    // the largest value falls into the last bucket, the smallest into the first: every round drops some
    const Real scale = (kBuckets - 1) / (most - least);
    short members[kBuckets] = {};
    for (int i = 0; i < count; ++i) ++members[static_cast<int>((values[i] - least) * scale)];
    int bucket = kBuckets - 1;
    for (; rank >= members[bucket]; --bucket) rank -= members[bucket];
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const Real value = values[i];
      values[kept] = value;
      kept += static_cast<int>((value - least) * scale) == bucket;
    }
    count = kept;
  }
  for (int i = 1; i < count; ++i) {
    const Real value = values[i];
    int place = i;
    for (; place > 0 && values[place - 1] < value; --place) values[place] = values[place - 1];
    values[place] = value;
  }
  return values[rank];
}

/// Delta h: interdecile range of the terrain's heights between two distances, above the line fitted to them,
/// scaled to that of a path of any length [Alg 3.9].
template <class Real, class Height>
EMSCAPE_HD Real irregularityBetween_m(const ItmProfile<Height>& profile, double begin_m, double end_m) {
  const double begin = begin_m / profile.step_m;
  const double end = end_m / profile.step_m;
  if (!(end - begin >= 2)) return 0;
  int tenth = static_cast<int>(0.1 * (end - begin + 8));
  tenth = tenth < 4 ? 4 : tenth > 25 ? 25 : tenth;
  const int samples = 10 * tenth - 5;
  constexpr int kMostSamples = 10 * 25 - 5;

  Real above_m[kMostSamples];
  const double spacing = (end - begin) / (samples - 1);
  for (int i = 0; i < samples; ++i) {
    const double at = begin + i * spacing;
    int post = static_cast<int>(at);
    if (post >= profile.intervals) post = profile.intervals - 1;
    const Real here_m = profile.heights_msl_m[post];
    above_m[i] = here_m + (Real(profile.heights_msl_m[post + 1]) - here_m) * Real(at - post);
  }
  const FittedLine<Real> line = fitLine<Real>(above_m, samples - 1, 0, samples - 1);
  const Real slope_m = (line.at_end_m - line.at_start_m) / (samples - 1);
  for (int i = 0; i < samples; ++i) above_m[i] -= line.at_start_m + slope_m * i;

  Real copy_m[kMostSamples];
  for (int i = 0; i < samples; ++i) copy_m[i] = above_m[i];
  const Real range_m =
      valueAtRank(above_m, samples, tenth - 1) - valueAtRank(copy_m, samples, samples - tenth);
  return range_m / (1 - Real(0.8) * Real(std::exp(-(end_m - begin_m) / 50e3)));
}

/// Effective heights where the terminals see each other; their horizons are then estimated from the
/// irregularity.
template <class Real, class Height>
EMSCAPE_HD void setLineOfSight(const ItmProfile<Height>& profile, double begin_m, double end_m,
                               ItmPath<Real>& path) {
  const FittedLine<Real> line = fitLine<Real>(profile.heights_msl_m, profile.intervals,
                                              begin_m / profile.step_m, end_m / profile.step_m);
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

/// Effective heights where each terminal looks at a horizon of its own.
template <class Real, class Height>
EMSCAPE_HD void setBeyondHorizon(const ItmProfile<Height>& profile, double begin_m, double end_m,
                                 const HorizonDistances& horizons, ItmPath<Real>& path) {
  const double step_m = profile.step_m;
  const Real at_start_m = fitLine<Real>(profile.heights_msl_m, profile.intervals, begin_m / step_m,
                                        0.9 * horizons.distance_m[0] / step_m)
                              .at_start_m;
  const Real at_end_m =
      fitLine<Real>(profile.heights_msl_m, profile.intervals,
                    (profile.length_m() - 0.9 * horizons.distance_m[1]) / step_m, end_m / step_m)
          .at_end_m;
  path.terminal[0].effective_height_m =
      path.terminal[0].height_agl_m + larger(Real(0), Real(profile.heights_msl_m[0]) - at_start_m);
  path.terminal[1].effective_height_m =
      path.terminal[1].height_agl_m +
      larger(Real(0), Real(profile.heights_msl_m[profile.intervals]) - at_end_m);
}

}  // namespace itm_detail

/// Sets horizons, irregularity and effective heights from a profile. The path's heights above ground and its
/// effective earth must be set.
template <class Real, class Height>
EMSCAPE_HD void itmSetTerrain(ItmPath<Real>& path, const ItmProfile<Height>& profile) {
  using namespace itm_detail;
  path.profile_is_known = true;
  path.distance_m = Real(profile.length_m());
  const HorizonDistances horizons = findHorizons(profile, path);
  // what is close to a terminal, as seen from its height or within a tenth of its horizon, does not count
  const auto foreground_m = [&](int end) {
    const double near_m = 15 * static_cast<double>(path.terminal[end].height_agl_m);
    const double tenth_m = 0.1 * horizons.distance_m[end];
    return near_m < tenth_m ? near_m : tenth_m;
  };
  const double begin_m = foreground_m(0);
  const double end_m = profile.length_m() - foreground_m(1);
  path.irregularity_m = irregularityBetween_m<Real>(profile, begin_m, end_m);
  if (horizons.distance_m[0] + horizons.distance_m[1] > 1.5 * profile.length_m()) {
    setLineOfSight(profile, begin_m, end_m, path);
  } else {
    setBeyondHorizon(profile, begin_m, end_m, horizons, path);
  }
}

}  // namespace emscape::emfield
