/// Ducts of a refractivity profile: layers, strength and trapped waves.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "emscape/base/enum_names.h"
#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {

using emscape::toString;

enum class DuctKind {
  evaporation,    ///< M decreases from the surface, mostly in the lowest tenth of the duct
  surface,        ///< M decreases from the surface
  surface_based,  ///< M decreases in a layer aloft, to less than at the surface
  elevated        ///< M decreases in a layer aloft, and the duct does not reach the surface
};
constexpr auto namesOf(DuctKind) {
  return std::array{"evaporation", "surface", "surface-based", "elevated"};
}

/// A duct extends from the top of a layer in which M decreases down to the height with the same M, or to the
/// surface.
struct Duct {
  DuctKind kind = DuctKind::surface;
  double base_msl_m = 0, top_msl_m = 0;
  double layer_base_msl_m = 0;  ///< of the layer in which M decreases, up to the duct's top
  double strength_m_units = 0;  ///< max M in the duct minus M at the top
  double phase_integral_m = 0;  ///< integral over the duct of sqrt(2e-6 (M - M at the top))

  /// Number of trapped modes: 2 / lambda times the phase integral, plus 1/4 for a duct at the surface (which
  /// reflects with a change of sign) and 1/2 for an elevated one. A duct traps if it is at least 1.
  double modes(double frequency_hz) const;
  /// Frequency at which modes() is 1 (Hz).
  double oneModeFrequency_hz() const;
  /// Max angle of a trapped ray from the horizontal, where M is largest (degrees).
  double criticalAngle_deg() const;
};

/// Ducts in ascending order of their tops. The surface is the profile's first level. If M decreases up to the
/// last level, that is the layer's top. Layers weaker than 0.1 M-units are ignored.
std::vector<Duct> ductsOf(const RefractivityProfile& profile);

/// Top (m above mean sea level) of the evaporation duct; none: the lowest duct is of another kind.
std::optional<double> evaporationDuctTop_msl_m(const RefractivityProfile& profile);
/// The profile with standard air below the top of its evaporation duct, if any; the number of levels is kept.
RefractivityProfile withoutEvaporationDuct(RefractivityProfile profile);

}  // namespace emscape::propagation
