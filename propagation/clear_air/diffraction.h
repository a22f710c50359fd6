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
  earth.earth.sea_fraction = Real(column.zones.sea_fraction);
  DeltaBullington<Real> result;
  result.effective = path.diffraction_heights;
  result.terrain_db = bullingtonLossDb(surface_nu, d);
  result.spherical_db =
      sphericalEarthLossDb(earth.earth, d, path.diffraction_heights.tx_m, path.diffraction_heights.rx_m);
  result.loss_db = result.terrain_db;
  if (!(result.spherical_db > 0)) return result;
  const ClearAirPosts<Real>& posts = column.posts;
  const int last = posts.count() - 2;
  const auto rangeOf = [&posts](int i) { return posts.range_m(i); };
  const auto lastBefore = [&](Real range_m) {
    int first = 1, end = last + 1;  // the answer is in first..end - 1
    while (end - first > 1) {
      const int middle = (first + end) / 2;
      (rangeOf(middle) < range_m ? first : end) = middle;
    }
    return first;
  };
  const EffectiveHeights<Real>& heights = result.effective;
  int clear = last < 1 ? 1 : lastBefore(d * heights.tx_m / (heights.tx_m + heights.rx_m));
  const Real nu = smoothEarthNu(earth, rangeOf, lastBefore, last, d, heights, clear);
  result.smooth_db = bullingtonLossDb(nu, d);
  const Real correction_db = result.spherical_db - result.smooth_db;
  result.loss_db += correction_db > 0 ? correction_db : Real(0);
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
