/// An emitter's site, with the derived quantities for the geometry of its paths.
#pragma once

#include "base/geodesy/fast_geodesy.h"
#include "emfield/columns/refraction.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/host_device.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// Ground distance (m) from a station below which there is no path.
constexpr double kMinPath_m = 1;

/// Immutable once made.
struct Station : propagation::Site {
  FastGeodesy geodesy;
  Vec3d ecef_m;
  Refraction refraction;
};

/// For refractivity that is linear in height.
Station makeStation(const GeodeticPosition& position, double height_msl_m, double k_factor);
/// For the refractivity of the atmosphere.
Station makeStation(const GeodeticPosition& position, double height_msl_m,
                    const propagation::Atmosphere& atmosphere);

/// The straight line (m) from a station to a point, east-north-up.
Vec3d lineTo(const Station& from, const GeodeticPosition& to);

/// Correction of the rise (m) of the straight line to a point, so that it starts along the refracted ray.
/// @param range_m       along the ground
/// @param level_m       distance of the point in the station's horizontal plane
/// @param height_msl_m  of the point
/// @accuracy launch angle within 0.003 degree in an exponential atmosphere
EMSCAPE_HD inline double refractionLift_m(const Station& station, double range_m, double level_m,
                                          double height_msl_m) {
  if (station.refraction.exponential) {
    return range_m * level_m * station.refraction.bending(station.height_msl_m, height_msl_m, range_m);
  }
  return range_m * level_m * (1 / station.earth_radius_m - 1 / station.effective_earth_radius_m) / 2;
}

}  // namespace emscape::emfield
