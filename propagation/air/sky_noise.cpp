#include "propagation/air/sky_noise.h"

#include <algorithm>
#include <cmath>

#include "propagation/air/gases.h"

namespace emscape::propagation {
namespace {

constexpr double kGround_k = 290;
constexpr double kGroundShare = 0.124;
constexpr double kCosmic_k = 2.7;
constexpr double kEarth_m = 6371e3;

double galaxy_k(double frequency_hz) {
  constexpr double kLast_mhz = 100;  // of P.372-16 eq. (13)
  const double mhz = frequency_hz / 1e6;
  const double figure_db = 52 - 23 * std::log10(std::min(mhz, kLast_mhz));
  return kGround_k * std::pow(10, figure_db / 10) * std::pow(std::max(mhz / kLast_mhz, 1.0), -2.75);
}

}  // namespace

double skyTemperature_k(double frequency_hz, double elevation_rad, const Atmosphere& atmosphere) {
  if (elevation_rad < 0) return kGround_k;
  const AirState sea = standardAtmosphere(0);
  const double radius_m = kEarth_m * atmosphere.k_factor;
  const double sine = std::sin(elevation_rad);
  const auto length_m = [&](double height_m) {
    if (height_m == 0) return 0.0;
    return height_m * (2 * radius_m + height_m) /
           (std::sqrt(radius_m * radius_m * sine * sine + height_m * (2 * radius_m + height_m)) +
            radius_m * sine);
  };
  const double top_m = kGasesHeight.max * kGasesHeight.si_per_unit;
  double temperature_k = 0, transmission = 1;
  double thickness_m = 10;
  for (double bottom_m = 0; bottom_m < top_m; bottom_m += thickness_m, thickness_m *= 1.03) {
    AirState air = standardAtmosphere(bottom_m + thickness_m / 2, atmosphere.vapour_g_m3);
    air.pressure_hpa *= atmosphere.pressure_hpa / sea.pressure_hpa;
    air.temperature_k *= atmosphere.temperature_k / sea.temperature_k;
    const double vapour_hpa = std::min(air.vapourPressure_hpa(), air.pressure_hpa);
    const double gamma_db_per_km = lineByLineGasAttenuation(frequency_hz, air.pressure_hpa - vapour_hpa,
                                                            air.temperature_k, air.vapour_g_m3)
                                       .total_db_per_km();
    const double layer_m = length_m(bottom_m + thickness_m) - length_m(bottom_m);
    const double passed = std::pow(10, -gamma_db_per_km * layer_m / 1e4);
    temperature_k += transmission * (1 - passed) * air.temperature_k;
    transmission *= passed;
  }
  return temperature_k + transmission * (galaxy_k(frequency_hz) + kCosmic_k);
}

double antennaTemperature_k(double frequency_hz, double elevation_rad, const Atmosphere& atmosphere) {
  return (1 - kGroundShare) * skyTemperature_k(frequency_hz, elevation_rad, atmosphere) +
         kGroundShare * kGround_k;
}

}  // namespace emscape::propagation
