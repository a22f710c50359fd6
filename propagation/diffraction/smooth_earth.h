/// Bullington's edge over a smooth earth with the posts of a profile (P.526-15 section 4.5.3, step of
/// L_bulls), which delta-Bullington compares with the loss of the spherical earth.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

/// The nearest posts on either side of a range, among those between the antennas; infinite: there is none.
template <class Real>
struct PostsAround {
  Real before_m = -Real(HUGE_VAL), after_m = Real(HUGE_VAL);
};

/// bullingtonNu over heights of 0, without visiting every post.
/// @param around   (Real range_m) -> PostsAround
/// @param heights  of the antennas above the earth
/// @return -infinity without a post between
template <class Real, class Around>
EMSCAPE_HD Real smoothEarthNu(const DiffractionModel<Real>& model, Real distance_m,
                              const EffectiveHeights<Real>& heights, const Around& around) {
  constexpr Real kNone = -Real(HUGE_VAL);
  const Real k = model.half_curvature, d = distance_m, tx_m = heights.tx_m, rx_m = heights.rx_m;
  // Each measure has a single maximum along the path: that of the posts is at one on either side of it.
  const auto largest = [&](Real range_m, const auto& valueAt) {
    const PostsAround<Real> posts = around(range_m);
    const Real before = posts.before_m > 0 ? valueAt(posts.before_m) : kNone;
    const Real after = posts.after_m < d ? valueAt(posts.after_m) : kNone;
    return before > after ? before : after;
  };
  // The slopes from the antennas: at their horizons.
  const Real tx_slope =
      largest(std::sqrt(tx_m / k), [=](Real range_m) { return k * (d - range_m) - tx_m / range_m; });
  const Real slope_to_rx = (rx_m - tx_m) / d;
  if (tx_slope >= slope_to_rx) {
    const Real rx_slope =
        largest(d - std::sqrt(rx_m / k), [=](Real range_m) { return k * range_m - rx_m / (d - range_m); });
    return bullingtonEdgeNu(model, d, slope_to_rx, tx_slope, rx_slope);
  }
  // The square of the clearance over d1 d2, between antennas that are not below ground: where its logarithm's
  // derivative changes its sign.
  Real nearer_m = 0, farther_m = d;
  for (int i = 0; i < 24; ++i) {
    const Real at_m = (nearer_m + farther_m) / 2, beyond_m = d - at_m;
    const Real clearance_m = tx_m + slope_to_rx * at_m - k * at_m * beyond_m;
    const Real rise = slope_to_rx - k * (beyond_m - at_m);
    const bool falls = 2 * rise * at_m * beyond_m < clearance_m * (beyond_m - at_m);
    nearer_m = falls ? at_m : nearer_m;
    farther_m = falls ? farther_m : at_m;
  }
  const Real most = largest(nearer_m, [=](Real range_m) {
    const Real beyond_m = d - range_m, clearance_m = tx_m + slope_to_rx * range_m - k * range_m * beyond_m;
    return -clearance_m * clearance_m / (range_m * beyond_m);
  });
  return -std::sqrt(-2 * d / model.earth.wavelength_m * most);
}

}  // namespace emscape::propagation
