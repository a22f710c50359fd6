/// Geometry of one path in ITU-R P.1812 and P.452: horizons, and heights above a smooth earth.
#pragma once

#include <cmath>

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

/// Posts per step of a loop: independent maxima, so that the compiler can use SIMD.
constexpr int kLanes = 8;

/// Maximum of a function of the posts between the ends, in lanes.
template <class Real>
struct LaneMaximum {
  Real lane[kLanes];

  EMSCAPE_HD LaneMaximum() {
    EMSCAPE_UNROLL
    for (int i = 0; i < kLanes; ++i) lane[i] = -Real(HUGE_VAL);
  }
  EMSCAPE_HD void take(int at, Real value) { lane[at] = value > lane[at] ? value : lane[at]; }
  EMSCAPE_HD Real largest() const {
    Real value = lane[0];
    EMSCAPE_UNROLL
    for (int i = 1; i < kLanes; ++i) value = lane[i] > value ? lane[i] : value;
    return value;
  }
};

/// Visits all posts between the ends, kLanes at a time.
/// @param visit  (int post, int lane)
template <class Real, class Visit>
EMSCAPE_HD void visitPosts(const ClearAirPosts<Real>& posts, Visit visit) {
  const int end = posts.count() - 1;
  int i = 1;
  for (; i + kLanes <= end; i += kLanes) {
    EMSCAPE_UNROLL
    for (int lane = 0; lane < kLanes; ++lane) visit(i + lane, lane);
  }
  for (; i < end; ++i) visit(i, 0);
}

template <class Real>
EMSCAPE_HD FromReceiver<Real> fromReceiver(const ClearAirModel<Real>& model,
                                           const ClearAirColumn<Real>& column, Real rx_m, Real slope) {
  const ClearAirPosts<Real>& posts = column.posts;
  const Real median_curvature = model.median.half_curvature, ducting_curvature = model.ducting.half_curvature;
  LaneMaximum<Real> above, steepest, horizon, median, ducting;
  visitPosts(posts, [&](int i, int lane) {
    const Real range_m = posts.range_m(i), terrain_m = posts.terrain_m(i);
    const Real plain = (terrain_m - rx_m) * posts.inverse_rx[i];
    const Real surface = (posts.surface_m[i] - rx_m) * posts.inverse_rx[i];
    above.take(lane, terrain_m - column.tx_m - slope * range_m);
    steepest.take(lane, plain);
    horizon.take(lane, plain + median_curvature * range_m);
    median.take(lane, surface + median_curvature * range_m);
    ducting.take(lane, surface + ducting_curvature * range_m);
  });
  return {above.largest(), steepest.largest(), horizon.largest() - median_curvature * column.distance_m,
          median.largest(), ducting.largest()};
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
  Real largest = -Real(HUGE_VAL);
  int post = 0;
  for (int i = 1; i < posts.count() - 1; ++i) {
    const Real value = valueOf(i);
    if (value >= largest) {
      largest = value;
      post = i;
    }
  }
  return post;
}

/// nu of Bullington's edge: P.1812-8 eq. (13) to (20), P.452-18 eq. (14) to (21).
template <class Real>
EMSCAPE_HD Real surfaceNu(const DiffractionModel<Real>& earth, const ClearAirColumn<Real>& column, Real slope,
                          Real tx_slope, Real rx_slope) {
  if (tx_slope >= slope) return bullingtonEdgeNu(earth, column.distance_m, slope, tx_slope, rx_slope);
  LaneMaximum<Real> nu;
  visitPosts(column.posts, [&](int i, int lane) {
    nu.take(lane, nuOf(earth, column, slope, i, column.posts.surface_m[i]));
  });
  return nu.largest();
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
  path.roughness_m = -Real(HUGE_VAL);
  for (int i = first; i <= last; ++i) {
    const Real above_m = posts.terrain_m(i) - path.smooth_m[0] - smooth_slope * posts.range_m(i);
    path.roughness_m = above_m > path.roughness_m ? above_m : path.roughness_m;
  }

  path.median_nu = surfaceNu(model.median, column, path.slope, column.median_slope, found.median_slope);
  path.ducting_nu = surfaceNu(model.ducting, column, path.slope, column.ducting_slope, found.ducting_slope);
  return path;
}

}  // namespace emscape::propagation
