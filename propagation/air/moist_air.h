/// Refractivity of moist air.
#pragma once

#include <cmath>

namespace emscape::propagation {

constexpr double kFreezing_k = 273.15;

/// Pressure of saturated vapour over water (hPa). @see Rec. ITU-R P.453-8 eq. (9)
inline double saturationPressure_hpa(double temperature_k) {
  const double celsius = temperature_k - kFreezing_k;
  return 6.1121 * std::exp(17.502 * celsius / (celsius + 240.97));
}

/// N = (n - 1) 10^6 of moist air; within 0.5 % up to 100 GHz.
/// @param pressure_hpa  of dry air and vapour
/// @see Rec. ITU-R P.453-8 eq. (6)
inline double refractivity_n(double pressure_hpa, double temperature_k, double vapour_hpa) {
  return 77.6 / temperature_k * (pressure_hpa + 4810 * vapour_hpa / temperature_k);
}

}  // namespace emscape::propagation
