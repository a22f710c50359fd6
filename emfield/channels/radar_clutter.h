/// Converts a scenario's clutter to the inputs of the loops over voxels.
#pragma once

#include <optional>

#include "emfield/clutter/mti.h"
#include "emfield/combine/clutter_echo.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// Integral over a cut of the pattern's two-way power, 1 at its maximum: the widths of the beam for clutter.
/// Gaussian beams: 0.753 of the half-power width, (pi / (8 ln 2))^(1/2), as in J. R. Probert-Jones, Q. J. R.
/// Meteorol. Soc. 88 (1962), p. 485.
struct ClutterBeam {
  double azimuth_rad = 0;  ///< at the elevation of the maximum; 2 pi for an isotropic antenna
  double elevation_rad =
      0;             ///< at azimuth 0, weighted by the cosine of the elevation; 2 for an isotropic antenna
  PowerBelow below;  ///< of the same cut
};
ClutterBeam clutterBeam(const scenario::Antenna& antenna);

/// The filter of a radar with clutter; empty if it has none.
std::optional<MtiFilter> mtiFilterOf(const scenario::Emitter& radar);

/// Ratio of the echo's power over noise after the radar's filter to that before it; 1 without a filter.
double filterResponse(const scenario::Emitter& radar);

/// Improvement of echo over clutter by the radar's filter: 1 without one.
double surfaceImprovement(const scenario::Emitter& radar);
double rainImprovement(const scenario::Emitter& radar);

/// Clutter of a radar after its filter, without the values that depend on its site.
ClutterTask clutterTask(const scenario::Scenario& scenario, const scenario::Emitter& radar);
/// The same with the values for its site.
ClutterTask placedAt(const scenario::EmitterState& state, const scenario::Scenario& scenario,
                     ClutterTask task);

}  // namespace emscape::emfield
