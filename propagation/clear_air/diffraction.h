/// Diffraction loss not exceeded for a percentage of time: delta-Bullington over the effective earths for 50
/// % and beta_0 of the time, and interpolation between them.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/clear_air/path.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {

/// Losses over free space (dB).
template <class Real>
struct ClearAirDiffraction {
  DeltaBullington<Real> median;   ///< over a_e: L_d50
  DeltaBullington<Real> ducting;  ///< over a_beta: L_dbeta
  Real interpolation = 1;         ///< F_i: 0 at 50 % of the time, 1 at beta_0 and below
  Real loss_db = 0;               ///< L_dp
};

namespace clear_air_detail {

/// @param surface_nu  of Bullington's edge over the terrain and its clutter
/// @see P.1812-8 section 4.3.4, eq. (37) to (39); P.452-18 section 4.2.3
template <class Real>
EMSCAPE_HD DeltaBullington<Real> deltaBullington(DiffractionModel<Real> earth,
                                                 const ClearAirColumn<Real>& column,
                                                 const ClearAirPath<Real>& path, Real surface_nu) {
  const Real d = column.distance_m;
  const ClearAirPosts<Real>& posts = column.posts;
  earth.earth.sea_fraction = Real(column.zones.sea_fraction);
  DeltaBullington<Real> result;
  result.effective = path.diffraction_heights;
  result.terrain_db = bullingtonLossDb(surface_nu, d);
  result.loss_db = result.terrain_db;
  const auto around = [&posts](Real range_m) {
    const int end = posts.count() - 1;
    int before = 0, after = end;
    while (after - before > 1) {
      const int middle = (before + after) / 2;
      (posts.range_m(middle) < range_m ? before : after) = middle;
    }
    PostsAround<Real> found;
    if (before > 0) found.before_m = posts.range_m(before);
    if (after < end) found.after_m = posts.range_m(after);
    return found;
  };
  result.addEarth(earth.earth, d, [&] { return smoothEarthNu(earth, d, result.effective, around); });
  return result;
}

}  // namespace clear_air_detail

/// @see P.1812-8 section 4.3.5, eq. (40), (41); P.452-18 section 4.2.4
template <class Real>
EMSCAPE_HD ClearAirDiffraction<Real> clearAirDiffraction(const ClearAirModel<Real>& model,
                                                         const ClearAirColumn<Real>& column,
                                                         const ClearAirPath<Real>& path) {
  ClearAirDiffraction<Real> result;
  result.median = clear_air_detail::deltaBullington(model.median, column, path, path.median_nu);
  result.ducting = clear_air_detail::deltaBullington(model.ducting, column, path, path.ducting_nu);
  if (model.time_percent > column.ducting_time_percent) {
    result.interpolation = model.time_deviate / normalDeviate(column.ducting_time_percent / 100);
  }
  result.loss_db =
      result.median.loss_db + result.interpolation * (result.ducting.loss_db - result.median.loss_db);
  return result;
}

}  // namespace emscape::propagation
