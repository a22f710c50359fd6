#include "propagation/air/gases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "propagation/air/gases_equivalent_height.h"
#include "propagation/air/gases_tables.h"

namespace emscape::propagation {
namespace {

/// P.676-13 eq. (5): shape of a line.
double lineShape(double f, double f0, double width, double delta) {
  const double below = f0 - f, above = f0 + f;
  return f / f0 *
         ((width - delta * below) / (below * below + width * width) +
          (width - delta * above) / (above * above + width * width));
}

double pressureOver(double height_km, const TemperatureLayer& layer) {
  constexpr double kHydrostatic = 34.1632;  // K/km: molar mass of air times gravity over the gas constant
  const double above = height_km - layer.base_km;
  if (layer.gradient_k_per_km == 0) {
    return layer.base_hpa * std::exp(-kHydrostatic * above / layer.base_k);
  }
  return layer.base_hpa * std::pow(layer.base_k / (layer.base_k + layer.gradient_k_per_km * above),
                                   kHydrostatic / layer.gradient_k_per_km);
}

}  // namespace

GasAttenuation gasAttenuation(double frequency_hz, double dry_pressure_hpa, double temperature_k,
                              double vapour_g_m3) {
  return lineByLineGasAttenuation(
      std::clamp(frequency_hz, kGasesFrequency.min * 1e9, kGasesFrequency.max * 1e9), dry_pressure_hpa,
      temperature_k, vapour_g_m3);
}

GasAttenuation lineByLineGasAttenuation(double frequency_hz, double dry_pressure_hpa, double temperature_k,
                                        double vapour_g_m3) {
  const double f = frequency_hz / 1e9;
  const double theta = 300 / temperature_k;
  const double p = dry_pressure_hpa;
  const double e = vapour_g_m3 * temperature_k / 216.7;  // eq. (4)
  const double theta08 = std::pow(theta, 0.8);
  if (p + e == 0) return {};

  double oxygen = 0;
  for (const SpectralLine& line : kOxygenLines) {
    const auto& [f0, a1, a2, a3, a4, a5, a6] = line;
    const double strength = a1 * 1e-7 * p * theta * theta * theta * std::exp(a2 * (1 - theta));   // (3)
    const double pressure_width = a3 * 1e-4 * (p * std::pow(theta, 0.8 - a4) + 1.1 * e * theta);  // (6a)
    const double width = std::sqrt(pressure_width * pressure_width + 2.25e-6);  // (6b), Zeeman splitting
    const double delta = (a5 + a6 * theta) * 1e-4 * (p + e) * theta08;          // (7)
    oxygen += strength * lineShape(f, f0, width, delta);
  }
  const double d = 5.6e-4 * (p + e) * theta08;  // (9)
  const double dry_continuum = f * p * theta * theta *
                               (6.14e-5 / (d * (1 + (f / d) * (f / d))) +
                                1.4e-12 * p * std::pow(theta, 1.5) / (1 + 1.9e-5 * std::pow(f, 1.5)));  // (8)

  double vapour = 0;
  for (const SpectralLine& line : kVapourLines) {
    const auto& [f0, b1, b2, b3, b4, b5, b6] = line;
    const double strength = b1 * 1e-1 * e * std::pow(theta, 3.5) * std::exp(b2 * (1 - theta));  // (3)
    const double pressure_width =
        b3 * 1e-4 * (p * std::pow(theta, b4) + b5 * e * std::pow(theta, b6));  // (6a)
    const double width = 0.535 * pressure_width + std::sqrt(0.217 * pressure_width * pressure_width +
                                                            2.1316e-12 * f0 * f0 / theta);  // (6b), Doppler
    vapour += strength * lineShape(f, f0, width, 0);
  }
  return {0.182 * f * (oxygen + dry_continuum), 0.182 * f * vapour};  // (1), (2)
}

AirState standardAtmosphere(double height_msl_m, double surface_vapour_g_m3) {
  const double height_km = std::max(height_msl_m / 1000, kGasesHeight.min);
  AirState air{0, 0, 0};
  if (height_km > kGasesHeight.max) {
    air.temperature_k = 195.08;
    return air;
  }
  if (height_km <= 86) {
    const double geopotential_km = 6356.766 * height_km / (6356.766 + height_km);  // eq. (1a)
    const TemperatureLayer* layer = std::end(kTemperatureLayers) - 1;
    while (layer != kTemperatureLayers && geopotential_km < layer->base_km) --layer;
    air.temperature_k = layer->base_k + layer->gradient_k_per_km * (geopotential_km - layer->base_km);
    air.pressure_hpa = pressureOver(geopotential_km, *layer);
  } else {
    const double bow = (height_km - 91) / 19.9429;
    air.temperature_k = height_km <= 91 ? 186.8673 : 263.1905 - 76.3232 * std::sqrt(1 - bow * bow);  // (4)
    const double h = height_km;
    air.pressure_hpa = std::exp(
        95.571899 + h * (-4.011801 + h * (6.424731e-2 + h * (-4.789660e-4 + h * 1.340543e-6))));  // (5)
  }
  const double driest = 2e-6 * air.pressure_hpa * 216.7 / air.temperature_k;
  air.vapour_g_m3 = std::max(surface_vapour_g_m3 * std::exp(-height_km / 2), driest);  // (6)
  return air;
}

double oxygenEquivalentHeight_km(double frequency_ghz, const AirState& surface) {
  const OxygenHeight* high =
      std::upper_bound(std::begin(kOxygenHeights) + 1, std::end(kOxygenHeights) - 1, frequency_ghz,
                       [](double f, const OxygenHeight& row) { return f < row.frequency_ghz; });
  const auto heightOf = [&](const OxygenHeight& row) {  // eq. (31)
    return row.a + row.b * surface.temperature_k + row.c * surface.pressure_hpa + row.d * surface.vapour_g_m3;
  };
  const OxygenHeight& low = high[-1];
  const double t = (frequency_ghz - low.frequency_ghz) / (high->frequency_ghz - low.frequency_ghz);
  return (1 - t) * heightOf(low) + t * heightOf(*high);
}

double vapourEquivalentHeight_km(double frequency_ghz) {
  // eq. (37), table 4
  constexpr struct {
    double f, a, b;
  } kLines[] = {{22.235080, 2.6846, 2.7649}, {183.310087, 5.8905, 4.9219}, {325.152888, 2.9810, 3.0748}};
  double height_km = 5.6585e-5 * frequency_ghz + 1.8348;
  for (const auto& line : kLines) {
    const double off = frequency_ghz - line.f;
    height_km += line.a / (off * off + line.b);
  }
  return height_km;
}

double slantGasAttenuationDb(double frequency_hz, double elevation_rad, const AirState& surface) {
  if (!kGasesSlantFrequency.holds(frequency_hz) || !kGasesElevation.holds(elevation_rad)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double frequency_ghz = frequency_hz / 1e9;
  const GasAttenuation gamma = gasAttenuation(frequency_hz, surface);
  return (gamma.oxygen_db_per_km * oxygenEquivalentHeight_km(frequency_ghz, surface) +
          gamma.vapour_db_per_km * vapourEquivalentHeight_km(frequency_ghz)) /
         std::sin(elevation_rad);  // eq. (28) to (30), (36)
}

}  // namespace emscape::propagation
