/// Ducts of a profile of refractivity: layers, strength, and the waves that they trap.
#pragma once

#include <optional>
#include <vector>

#include "propagation/parabolic_equation/refractivity.h"

namespace emscape::propagation {

enum class DuctKind {
  evaporation,    ///< M falls from the surface, most of it in the lowest tenth of the duct
  surface,        ///< M falls from the surface
  surface_based,  ///< M falls in a layer aloft, to less than at the surface
  elevated        ///< M falls in a layer aloft, and the duct does not reach the surface
};
const char* toString(DuctKind kind);

/// A duct reaches from the top of a layer in which M falls down to the height where M is the same, or to the
/// surface.
struct Duct {
  DuctKind kind = DuctKind::surface;
  double base_msl_m = 0, top_msl_m = 0;
  double layer_base_msl_m = 0;  ///< of the layer in which M falls, up to the duct's top
  double strength_m_units = 0;  ///< largest M in the duct, less that at the top
  double phase_integral_m = 0;  ///< integral over the duct of sqrt(2e-6 (M - M at the top))

  /// Number of trapped modes: 2 / lambda times the phase integral, plus 1/4 for a duct on the surface (which
  /// reflects with a change of sign) and 1/2 for an elevated one. A duct traps from 1 on.
  double modes(double frequency_hz) const;
  /// Frequency at which modes() is 1 (Hz).
  double oneModeFrequency_hz() const;
  /// Largest angle from the horizontal of a trapped ray, where M is largest (degrees).
  double criticalAngle_deg() const;
};

/// The ducts, from the lowest top to the highest. The surface is the profile's first level. A layer whose M
/// falls without end has its top at the last level. A layer below 0.1 M-units is none.
std::vector<Duct> ductsOf(const RefractivityProfile& profile);

/// Top (m above mean sea level) of the evaporation duct; none: the lowest duct is of another kind.
std::optional<double> evaporationDuctTop_msl_m(const RefractivityProfile& profile);
/// The profile with standard air below the top of its evaporation duct, if it has one; as many levels.
RefractivityProfile withoutEvaporationDuct(RefractivityProfile profile);

}  // namespace emscape::propagation
