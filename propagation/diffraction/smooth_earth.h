/// Bullington's edge over a smooth earth with a profile's posts: what delta-Bullington compares with the true
/// spherical earth.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

/// Posts at which the largest values were found last: they move little from receiver to receiver.
struct SmoothEarthPosts {
  int tx = 1, rx = 1, clear = 1;
};

/// Moves from a post to the last one not beyond a range, in 1..last.
template <class Real, class RangeOf>
EMSCAPE_HD int walkTo(int& post, Real range_m, int last, RangeOf rangeOf) {
  post = post < last ? post : last;
  while (post > 1 && rangeOf(post) > range_m) --post;
  while (post < last && rangeOf(post + 1) <= range_m) ++post;
  return post;
}

/// bullingtonNu over heights of 0, without looking at every post.
/// @param rangeOf         (int) -> range (m) of a post
/// @param findTx, findRx  (Real range_m) -> last post not beyond the horizon of either antenna, in 1..last
/// @param last            the last post before the receiver
/// @param clear           a post from which to look for the least clearance; it is left where that is
template <class Real, class RangeOf, class FindTx, class FindRx>
EMSCAPE_HD Real smoothEarthNu(const DiffractionModel<Real>& model, RangeOf rangeOf, FindTx findTx,
                              FindRx findRx, int last, Real distance_m, const EffectiveHeights<Real>& heights,
                              int& clear) {
  if (last < 1) return -Real(HUGE_VAL);
  const Real k = model.half_curvature;
  // Steepest ray to a point that an antenna sees at its horizon, or to the posts on either side of it.
  const auto txSlope = [&](int i) { return k * (distance_m - rangeOf(i)) - heights.tx_m / rangeOf(i); };
  const auto rxSlope = [&](int i) { return k * rangeOf(i) - heights.rx_m / (distance_m - rangeOf(i)); };
  const auto largerOf = [last](int post, auto slopeOf) {
    const Real before = slopeOf(post), after = slopeOf(post < last ? post + 1 : post);
    return before > after ? before : after;
  };
  const Real tx_slope = largerOf(findTx(std::sqrt(heights.tx_m / k)), txSlope);
  const Real slope_to_rx = (heights.rx_m - heights.tx_m) / distance_m;
  if (tx_slope >= slope_to_rx) {
    const Real rx_slope = largerOf(findRx(distance_m - std::sqrt(heights.rx_m / k)), rxSlope);
    return bullingtonEdgeNu(model, distance_m, slope_to_rx, tx_slope, rx_slope);
  }
  // The square of the clearance over d1 d2 has one least value between antennas that are not below ground.
  const auto closeness = [&](int i) {
    const Real d1 = rangeOf(i), d2 = distance_m - d1;
    const Real clearance = heights.tx_m + slope_to_rx * d1 - k * d1 * d2;
    return clearance * clearance / (d1 * d2);
  };
  clear = clear < last ? clear : last;
  Real least = closeness(clear);
  for (const int step : {-1, 1}) {
    while (clear + step >= 1 && clear + step <= last) {
      const Real next = closeness(clear + step);
      if (next > least) break;
      least = next;
      clear += step;
    }
  }
  return -std::sqrt(2 * distance_m / model.earth.wavelength_m * least);
}

}  // namespace emscape::propagation
