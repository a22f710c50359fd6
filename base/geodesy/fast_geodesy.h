/// Geodesy of the inner loops: ECEF chords and the local radius of curvature, plain data for host and device.
#pragma once

#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/base/vec.h"

namespace emscape {

/// WGS84: semi-major axis (m, defined) and first eccentricity squared, f (2 - f) with 1/f = 298.257223563
/// (defined).
constexpr double kWgs84SemiMajor_m = 6378137.0;
constexpr double kWgs84EccentricitySquared = (2.0 - 1.0 / 298.257223563) / 298.257223563;

/// A point of the ellipsoid (height 0), with the vectors for the loops.
struct SurfacePoint {
  Vec3d ecef_m;  ///< foot on the ellipsoid
  Vec3d up;      ///< outward unit normal
};

/// Distances and azimuths from one station, and points at a distance along an azimuth. Great ellipses and
/// geodesics are approximated by circles with the ellipsoid's radius of curvature at the station along the
/// azimuth.
/// @accuracy largest difference from GeographicLib over the whole earth, poles and antimeridian included,
/// both ways:
///   to 100 km:  distance 3e-9 of itself, azimuth 8e-6 degree, position 0.014 m
///   to 500 km:  distance 2.4e-7 of itself, azimuth 2.0e-4 degree, position 1.8 m
///   to 2000 km: distance 1.4e-5 of itself, azimuth 3.3e-3 degree, position 111 m
///   (below 100 m the rounding of coordinates of 6e6 m remains: 1e-8 m)
struct FastGeodesy {
  SurfacePoint station;
  Vec3d east;  ///< unit vectors at the station
  Vec3d north;
  double latitude_rad = 0;  ///< the station's; its longitude within -pi..pi
  double longitude_rad = 0;
  double meridian_radius_m = 0;  ///< M at the station
  double prime_radius_m = 0;     ///< N at the station

  /// Radius of curvature of the normal section at an azimuth (Euler), m.
  EMSCAPE_HD double radius_m(double sin_azimuth, double cos_azimuth) const {
    return 1.0 / (cos_azimuth * cos_azimuth / meridian_radius_m + sin_azimuth * sin_azimuth / prime_radius_m);
  }
};

/// Point of the ellipsoid (ECEF, m) at a latitude and longitude.
/// @accuracy within 4e-9 m of toEcef()
EMSCAPE_HD inline Vec3d ellipsoidPoint_m(double latitude_rad, double longitude_rad) {
  const double sine = std::sin(latitude_rad), cosine = std::cos(latitude_rad);
  const double prime_radius_m = kWgs84SemiMajor_m / std::sqrt(1.0 - kWgs84EccentricitySquared * sine * sine);
  return {prime_radius_m * cosine * std::cos(longitude_rad),
          prime_radius_m * cosine * std::sin(longitude_rad),
          prime_radius_m * (1.0 - kWgs84EccentricitySquared) * sine};
}

/// @param latitude_deg  -90..90, longitude_deg any
SurfacePoint surfacePoint(double latitude_deg, double longitude_deg);
FastGeodesy fastGeodesy(double latitude_deg, double longitude_deg);

/// Ground distance and azimuth from the station to a point of the ellipsoid.
struct FastInverse {
  double distance_m = 0;
  double sin_azimuth = 0;  ///< azimuth 0 at the station itself
  double cos_azimuth = 1;
};
EMSCAPE_HD inline FastInverse fastInverse(const FastGeodesy& geodesy, const Vec3d& foot_ecef_m);

/// Latitude and longitude (rad; longitude within -pi..pi) at a distance (m) along an azimuth.
struct FastDirect {
  double latitude_rad = 0;
  double longitude_rad = 0;
};
EMSCAPE_HD inline FastDirect fastDirect(const FastGeodesy& geodesy, double sin_azimuth, double cos_azimuth,
                                        double distance_m);

}  // namespace emscape

#include "base/geodesy/fast_geodesy_impl.h"
