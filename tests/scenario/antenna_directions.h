/// Directions for antenna tests, and the gain towards them.
#pragma once

#include <cmath>

#include "emscape/base/units.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/antenna/antenna.h"

namespace emscape::scenario {

/// Unit vector (forward, right, up) towards an azimuth (clockwise) and an elevation (upwards).
inline Vec3d towards(double azimuth_deg, double elevation_deg) {
  const double azimuth = degToRad(azimuth_deg), elevation = degToRad(elevation_deg);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Gain (dBi) towards a direction (forward, right, up; unit), in double; -infinity in a null.
/// @param steer_azimuth_rad, steer_elevation_rad  phased_array: steering direction of the beam; else ignored
inline double gainTowards_dbi(const Antenna& antenna, const Vec3d& direction, double steer_azimuth_rad = 0,
                              double steer_elevation_rad = 0) {
  const double steer_u = std::cos(steer_elevation_rad) * std::sin(steer_azimuth_rad);
  const double steer_v = std::sin(steer_elevation_rad);
  return antenna.gain_dbi + 2 * ratioToDb(antenna.amplitudeTowards(direction, steer_u, steer_v));
}

}  // namespace emscape::scenario
