/// Inputs of models that march outwards from an emitter, one azimuth at a time ("per radial").
#pragma once

#include <functional>
#include <vector>

#include "emscape/base/units.h"

namespace emscape::propagation {

/// Where the field of an emitter is wanted, and the ground around it.
struct RadialInputs {
  double farthest_m = 0;              ///< along the ground
  double first_azimuth_rad = 0;       ///< clockwise from north
  double azimuth_span_rad = 2 * kPi;  ///< from the first azimuth clockwise; 2 pi: all around
  double spacing_m = 0;               ///< of the places along the ground; 0: one place
  /// Distance of the farthest place in equal arcs from north clockwise, all around; 0: there is none. Empty:
  /// farthest_m everywhere.
  std::vector<float> farthest_of_arcs_m;

  /// Heights of the places: above mean sea level, or above the ground.
  bool above_ground = false;
  double lowest_m = 0, highest_m = 0;
  double height_step_m = 0;  ///< between them, > 0
  bool are_level = false;    ///< the places of a layer have the same height

  bool has_terrain = false;                                  ///< false: a smooth earth at mean sea level
  double site_ground_msl_m = 0;                              ///< at the emitter
  double lowest_ground_msl_m = 0, highest_ground_msl_m = 0;  ///< along the azimuths
  /// Reads the ground (m above mean sea level) at 0, 1, ... count - 1 steps along an azimuth, on a path of at
  /// least that length, whose ground is the same however much of it is read; NaN where it is missing. For
  /// several threads at once. Not called without terrain.
  std::function<void(double azimuth_rad, double length_m, double step_m, int count, float* ground_msl_m)>
      ground;

  bool isAround() const { return azimuth_span_rad >= 2 * kPi; }
};

}  // namespace emscape::propagation
