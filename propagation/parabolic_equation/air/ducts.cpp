#include "propagation/parabolic_equation/air/ducts.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"

namespace emscape::propagation {
namespace {

constexpr double kMinStrength_m_units = 0.1;

/// Integral of sqrt(2e-6 x) over a height in which x is linear from a to b, both >= 0.
double pieceOfPhase_m(double height_m, double a, double b) {
  const double root_a = std::sqrt(std::max(a, 0.0)), root_b = std::sqrt(std::max(b, 0.0));
  if (root_a + root_b == 0) return 0;
  // (a^1.5 - b^1.5) / (a - b), without the difference of equal numbers.
  const double mean = 2.0 / 3 * (root_a * root_a + root_a * root_b + root_b * root_b) / (root_a + root_b);
  return std::sqrt(2e-6) * height_m * mean;
}

/// Duct below the top level of a layer in which M decreases.
Duct ductBelow(const RefractivityProfile& profile, std::size_t layer_base, std::size_t top) {
  const std::vector<RefractivityLevel>& levels = profile.levels;
  const double m_top = levels[top].m_units;
  Duct duct;
  duct.top_msl_m = levels[top].height_msl_m;
  duct.layer_base_msl_m = levels[layer_base].height_msl_m;
  duct.base_msl_m = levels.front().height_msl_m;
  bool is_elevated = false;
  for (std::size_t i = top; i > 0; --i) {
    const RefractivityLevel &upper = levels[i], &lower = levels[i - 1];
    const double a = lower.m_units - m_top, b = upper.m_units - m_top;
    duct.strength_m_units = std::max({duct.strength_m_units, a, b});
    const double height_m = upper.height_msl_m - lower.height_msl_m;
    if (a < 0) {
      const double part_m = height_m * b / (b - a);
      duct.base_msl_m = upper.height_msl_m - part_m;
      duct.phase_integral_m += pieceOfPhase_m(part_m, 0, b);
      is_elevated = true;
      break;
    }
    duct.phase_integral_m += pieceOfPhase_m(height_m, a, b);
  }
  if (is_elevated) {
    duct.kind = DuctKind::elevated;
  } else if (layer_base > 0) {
    duct.kind = DuctKind::surface_based;
  } else {
    const double tenth_msl_m = duct.base_msl_m + 0.1 * (duct.top_msl_m - duct.base_msl_m);
    const bool falls_early = levels.front().m_units - profile.at(tenth_msl_m) > 0.5 * duct.strength_m_units;
    duct.kind = falls_early ? DuctKind::evaporation : DuctKind::surface;
  }
  return duct;
}

}  // namespace

double Duct::modes(double frequency_hz) const {
  return 2 * phase_integral_m / wavelength_m(frequency_hz) + (kind == DuctKind::elevated ? 0.5 : 0.25);
}

double Duct::oneModeFrequency_hz() const {
  return (kind == DuctKind::elevated ? 0.5 : 0.75) * kSpeedOfLight / (2 * phase_integral_m);
}

double Duct::criticalAngle_deg() const {
  return radToDeg(std::sqrt(2e-6 * strength_m_units));
}

std::vector<Duct> ductsOf(const RefractivityProfile& profile) {
  const std::vector<RefractivityLevel>& levels = profile.levels;
  std::vector<Duct> ducts;
  for (std::size_t base = 0; base + 1 < levels.size();) {
    std::size_t top = base;
    while (top + 1 < levels.size() && levels[top + 1].m_units < levels[top].m_units) ++top;
    if (levels[base].m_units - levels[top].m_units >= kMinStrength_m_units) {
      ducts.push_back(ductBelow(profile, base, top));
    }
    base = std::max(top, base + 1);
  }
  return ducts;
}

std::optional<double> evaporationDuctTop_msl_m(const RefractivityProfile& profile) {
  const std::vector<Duct> ducts = ductsOf(profile);
  if (ducts.empty() || ducts.front().kind != DuctKind::evaporation) return std::nullopt;
  return ducts.front().top_msl_m;
}

RefractivityProfile withoutEvaporationDuct(RefractivityProfile profile) {
  const std::optional<double> top_msl_m = evaporationDuctTop_msl_m(profile);
  if (!top_msl_m) return profile;
  const double top_m_units = profile.at(*top_msl_m);
  for (RefractivityLevel& level : profile.levels) {
    if (level.height_msl_m < *top_msl_m)
      level.m_units = top_m_units - kStandardGradient_m * (*top_msl_m - level.height_msl_m);
  }
  return profile;
}

}  // namespace emscape::propagation
