/// An emitter's position, with the derived quantities that the geometry needs.
#pragma once

#include "base/fast_geodesy.h"
#include "emscape/base/geo_frame.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

/// Immutable once made.
struct Station {
  FastGeodesy geodesy;
  Vec3d ecef_m;
  double height_msl_m = 0;
  double earth_radius_m = 0;            ///< Gaussian radius of curvature below the station
  double effective_earth_radius_m = 0;  ///< k times that
};

inline Station makeStation(const GeodeticPosition& position, double height_msl_m, double k_factor) {
  Station station;
  station.geodesy = fastGeodesy(position.latitude_deg, position.longitude_deg);
  station.ecef_m = toEcef(position);
  station.height_msl_m = height_msl_m;
  station.earth_radius_m = std::sqrt(station.geodesy.meridian_radius_m * station.geodesy.prime_radius_m);
  station.effective_earth_radius_m = k_factor * station.earth_radius_m;
  return station;
}

/// Correction of the rise (m) of the straight line to a point, so that it starts along the refracted ray.
/// @param range_m  over the ground
/// @param level_m  distance of the point in the station's horizontal plane
EMSCAPE_HD inline double refractionLift_m(const Station& station, double range_m, double level_m) {
  return range_m * level_m * (1 / station.earth_radius_m - 1 / station.effective_earth_radius_m) / 2;
}

}  // namespace emscape::emfield
