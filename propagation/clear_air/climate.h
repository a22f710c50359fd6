/// Radio climate of a path in ITU-R P.1812 and P.452: curvature of rays, and time percentage of ducts.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kClearAirLapseRate{
    "refractivity lapse rate",           "N-units/km", 1, 0, 150, Beyond::refused,
    "Delta N; 157 would be a flat earth"};
constexpr ModelLimit kClearAirHeight{"antenna height above ground",
                                     "m",
                                     1,
                                     1,
                                     3000,
                                     Beyond::warned,
                                     "below 1 m taken as 1 m; above, the models have no data"};

/// Mean radius of the earth in both recommendations (m).
constexpr double kClearAirEarthRadius_m = 6371e3;

/// Effective earth radius a_e (m) that is exceeded 50 % of the time.
/// @param lapse_rate  Delta N (N-units/km), positive, < 157
/// @see P.1812-8 eq. (6), (7a); P.452-18 eq. (5), (6a)
inline double medianEarthRadius_m(double lapse_rate) {
  return kClearAirEarthRadius_m * 157 / (157 - lapse_rate);
}
/// Effective earth radius a_beta (m) that is exceeded beta_0 of the time: P.1812-8 eq. (7b), P.452-18 (6b).
constexpr double kDuctingEarthRadius_m = 3 * kClearAirEarthRadius_m;

/// tau: parameter of the longest inland section of a path, 0..1.
/// @param longest_inland_m  d_lm, longest continuous inland section
/// @see P.1812-8 eq. (3); P.452-18 eq. (3)
template <class Real>
EMSCAPE_HD Real inlandPart(Real longest_inland_m) {
  return 1 - std::exp(Real(-4.12e-4) * std::pow(longest_inland_m / 1000, Real(2.41)));
}

/// beta_0: percentage of time in which the refractivity lapse rate exceeds 100 N-units/km in the lowest 100 m
/// of the atmosphere.
/// @param latitude_deg      of the path's middle
/// @param longest_land_m    d_tm, longest continuous section over land, coastal land included
/// @param longest_inland_m  d_lm
/// @see P.1812-8 eq. (2) to (5); P.452-18 eq. (2) to (4)
template <class Real>
EMSCAPE_HD Real ductingTime_percent(Real latitude_deg, Real longest_land_m, Real longest_inland_m) {
  const Real ten = 10;
  const Real tau = inlandPart(longest_inland_m);
  const Real by_land = std::pow(ten, -longest_land_m / 1000 / (16 - Real(6.6) * tau));
  Real mu1 = std::pow(by_land + std::pow(ten, -5 * (Real(0.496) + Real(0.354) * tau)), Real(0.2));
  mu1 = mu1 < 1 ? mu1 : Real(1);
  const Real latitude = std::fabs(latitude_deg);
  const bool is_polar = latitude > 70;
  const Real mu4 = std::pow(mu1, is_polar ? Real(0.3) : Real(-0.935) + Real(0.0176) * latitude);
  return (is_polar ? Real(4.17) : std::pow(ten, Real(-0.015) * latitude + Real(1.67))) * mu1 * mu4;
}

}  // namespace emscape::propagation
