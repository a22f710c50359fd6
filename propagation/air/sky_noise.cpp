#include "propagation/air/sky_noise.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "propagation/air/gases.h"

namespace emscape::propagation {
namespace {

constexpr double kGround_k = 290;
constexpr double kGroundShare = 0.124;
constexpr double kCosmic_k = 2.7;
constexpr double kEarth_m = 6371e3;

/// Places and weights of Gauss and Legendre's rule from -1 to 1.
/// @see Abramowitz and Stegun, Handbook of Mathematical Functions, table 25.4
struct Node {
  double place, weight;
};
constexpr Node kGaussLegendre8[] = {
    {-0.960289856497536, 0.101228536290376}, {-0.796666477413627, 0.222381034453374},
    {-0.525532409916329, 0.313706645877887}, {-0.183434642495650, 0.362683783378362},
    {0.183434642495650, 0.362683783378362},  {0.525532409916329, 0.313706645877887},
    {0.796666477413627, 0.222381034453374},  {0.960289856497536, 0.101228536290376}};

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

double antennaTemperature_k(double frequency_hz, double elevation_rad, double beamwidth_rad,
                            const Atmosphere& atmosphere) {
  constexpr double kReach = 2.5;  // of the beam, in standard deviations
  const double deviation_rad = std::min(beamwidth_rad, kPi / 3) / std::sqrt(8 * std::log(2.0));
  const double first_rad = std::max(elevation_rad - kReach * deviation_rad, 0.0);
  const double last_rad = elevation_rad + kReach * deviation_rad;
  const auto shareBelow = [&](double angle_rad) {
    return 0.5 * std::erfc((elevation_rad - angle_rad) / (std::sqrt(2.0) * deviation_rad));
  };
  double beam_k = kGround_k, of_sky = 0, weights = 0;
  if (last_rad > first_rad) {
    for (const auto& [place, weight] : kGaussLegendre8) {
      const double angle_rad = first_rad + (last_rad - first_rad) * (place + 1) / 2;
      const double off = (angle_rad - elevation_rad) / deviation_rad;
      const double here = weight * std::exp(-off * off / 2);
      const double from_level_rad = std::min(angle_rad, kPi - angle_rad);  // beyond the zenith
      of_sky += here * skyTemperature_k(frequency_hz, from_level_rad, atmosphere);
      weights += here;
    }
    const double ground = shareBelow(0);
    beam_k = ground * kGround_k + (1 - ground) * of_sky / weights;
  }
  return (1 - kGroundShare) * beam_k + kGroundShare * kGround_k;
}

}  // namespace emscape::propagation
