/// A terrain profile with its transmitter in ITU-R P.1812 and P.452: all quantities that do not depend on the
/// receiver's height, computed once for all receivers above the end of the profile.
#pragma once

#include <cmath>

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
    for (int i = 0; i <= last; ++i) {
      surface_m[i] = terrain_m(i);
      if (i == 0 || i == last) continue;
      surface_m[i] += Real(clutterOf(i));
      const Real beyond_m = Real(distance_m - profile.range_m[i]);
      inverse_rx[i] = 1 / beyond_m;
      nu_per_m[i] = std::sqrt(2 * Real(distance_m) / (wavelength_m * range_m(i) * beyond_m));
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
  for (int i = 1; i <= last; ++i) {
    sums.add(profile, i);
    if (i == last) break;
    const Real range_m = posts.range_m(i), inverse = 1 / range_m;
    const Real slope = (posts.terrain_m(i) - column.tx_m) * inverse;
    const Real surface_slope = (posts.surface_m[i] - column.tx_m) * inverse;
    const Real horizon_slope = slope - model.median.half_curvature * range_m;
    const Real median_slope = surface_slope - model.median.half_curvature * range_m;
    const Real ducting_slope = surface_slope - model.ducting.half_curvature * range_m;
    if (horizon_slope > column.horizon_slope) {
      column.horizon_slope = horizon_slope;
      column.horizon = i;
    }
    column.steepest = slope > column.steepest ? slope : column.steepest;
    column.median_slope = median_slope > column.median_slope ? median_slope : column.median_slope;
    column.ducting_slope = ducting_slope > column.ducting_slope ? ducting_slope : column.ducting_slope;
  }
  column.median_slope += model.median.half_curvature * column.distance_m;
  column.ducting_slope += model.ducting.half_curvature * column.distance_m;
  column.trend_m[0] = Real(sums.start_m(distance_m));
  column.trend_m[1] = Real(sums.end_m(distance_m));
  column.is_unknown = std::isnan(sums.v1) || std::isnan(column.base_msl_m);
  return column;
}

}  // namespace emscape::propagation
