#include "propagation/parabolic_equation/air/bulk_duct.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "propagation/air/moist_air.h"

namespace emscape::propagation {
namespace {

constexpr double kKarman = 0.4;
constexpr double kGravity_m_s2 = 9.80665;
constexpr double kDryGas_j_kg_k = 287.05;
constexpr double kVapourRatio = 0.62198;  ///< molar mass of water over that of dry air
constexpr double kVirtual = 1 / kVapourRatio - 1;
constexpr double kCharnock = 0.011;
constexpr double kInversion_m = 600;
constexpr double kGust = 1.25;
constexpr double kTop_m = 100, kLowest_m = 1e-4;
constexpr int kGradedHeights = 600;
constexpr double kTolerance = 0.02;
constexpr int kMaxIterations = 100;

void check(const char* what, double value, double lowest, double highest, const char* unit) {
  if (value >= lowest && value <= highest) return;
  throw Error(ErrorCode::bad_input, fmt::format("{} is {}, outside the allowed range {} to {}{}", what, value,
                                                lowest, highest, unit));
}

double specificHumidity(double vapour_hpa, double pressure_hpa) {
  return kVapourRatio * vapour_hpa / (pressure_hpa - (1 - kVapourRatio) * vapour_hpa);
}

double vapour_hpa(double specific_humidity, double pressure_hpa) {
  return specific_humidity * pressure_hpa / (kVapourRatio + (1 - kVapourRatio) * specific_humidity);
}

/// Unknowns of similarity theory.
struct Scales {
  double friction_m_s = 0, temperature_k = 0, humidity = 0;
  double inverse_length_m = 0;  ///< 1 / L
  double roughness_m = 0, heat_roughness_m = 0;
};

/// Inputs of the solution for the scales: differences between the sensors and the sea, and the air between.
struct Layer {
  double potential_difference_k = 0, humidity_difference = 0;
  double wind_m_s = 0, wind_height_m = 0, sensor_height_m = 0;
  double virtual_potential_k = 0, air_humidity = 0, air_temperature_k = 0;
  double viscosity_m2_s = 0, heat_capacity_j_kg_k = 0;
};

Scales nextScales(const Layer& layer, const Scales& before) {
  Scales scales;
  const double virtual_scale_k = before.temperature_k * (1 + kVirtual * layer.air_humidity) +
                                 kVirtual * layer.air_temperature_k * before.humidity;
  scales.inverse_length_m = kKarman * kGravity_m_s2 * virtual_scale_k /
                            (layer.virtual_potential_k * before.friction_m_s * before.friction_m_s);
  scales.roughness_m = kCharnock * before.friction_m_s * before.friction_m_s / kGravity_m_s2 +
                       0.11 * layer.viscosity_m2_s / before.friction_m_s;
  const double reynolds = scales.roughness_m * before.friction_m_s / layer.viscosity_m2_s;
  scales.heat_roughness_m = std::min(1.15e-4, 5.5e-5 * std::pow(reynolds, -0.6));
  const double convection_m_s = virtual_scale_k < 0
                                    ? std::cbrt(-kInversion_m * kGravity_m_s2 * before.friction_m_s *
                                                virtual_scale_k / layer.virtual_potential_k)
                                    : 0;
  const double wind_m_s = std::hypot(layer.wind_m_s, kGust * convection_m_s);
  const auto transfer = [&](double height_m, double roughness_m, double stability) {
    return kKarman / std::max(std::log(height_m / roughness_m) - stability, 1.0);
  };
  const double l = scales.inverse_length_m;
  scales.friction_m_s =
      wind_m_s * transfer(layer.wind_height_m, scales.roughness_m, stabilityOfWind(layer.wind_height_m * l));
  const double of_heat =
      transfer(layer.sensor_height_m, scales.heat_roughness_m, stabilityOfHeat(layer.sensor_height_m * l));
  scales.temperature_k = layer.potential_difference_k * of_heat;
  scales.humidity = layer.humidity_difference * of_heat;
  return scales;
}

/// Minimum of the parabola, in the logarithm of height, through the lowest level and its neighbours.
double heightOfMinimum_m(const std::vector<RefractivityLevel>& levels, std::size_t lowest) {
  const double z = levels[lowest].height_msl_m;
  if (lowest < 2) return z;
  const double below = levels[lowest - 1].m_units - levels[lowest].m_units,
               above = levels[lowest + 1].m_units - levels[lowest].m_units;
  const double step = std::log(levels[lowest + 1].height_msl_m / z);
  return below + above > 0 ? z * std::exp(step * (below - above) / (2 * (below + above))) : z;
}

/// Fixed point of nextScales(); half steps, so that stable air with little wind converges.
Scales solveScales(const Layer& layer) {
  Scales scales;
  scales.friction_m_s = 0.035 * layer.wind_m_s;
  scales.temperature_k = 0.035 * layer.potential_difference_k;
  scales.humidity = 0.035 * layer.humidity_difference;
  for (int i = 0; i < kMaxIterations; ++i) {
    Scales next = nextScales(layer, scales);
    const double change = std::fabs(next.friction_m_s / scales.friction_m_s - 1);
    next.friction_m_s = (next.friction_m_s + scales.friction_m_s) / 2;
    next.temperature_k = (next.temperature_k + scales.temperature_k) / 2;
    next.humidity = (next.humidity + scales.humidity) / 2;
    scales = next;
    if (change < 1e-9) break;
  }
  return scales;
}

}  // namespace

double stabilityOfWind(double zeta) {
  if (zeta <= 0) {
    const double x = std::sqrt(std::sqrt(1 - 16 * zeta));
    return 2 * std::log((1 + x) / 2) + std::log((1 + x * x) / 2) - 2 * std::atan(x) + kPi / 2;
  }
  // Grachev and others 2007, eq. (12), with a = 5, b = a / 6.5.
  constexpr double a = 5, b = a / 6.5;
  const double c = std::cbrt((1 - b) / b), x = std::cbrt(1 + zeta), root3 = std::sqrt(3.0);
  return -3 * a / b * (x - 1) +
         a * c / (2 * b) *
             (2 * std::log((x + c) / (1 + c)) - std::log((x * x - x * c + c * c) / (1 - c + c * c)) +
              2 * root3 * (std::atan((2 * x - c) / (root3 * c)) - std::atan((2 - c) / (root3 * c))));
}

double stabilityOfHeat(double zeta) {
  if (zeta <= 0) return 2 * std::log((1 + std::sqrt(1 - 16 * zeta)) / 2);
  // The same, eq. (13).
  constexpr double a = 10, b = 4.5, c = 3;
  const double root = std::sqrt(c * c - 4);
  return -b / 2 * std::log(1 + c * zeta + zeta * zeta) +
         (b * c / (2 * root) - a / root) *
             (std::log((2 * zeta + c - root) / (2 * zeta + c + root)) - std::log((c - root) / (c + root)));
}

BulkAir bulkAir(const BulkInputs& inputs) {
  check("air temperature", inputs.air_temperature_k, 223.15, 323.15, " K");
  check("sea temperature", inputs.sea_temperature_k, 270.55, 309.15, " K");
  check("relative humidity", inputs.relative_humidity_percent, 10, 100, " %");
  check("wind", inputs.wind_m_s, 0, 30, " m/s");
  check("pressure", inputs.pressure_hpa, 920, 1060, " hPa");
  check("salinity", inputs.salinity_psu, 0, 60, "");
  check("height of the sensors", inputs.sensor_height_m, 0.5, 50, " m");
  check("height of the wind's sensor", inputs.wind_height_m, 0.5, 50, " m");

  const double celsius = inputs.air_temperature_k - kFreezing_k;
  const auto pressureAt = [&](double height_m) {
    return inputs.pressure_hpa *
           std::exp(-kGravity_m_s2 * height_m / (kDryGas_j_kg_k * inputs.air_temperature_k));
  };
  const double sea_humidity = specificHumidity(
      (1 - 0.000537 * inputs.salinity_psu) * saturationPressure_hpa(inputs.sea_temperature_k),
      inputs.pressure_hpa);
  Layer layer;
  layer.air_temperature_k = inputs.air_temperature_k;
  layer.air_humidity = specificHumidity(
      inputs.relative_humidity_percent / 100 * saturationPressure_hpa(inputs.air_temperature_k),
      pressureAt(inputs.sensor_height_m));
  layer.heat_capacity_j_kg_k = 1005.6 + 0.017211 * celsius + 0.000392 * celsius * celsius;
  layer.viscosity_m2_s = 1.326e-5 * (1 + celsius * (6.542e-3 + celsius * (8.301e-6 - celsius * 4.84e-9)));
  const double potential_k =
      inputs.air_temperature_k + kGravity_m_s2 / layer.heat_capacity_j_kg_k * inputs.sensor_height_m;
  layer.potential_difference_k = potential_k - inputs.sea_temperature_k;
  layer.humidity_difference = layer.air_humidity - sea_humidity;
  layer.virtual_potential_k = potential_k * (1 + kVirtual * layer.air_humidity);
  layer.wind_m_s = std::max(inputs.wind_m_s, 0.1);
  layer.wind_height_m = inputs.wind_height_m;
  layer.sensor_height_m = inputs.sensor_height_m;
  const Scales scales = solveScales(layer);

  BulkAir air;
  air.friction_velocity_m_s = scales.friction_m_s;
  air.temperature_scale_k = scales.temperature_k;
  air.humidity_scale = scales.humidity;
  air.obukhov_length_m = 1 / scales.inverse_length_m;

  std::vector<RefractivityLevel> levels;
  bool is_possible = true;
  double pressure_hpa = inputs.pressure_hpa, virtual_below_k = 0;
  std::size_t lowest = 0, impossible = kGradedHeights;
  for (int i = 0; i < kGradedHeights; ++i) {
    // From the surface, then evenly in the logarithm of the height.
    const double z = i == 0 ? 0 : kLowest_m * std::pow(kTop_m / kLowest_m, (i - 1.0) / (kGradedHeights - 2));
    const double profile =
        z <= scales.heat_roughness_m
            ? 0
            : (std::log(z / scales.heat_roughness_m) - stabilityOfHeat(z * scales.inverse_length_m)) /
                  kKarman;
    const double temperature_k = inputs.sea_temperature_k + scales.temperature_k * profile -
                                 kGravity_m_s2 / layer.heat_capacity_j_kg_k * z;
    const double humidity = sea_humidity + scales.humidity * profile;
    const double virtual_k = temperature_k * (1 + kVirtual * humidity);
    if (i > 0) {
      pressure_hpa *= std::exp(-kGravity_m_s2 * (z - levels.back().height_msl_m) /
                               (kDryGas_j_kg_k * (virtual_k + virtual_below_k) / 2));
    }
    virtual_below_k = virtual_k;
    const double vapour = vapour_hpa(std::max(humidity, 0.0), pressure_hpa);
    is_possible = is_possible && humidity > 0 && temperature_k < kFreezing_k + 50 &&
                  vapour <= saturationPressure_hpa(temperature_k) * (1 + 1e-9);
    if (!is_possible) impossible = std::min(impossible, levels.size());
    levels.push_back({z, refractivity_n(pressure_hpa, temperature_k, vapour) + kFlatteningGradient_m * z});
    if (levels.back().m_units < levels[lowest].m_units) lowest = levels.size() - 1;
  }
  const bool is_defined = lowest + 1 < levels.size() && lowest + 1 < impossible;
  if (is_defined) air.duct_height_m = lowest == 0 ? 0 : heightOfMinimum_m(levels, lowest);
  air.profile = {thinned(levels, kTolerance)};
  return air;
}

}  // namespace emscape::propagation
