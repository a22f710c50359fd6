/// What a propagation model is told of an emitter, of where it stands and of where its paths end.
#pragma once

#include "emscape/propagation/settings.h"

namespace emscape::propagation {

/// An emitter's wave and settings, and what the wave meets.
struct EmitterInputs {
  double frequency_hz = 0;
  Polarization polarization = Polarization::vertical;
  ModelSettings settings;
  Ground ground;
  Atmosphere atmosphere;
};

/// Where the emitter stands.
struct Site {
  double latitude_deg = 0;
  double height_msl_m = 0;
  double earth_radius_m = 0;            ///< Gaussian radius of curvature below it
  double effective_earth_radius_m = 0;  ///< k times that
};

/// Where the paths from an emitter may end.
struct PathExtent {
  double farthest_m = 0;  ///< along the ground
  double lowest_msl_m = 0, highest_msl_m = 0;
};

/// All that the paths from an emitter have in common.
struct PathInputs {
  EmitterInputs emitter;
  Site site;
  /// Height of the smooth surface; set for models with ModelInfo::on_smooth_surface.
  double surface_msl_m = 0;
  /// Set for models with ModelInfo::needs_extent, and where the air takes its part.
  PathExtent extent;
  double post_spacing_m = 0;  ///< of terrain profiles far from the emitter
};

/// Whether the electric field keeps one plane, horizontal or vertical.
inline bool isLinear(Polarization polarization) {
  return polarization == Polarization::horizontal || polarization == Polarization::vertical;
}

}  // namespace emscape::propagation
