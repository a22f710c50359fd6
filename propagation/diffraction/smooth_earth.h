/// Bullington's edge over a smooth earth with the posts of a profile (P.526-15 section 4.5.3, step of
/// L_bulls), which delta-Bullington compares with the loss of the spherical earth.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

/// bullingtonNu over heights of 0, without visiting every post.
/// @param rangeOf         (int) -> range (m) of a post
/// @param lastBefore      (Real range_m) -> last post nearer than a range, in 1..last
/// @param last            the last post before the receiver
/// @param clear           post at which the search for the smallest clearance starts; set to where it is
template <class Real, class RangeOf, class LastBefore>
EMSCAPE_HD Real smoothEarthNu(const DiffractionModel<Real>& model, RangeOf rangeOf, LastBefore lastBefore,
                              int last, Real distance_m, const EffectiveHeights<Real>& heights, int& clear) {
  if (last < 1) return -Real(HUGE_VAL);
  const Real k = model.half_curvature;
  // Max slope from an antenna: at its horizon, that is at one of the posts on either side of it.
  const auto txSlope = [&](int i) { return k * (distance_m - rangeOf(i)) - heights.tx_m / rangeOf(i); };
  const auto rxSlope = [&](int i) { return k * rangeOf(i) - heights.rx_m / (distance_m - rangeOf(i)); };
  const auto maxOf = [last](int post, auto slopeOf) {
    const Real before = slopeOf(post), after = slopeOf(post < last ? post + 1 : post);
    return before > after ? before : after;
  };
  const Real tx_slope = maxOf(lastBefore(std::sqrt(heights.tx_m / k)), txSlope);
  const Real slope_to_rx = (heights.rx_m - heights.tx_m) / distance_m;
  if (tx_slope >= slope_to_rx) {
    const Real rx_slope = maxOf(lastBefore(distance_m - std::sqrt(heights.rx_m / k)), rxSlope);
    return bullingtonEdgeNu(model, distance_m, slope_to_rx, tx_slope, rx_slope);
  }
  // The square of the clearance over d1 d2 has a single minimum between antennas that are not below ground.
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
