/// Bullington's edge over a smooth earth with a profile's posts: what delta-Bullington compares with the true
/// spherical earth.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "emfield/models/diffraction.h"

namespace emscape::emfield {

/// Posts between which the largest values were found last: they move little from receiver to receiver.
struct SmoothEarthPosts {
  int tx = 1, rx = 1, clear = 1;
};

/// bullingtonNu over heights of 0, without looking at every post.
/// @param rangeOf  (int) -> range (m) of a post
/// @param last     the last post before the receiver
/// @param at       where to begin to look; any posts will do
template <class Real, class RangeOf>
EMSCAPE_HD Real smoothEarthNu(const DiffractionModel<Real>& model, RangeOf rangeOf, int last, Real distance_m,
                              const EffectiveHeights<Real>& heights, SmoothEarthPosts& at) {
  if (last < 1) return -Real(HUGE_VAL);
  const Real k = model.half_curvature;
  // Steepest ray to a point that an antenna sees at its horizon, or to the posts on either side of it.
  const auto walkTo = [&](int& post, Real range_m) {
    post = post < last ? post : last;
    while (post > 1 && rangeOf(post) > range_m) --post;
    while (post < last && rangeOf(post + 1) <= range_m) ++post;
    return post < last ? post + 1 : post;
  };
  const auto txSlope = [&](int i) { return k * (distance_m - rangeOf(i)) - heights.tx_m / rangeOf(i); };
  const auto rxSlope = [&](int i) { return k * rangeOf(i) - heights.rx_m / (distance_m - rangeOf(i)); };
  const int tx_next = walkTo(at.tx, std::sqrt(heights.tx_m / k));
  const Real tx_before = txSlope(at.tx), tx_after = txSlope(tx_next);
  const Real tx_slope = tx_before > tx_after ? tx_before : tx_after;
  const Real slope_to_rx = (heights.rx_m - heights.tx_m) / distance_m;
  if (tx_slope >= slope_to_rx) {
    const int rx_next = walkTo(at.rx, distance_m - std::sqrt(heights.rx_m / k));
    const Real rx_before = rxSlope(at.rx), rx_after = rxSlope(rx_next);
    const Real rx_slope = rx_before > rx_after ? rx_before : rx_after;
    return bullingtonEdgeNu(model, distance_m, slope_to_rx, tx_slope, rx_slope);
  }
  // The square of the clearance over d1 d2 has one least value between antennas that are not below ground.
  const auto closeness = [&](int i) {
    const Real d1 = rangeOf(i), d2 = distance_m - d1;
    const Real clearance = heights.tx_m + slope_to_rx * d1 - k * d1 * d2;
    return clearance * clearance / (d1 * d2);
  };
  at.clear = at.clear < last ? at.clear : last;
  Real least = closeness(at.clear);
  for (const int step : {-1, 1}) {
    while (at.clear + step >= 1 && at.clear + step <= last) {
      const Real next = closeness(at.clear + step);
      if (next > least) break;
      least = next;
      at.clear += step;
    }
  }
  return -std::sqrt(2 * distance_m / model.earth.wavelength_m * least);
}

}  // namespace emscape::emfield
