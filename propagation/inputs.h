/// Inputs of a propagation model: the emitter, its site, and the extent of its paths.
#pragma once

#include <functional>
#include <vector>

#include "emscape/propagation/settings.h"

namespace emscape::propagation {

/// An emitter's wave and model settings, the ground and the atmosphere.
struct EmitterInputs {
  double frequency_hz = 0;
  Polarization polarization = Polarization::vertical;
  ModelSettings settings;
  Ground ground;
  Atmosphere atmosphere;
};

/// The emitter's site.
struct Site {
  double latitude_deg = 0, longitude_deg = 0;
  double height_msl_m = 0;
  double earth_radius_m = 0;            ///< Gaussian radius of curvature below it
  double effective_earth_radius_m = 0;  ///< k times that
  double effective_height_msl_m = 0;    ///< on the effective earth; for ModelInfo::on_effective_earth
};

/// Extent of the paths from an emitter.
struct PathExtent {
  double farthest_m = 0;  ///< along the ground
  double lowest_msl_m = 0, highest_msl_m = 0;
};

/// Amplitude of an antenna (relative voltage, with the field's sign) against the angle above the horizontal
/// (rad), in the vertical plane of its beam; empty: the model does not use it, or the antenna is isotropic.
using ElevationPattern = std::function<double(double elevation_rad)>;

/// All common inputs of the paths from an emitter.
struct PathInputs {
  EmitterInputs emitter;
  Site site;
  /// Height of the smooth surface; set for models with ModelInfo::on_smooth_surface.
  double surface_msl_m = 0;
  /// Set for models with ModelInfo::needs_extent, and if there is atmospheric attenuation.
  PathExtent extent;
  double post_spacing_m = 0;  ///< of terrain profiles far from the emitter
  ElevationPattern elevation_pattern;
};

/// Positions with the same heights above a base at each: the paths to the points of a surface.
struct PathPoints {
  std::vector<double> range_m;      ///< to each position along the ground; NaN: left out
  std::vector<double> base_msl_m;   ///< of each position
  std::vector<float> above_base_m;  ///< heights
};

/// True if the polarisation is horizontal or vertical.
inline bool isLinear(Polarization polarization) {
  return polarization == Polarization::horizontal || polarization == Polarization::vertical;
}

}  // namespace emscape::propagation
