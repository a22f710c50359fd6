/// Distance, bearing and line of sight between two points.
#pragma once

#include <string>

#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::view {

struct Measurement {
  emfield::PathEnd from, to;
  double distance_m = 0;  ///< along the ground
  double slant_m = 0;     ///< along the straight line
  double bearing_deg = 0, back_bearing_deg = 0;
  /// The profile with the first Fresnel zone, and its obstacles; has no terms. Without samples if the points
  /// are less than 1 m apart.
  emfield::PathBudget path;
  bool is_blocked = false;
};

/// One sentence about the line of sight.
std::string verdictOf(const Measurement& measurement, Units units);

/// @param atmosphere    refraction of the ray
/// @param frequency_hz  of the Fresnel zone
/// @param terrain       null: a smooth earth at mean sea level
/// @throws Error (bad_input) over missing terrain
Measurement measure(const emfield::PathEnd& from, const emfield::PathEnd& to,
                    const propagation::Atmosphere& atmosphere, double frequency_hz,
                    const scenario::Terrain* terrain);

}  // namespace emscape::view
