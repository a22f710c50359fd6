/// Directions for antenna tests.
#pragma once

#include <cmath>

#include "emscape/base/units.h"
#include "emscape/base/vec.h"

namespace emscape::scenario {

/// Unit vector (forward, right, up) towards an azimuth (clockwise) and an elevation (upwards).
inline Vec3d towards(double azimuth_deg, double elevation_deg) {
  const double azimuth = degToRad(azimuth_deg), elevation = degToRad(elevation_deg);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

}  // namespace emscape::scenario
