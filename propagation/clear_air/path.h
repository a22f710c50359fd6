/// Geometry of one path in ITU-R P.1812 and P.452: horizons, and heights above a smooth earth.
#pragma once

#include <cmath>

#include "base/math/simd.h"
#include "emscape/base/host_device.h"
#include "propagation/clear_air/column.h"

namespace emscape::propagation {

/// A path's geometry. Of arrays of two the first element is the transmitter's, the second the receiver's.
template <class Real>
struct ClearAirPath {
  Real rx_m = 0;   ///< antenna; heights are from the ground at the transmitter
  Real slope = 0;  ///< of the line of sight, (h_rs - h_ts) / d
  bool is_transhorizon = false;
  /// d_lt, d_lr: of the horizons; in line of sight, of the post closest to the ray
  Real horizon_distance_m[2] = {};
  Real horizon_angle_mrad[2] = {};               ///< theta_t, theta_r
  Real angle_mrad = 0;                           ///< theta: path angular distance
  Real smooth_m[2] = {};                         ///< h_st, h_sr: smooth earth for ducting
  Real ducting_height_m[2] = {};                 ///< h_te, h_re: antennas above it
  Real roughness_m = 0;                          ///< h_m
  EffectiveHeights<Real> diffraction_heights{};  ///< antennas over the smooth earth of diffraction
  Real median_nu = 0;                            ///< nu of Bullington's edge over a_e
  Real ducting_nu = 0;                           ///< the same over a_beta
};

namespace clear_air_detail {

/// Maxima over all posts, from the receiver's side.
template <class Real>
struct FromReceiver {
  Real above_m;   ///< largest height over the line of sight, without the earth's bulge
  Real steepest;  ///< slopes to posts, as those of ClearAirColumn
  Real horizon_slope;
  Real median_slope;
  Real ducting_slope;
};

template <class Real>
EMSCAPE_HD FromReceiver<Real> fromReceiver(const ClearAirModel<Real>& model,
                                           const ClearAirColumn<Real>& column, Real rx_m, Real slope) {
  const ClearAirPosts<Real>& posts = column.posts;
  const Real median_curvature = model.median.half_curvature, ducting_curvature = model.ducting.half_curvature;
  const Real tx_m = column.tx_m;
  const Real *const surface_m = posts.surface_m, *const inverse_rx = posts.inverse_rx;
  const int end = posts.count() - 1;
  constexpr Real kNone = -Real(HUGE_VAL);
  Real above = kNone, steepest = kNone, horizon = kNone, median = kNone, ducting = kNone;
  EMSCAPE_SIMD(reduction(max : above, steepest, horizon, median, ducting))
  for (int i = 1; i < end; ++i) {
    const Real range_m = posts.range_m(i), terrain_m = posts.terrain_m(i);
    const Real plain = (terrain_m - rx_m) * inverse_rx[i];
    const Real surface = (surface_m[i] - rx_m) * inverse_rx[i];
    const Real height = terrain_m - tx_m - slope * range_m;
    const Real plain_median = plain + median_curvature * range_m;
    const Real surface_median = surface + median_curvature * range_m;
    const Real surface_ducting = surface + ducting_curvature * range_m;
    above = height > above ? height : above;
    steepest = plain > steepest ? plain : steepest;
    horizon = plain_median > horizon ? plain_median : horizon;
    median = surface_median > median ? surface_median : median;
    ducting = surface_ducting > ducting ? surface_ducting : ducting;
  }
  return {above, steepest, horizon - median_curvature * column.distance_m, median, ducting};
}

/// nu of a post for a line of sight.
template <class Real>
EMSCAPE_HD Real nuOf(const DiffractionModel<Real>& earth, const ClearAirColumn<Real>& column, Real slope,
                     int post, Real height_m) {
  const Real range_m = column.posts.range_m(post);
  const Real rise = earth.half_curvature * (column.distance_m - range_m) - slope;
  return (height_m - column.tx_m + rise * range_m) * column.posts.nu_per_m[post];
}

/// The last of the posts between the ends at which a function has its largest value; 0: there is none.
template <class Real, class ValueOf>
EMSCAPE_HD int postOfLargest(const ClearAirPosts<Real>& posts, ValueOf valueOf) {
  const int end = posts.count() - 1;
  Real largest = -Real(HUGE_VAL);
  EMSCAPE_SIMD(reduction(max : largest))
  for (int i = 1; i < end; ++i) {
    const Real value = valueOf(i);
    largest = value > largest ? value : largest;
  }
  int post = 0;
  EMSCAPE_SIMD(reduction(max : post))
  for (int i = 1; i < end; ++i) {
    const int here = valueOf(i) >= largest ? i : 0;
    post = here > post ? here : post;
  }
  return post;
}

/// nu of Bullington's edge: P.1812-8 eq. (13) to (20), P.452-18 eq. (14) to (21).
template <class Real>
EMSCAPE_HD Real surfaceNu(const DiffractionModel<Real>& earth, const ClearAirColumn<Real>& column, Real slope,
                          Real tx_slope, Real rx_slope) {
  if (tx_slope >= slope) return bullingtonEdgeNu(earth, column.distance_m, slope, tx_slope, rx_slope);
  const int end = column.posts.count() - 1;
  Real largest = -Real(HUGE_VAL);
  EMSCAPE_SIMD(reduction(max : largest))
  for (int i = 1; i < end; ++i) {
    const Real nu = nuOf(earth, column, slope, i, column.posts.surface_m[i]);
    largest = nu > largest ? nu : largest;
  }
  return largest;
}

}  // namespace clear_air_detail

/// @param rx_msl_m  of the antenna, no lower than DiffractionModel::raised_m allows
/// @see P.1812-8 Attachment 1 to Annex 1; P.452-18 Attachment 2 to Annex 1
template <class Real>
EMSCAPE_HD ClearAirPath<Real> clearAirPath(const ClearAirModel<Real>& model,
                                           const ClearAirColumn<Real>& column, Real rx_msl_m) {
  using namespace clear_air_detail;
  const ClearAirPosts<Real>& posts = column.posts;
  const Real d = column.distance_m, curvature = 2 * model.median.half_curvature;
  const Real tx_m = column.tx_m;
  ClearAirPath<Real> path;
  path.rx_m = model.median.raised_m(rx_msl_m - column.base_msl_m, column.rx_ground_m);
  path.slope = (path.rx_m - tx_m) / d;
  const FromReceiver<Real> found = fromReceiver(model, column, path.rx_m, path.slope);

  const Real bulge = model.median.half_curvature * d;
  path.is_transhorizon = column.horizon_slope > path.slope - bulge;
  int first = 0, last = 0;  // posts of the horizons
  Real horizon_slope[2] = {path.slope - bulge, -path.slope - bulge};
  if (path.is_transhorizon) {
    first = column.horizon;
    last = postOfLargest(posts, [&](int i) {
      return (posts.terrain_m(i) - path.rx_m) * posts.inverse_rx[i] +
             model.median.half_curvature * posts.range_m(i);
    });
    horizon_slope[0] = column.horizon_slope;
    horizon_slope[1] = found.horizon_slope;
  } else {
    first = last = postOfLargest(
        posts, [&](int i) { return nuOf(model.median, column, path.slope, i, posts.terrain_m(i)); });
  }
  path.horizon_distance_m[0] = posts.range_m(first);
  path.horizon_distance_m[1] = d - posts.range_m(last);
  for (int end = 0; end < 2; ++end) path.horizon_angle_mrad[end] = 1000 * std::atan(horizon_slope[end]);
  path.angle_mrad = 1000 * d * curvature + path.horizon_angle_mrad[0] + path.horizon_angle_mrad[1];

  TerrainTrend<Real> trend;
  trend.start_msl_m = column.trend_m[0];
  trend.end_msl_m = column.trend_m[1];
  trend.highest_m = found.above_m;
  trend.tx_angle = column.steepest - path.slope;
  trend.rx_angle = found.steepest + path.slope;
  trend.tx_ground_msl_m = 0;
  trend.rx_ground_msl_m = column.rx_ground_m;
  path.diffraction_heights = effectiveHeights(trend, tx_m, path.rx_m);

  path.smooth_m[0] = column.trend_m[0] < 0 ? column.trend_m[0] : Real(0);
  path.smooth_m[1] = column.trend_m[1] < column.rx_ground_m ? column.trend_m[1] : column.rx_ground_m;
  path.ducting_height_m[0] = tx_m - path.smooth_m[0];
  path.ducting_height_m[1] = path.rx_m - path.smooth_m[1];
  const Real smooth_slope = (path.smooth_m[1] - path.smooth_m[0]) / d;
  const Real smooth_m = path.smooth_m[0];
  Real roughness_m = -Real(HUGE_VAL);
  EMSCAPE_SIMD(reduction(max : roughness_m))
  for (int i = first; i <= last; ++i) {
    const Real above_m = posts.terrain_m(i) - smooth_m - smooth_slope * posts.range_m(i);
    roughness_m = above_m > roughness_m ? above_m : roughness_m;
  }
  path.roughness_m = roughness_m;

  path.median_nu = surfaceNu(model.median, column, path.slope, column.median_slope, found.median_slope);
  path.ducting_nu = surfaceNu(model.ducting, column, path.slope, column.ducting_slope, found.ducting_slope);
  return path;
}

}  // namespace emscape::propagation
