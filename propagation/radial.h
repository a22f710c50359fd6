/// Inputs of models that march outwards from an emitter, one azimuth at a time ("per radial").
#pragma once

#include <functional>
#include <vector>

#include "emscape/base/units.h"

namespace emscape::propagation {

/// The positions of an emitter's field, and the ground around it.
struct RadialInputs {
  double farthest_m = 0;              ///< along the ground
  double first_azimuth_rad = 0;       ///< clockwise from north
  double azimuth_span_rad = 2 * kPi;  ///< from the first azimuth clockwise; 2 pi: full circle
  double spacing_m = 0;               ///< of the positions along the ground; 0: a single position
  /// Distance of the farthest position in equal arcs of the full circle, clockwise from north; 0: no
  /// position. Empty: farthest_m everywhere.
  std::vector<float> farthest_of_arcs_m;

  /// Datum of the heights: above the ground, or above mean sea level.
  bool above_ground = false;
  double lowest_m = 0, highest_m = 0;
  double height_step_m = 0;  ///< spacing of the heights, > 0
  bool are_level = false;    ///< the positions of a layer have the same height

  bool has_terrain = false;                                  ///< false: a smooth earth at mean sea level
  double site_ground_msl_m = 0;                              ///< at the emitter
  double lowest_ground_msl_m = 0, highest_ground_msl_m = 0;  ///< along the azimuths
  /// Reads the ground (m above mean sea level) at 0, 1, ... count - 1 steps along an azimuth, on a path of
  /// length length_m; the values do not depend on how many are read; NaN where terrain is missing.
  /// Thread-safe. Not called without terrain.
  std::function<void(double azimuth_rad, double length_m, double step_m, int count, float* ground_msl_m)>
      ground;
  /// TerrainProfile::cover_m at the same points. @param ground_msl_m  read by `ground`; empty: no land cover
  std::function<void(double azimuth_rad, double length_m, double step_m, int count, const float* ground_msl_m,
                     float* cover_m)>
      cover;

  bool isAround() const { return azimuth_span_rad >= 2 * kPi; }
};

}  // namespace emscape::propagation
