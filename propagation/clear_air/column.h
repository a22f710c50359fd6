/// A terrain profile with its transmitter in ITU-R P.1812 and P.452: all quantities that do not depend on the
/// receiver's height, computed once for all receivers above the end of the profile.
#pragma once

#include <cmath>

#include "base/math/simd.h"
#include "emscape/base/host_device.h"
#include "propagation/clear_air/model.h"
#include "propagation/clear_air/zones.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

/// The posts of a profile, with tables of values that do not depend on the receiver's height. Heights are
/// relative to the ground at the first post, for precision in float.
template <class Real>
struct ClearAirPosts {
  TerrainProfile profile;      ///< at least two posts
  Real* surface_m = nullptr;   ///< g_i: terrain plus clutter
  Real* inverse_rx = nullptr;  ///< 1 / (d - d_i) (1/m); of posts between the ends
  Real* nu_per_m = nullptr;    ///< nu of an obstacle 1 m above the line of sight; of posts between the ends

  EMSCAPE_HD int count() const { return profile.count; }
  EMSCAPE_HD Real range_m(int i) const { return Real(profile.range_m[i]); }
  /// h_i
  EMSCAPE_HD Real terrain_m(int i) const {
    return Real(profile.height_msl_m[i]) - Real(profile.height_msl_m[0]);
  }

  /// Fills the tables; each has count() elements.
  /// @param clutterOf  (int) -> height (m) of the clutter at a post
  template <class ClutterOf>
  EMSCAPE_HD void fill(Real wavelength_m, ClutterOf clutterOf) const {
    const int last = count() - 1;
    const double distance_m = profile.range_m[last];
    const Real factor = 2 * Real(distance_m) / wavelength_m;
    Real *const surface = surface_m, *const inverse = inverse_rx, *const nu = nu_per_m;
    for (int i = 0; i <= last; ++i) {
      surface[i] = terrain_m(i) + (i == 0 || i == last ? Real(0) : Real(clutterOf(i)));
    }
    EMSCAPE_SIMD()
    for (int i = 1; i < last; ++i) {
      const Real beyond_m = Real(distance_m - profile.range_m[i]);
      inverse[i] = 1 / beyond_m;
      nu[i] = std::sqrt(factor / (range_m(i) * beyond_m));
    }
  }
};

/// A profile and its transmitter.
template <class Real>
struct ClearAirColumn {
  ClearAirPosts<Real> posts;
  Real distance_m = 0;
  PathZones zones;
  Real ducting_time_percent = 0;  ///< beta_0
  Real base_msl_m = 0;            ///< ground at the transmitter; other heights are relative to it
  Real tx_m = 0;                  ///< antenna
  Real rx_ground_m = 0;
  Real trend_m[2] = {};                  ///< ends of the line fitted to the terrain
  Real steepest = -Real(HUGE_VAL);       ///< slope from the transmitter to a post, without the earth's bulge
  Real horizon_slope = -Real(HUGE_VAL);  ///< tangent of the elevation of the transmitter's horizon, over a_e
  int horizon = 0;                       ///< post of the horizon; 0: no post between the ends
  Real median_slope = -Real(HUGE_VAL);   ///< Bullington's slope S_tim over a_e
  Real ducting_slope = -Real(HUGE_VAL);  ///< the same over a_beta
  bool is_unknown = false;               ///< terrain is missing
};

/// @param posts     filled; the profile and the tables must outlive the result
/// @param tx_msl_m  of the antenna, at least DiffractionModel::raised_m
template <class Real>
EMSCAPE_HD ClearAirColumn<Real> clearAirColumn(const ClearAirModel<Real>& model,
                                               const ClearAirPosts<Real>& posts, const PathZones& zones,
                                               Real tx_msl_m) {
  ClearAirColumn<Real> column;
  const TerrainProfile& profile = posts.profile;
  const int last = profile.count - 1;
  const double distance_m = profile.range_m[last];
  column.posts = posts;
  column.distance_m = Real(distance_m);
  column.zones = zones;
  column.ducting_time_percent =
      ductingTime_percent(model.latitude_deg, Real(zones.longest_land_m), Real(zones.longest_inland_m));
  column.base_msl_m = Real(profile.height_msl_m[0]);
  column.tx_m = model.median.raised_m(tx_msl_m - column.base_msl_m, Real(0));
  column.rx_ground_m = posts.terrain_m(last);
  TerrainSums sums;
  double v1 = 0, v2 = 0;
  EMSCAPE_SIMD(reduction(+ : v1, v2))
  for (int i = 1; i <= last; ++i) {
    TerrainSums of_interval;
    of_interval.add(profile, i);
    v1 += of_interval.v1;
    v2 += of_interval.v2;
  }
  sums.v1 = v1;
  sums.v2 = v2;
  const Real tx_m = column.tx_m, median_curvature = model.median.half_curvature,
             ducting_curvature = model.ducting.half_curvature;
  const auto horizonSlope = [&](int i) {
    const Real range_m = posts.range_m(i);
    return (posts.terrain_m(i) - tx_m) * (1 / range_m) - median_curvature * range_m;
  };
  Real steepest = column.steepest, horizon = column.horizon_slope, median = column.median_slope,
       ducting = column.ducting_slope;
  EMSCAPE_SIMD(reduction(max : steepest, horizon, median, ducting))
  for (int i = 1; i < last; ++i) {
    const Real range_m = posts.range_m(i), inverse = 1 / range_m;
    const Real slope = (posts.terrain_m(i) - tx_m) * inverse;
    const Real surface_slope = (posts.surface_m[i] - tx_m) * inverse;
    const Real horizon_slope = horizonSlope(i);
    const Real median_slope = surface_slope - median_curvature * range_m;
    const Real ducting_slope = surface_slope - ducting_curvature * range_m;
    horizon = horizon_slope > horizon ? horizon_slope : horizon;
    steepest = slope > steepest ? slope : steepest;
    median = median_slope > median ? median_slope : median;
    ducting = ducting_slope > ducting ? ducting_slope : ducting;
  }
  int horizon_post = last;
  EMSCAPE_SIMD(reduction(min : horizon_post))
  for (int i = 1; i < last; ++i) {
    const int here = horizonSlope(i) >= horizon ? i : last;
    horizon_post = here < horizon_post ? here : horizon_post;
  }
  column.steepest = steepest;
  column.horizon_slope = horizon;
  column.horizon = horizon_post < last ? horizon_post : 0;
  column.median_slope = median;
  column.ducting_slope = ducting;
  column.median_slope += model.median.half_curvature * column.distance_m;
  column.ducting_slope += model.ducting.half_curvature * column.distance_m;
  column.trend_m[0] = Real(sums.start_m(distance_m));
  column.trend_m[1] = Real(sums.end_m(distance_m));
  column.is_unknown = std::isnan(sums.v1) || std::isnan(column.base_msl_m);
  return column;
}

}  // namespace emscape::propagation
