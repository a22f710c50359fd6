#include "propagation/p528/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "propagation/air/gases.h"

namespace emscape::propagation {
namespace {

/// Refractivity and absorption are tabulated: their logarithms, linear between heights. Their scale heights
/// are at least 2 km, so that the relative error of the tables is below 2e-5.
constexpr double kSpacing_km = 0.025;
constexpr double kTop_km = 21;

/// P.676-12 Annex 1, (14) to (16c): layers grow with height by 1 % each.
constexpr double kGrowth = 1.0 / 100;

double layersTo(double height_km) {
  return std::log(1e4 * height_km * std::expm1(kGrowth) + 1) / kGrowth + 1;
}

/// Angle from one direction to a steeper one, both with a level component of the same size.
double angleBetween(double level, double rising, double rising_more) {
  constexpr double kSmall = 0.01;
  const double tangent = level * (rising_more - rising) / (level * level + rising * rising_more);
  if (!(std::fabs(tangent) < kSmall)) return std::atan(tangent);
  const double square = tangent * tangent;
  return tangent * (1 - square * (1.0 / 3 - square / 5));
}

}  // namespace

P528Atmosphere::P528Atmosphere(double frequency_hz) {
  const int count = static_cast<int>(kTop_km / kSpacing_km) + 1;
  for (int i = 0; i < count; ++i) {
    const AirState air = standardAtmosphere(1000 * kSpacing_km * i);
    const double vapour_hpa = air.vapourPressure_hpa();
    const double t = air.temperature_k;
    const double refractivity =
        77.6 * air.pressure_hpa / t + 72 * vapour_hpa / t + 3.75e5 * vapour_hpa / (t * t);
    log_refractivity_.push_back(std::log(refractivity));
    log_absorption_.push_back(std::log(
        lineByLineGasAttenuation(frequency_hz, air.pressure_hpa, t, air.vapour_g_m3).total_db_per_km()));
  }
}

P528Atmosphere::Air P528Atmosphere::airAt(double height_km) const {
  const double at = height_km / kSpacing_km;
  const auto below = std::min(static_cast<std::size_t>(at), log_refractivity_.size() - 2);
  const double fraction = at - static_cast<double>(below);
  const auto value = [&](const std::vector<double>& logs) {
    return std::exp(logs[below] + (logs[below + 1] - logs[below]) * fraction);
  };
  return {1 + 1e-6 * value(log_refractivity_), value(log_absorption_)};
}

P528Ray P528Atmosphere::traceUp(double lower_km, double upper_km, double elevation_rad) const {
  P528Ray ray;
  ray.upper_elevation_rad = elevation_rad;
  if (!(upper_km > lower_km)) return ray;
  const int first = static_cast<int>(std::floor(layersTo(lower_km)));
  const int last = static_cast<int>(std::ceil(layersTo(upper_km)));
  double thickness_km = (upper_km - lower_km) * std::expm1(kGrowth) / std::expm1((last - first) * kGrowth);
  double height_km = lower_km;
  Air air = airAt(height_km + thickness_km / 2);
  // Snell's law in spherical layers: n r cos(elevation) is constant
  const double invariant_km =
      air.refractive_index * (kP528EarthRadius_km + lower_km) * std::cos(elevation_rad);
  // n r sin(elevation)
  const auto risingAt = [invariant_km](double n_r_km) {
    return std::sqrt(std::max(0.0, (n_r_km - invariant_km) * (n_r_km + invariant_km)));
  };
  double upper_rising_km = 0;
  for (int layer = first; layer < last; ++layer) {
    const double radius_km = kP528EarthRadius_km + height_km;
    const double rising_km = risingAt(air.refractive_index * radius_km);
    if (layer > first) ray.bending_rad += angleBetween(invariant_km, rising_km, upper_rising_km);
    const double rise_km = rising_km / air.refractive_index;
    // (17)
    const double length_km =
        thickness_km * (2 * radius_km + thickness_km) /
        (rise_km + std::sqrt(rise_km * rise_km + thickness_km * (2 * radius_km + thickness_km)));
    ray.length_km += length_km;
    ray.absorption_db += length_km * air.absorption_db_km;
    height_km += thickness_km;
    upper_rising_km = risingAt(air.refractive_index * (kP528EarthRadius_km + height_km));
    thickness_km *= std::exp(kGrowth);
    air = airAt(height_km + thickness_km / 2);
  }
  ray.upper_elevation_rad = std::atan2(upper_rising_km, invariant_km);
  return ray;
}

double P528Atmosphere::grazingHeight_km(double height_km, double elevation_rad) const {
  const double invariant_km =
      airAt(height_km).refractive_index * (kP528EarthRadius_km + height_km) * std::cos(elevation_rad);
  // By bisection to 1 m, as in the published figures, on which the path's length depends near grazing.
  constexpr double kTolerance_km = 0.001;
  double grazing_km = height_km;
  double step_km = height_km / 2;
  double above_km = 1;
  do {
    grazing_km += above_km > 0 ? -step_km : step_km;
    step_km /= 2;
    above_km = airAt(grazing_km).refractive_index * (kP528EarthRadius_km + grazing_km) - invariant_km;
  } while (std::fabs(above_km) > kTolerance_km && step_km > kTolerance_km / 1000);
  return grazing_km;
}

P528Ray P528Atmosphere::trace(double lower_km, double upper_km, double elevation_rad) const {
  if (elevation_rad >= 0) return traceUp(lower_km, upper_km, elevation_rad);
  const double grazing_km = grazingHeight_km(lower_km, elevation_rad);
  const P528Ray down = traceUp(grazing_km, lower_km, 0);
  P528Ray ray = traceUp(grazing_km, upper_km, 0);
  ray.length_km += down.length_km;
  ray.absorption_db += down.absorption_db;
  ray.bending_rad += down.bending_rad;
  return ray;
}

}  // namespace emscape::propagation
