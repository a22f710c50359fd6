/// Geodetic positions (WGS84) and the local frames of volumes, computed exactly by GeographicLib.
/// fast_geodesy.h has the approximation that is used per voxel.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "emscape/base/enum_names.h"
#include "emscape/base/vec.h"

namespace emscape {

/// A position on WGS84. The datum of the height is the ellipsoid.
struct GeodeticPosition {
  double latitude_deg = 0;   ///< -90..90
  double longitude_deg = 0;  ///< -180..180
  double height_ellipsoid_m = 0;
};

/// altitude: x east, y north in the azimuthal equidistant projection about the origin, z = height above mean
/// sea level. enu: Cartesian, tangent to the ellipsoid's normal at the origin: x east, y north, z up from the
/// origin's height.
enum class FrameKind { altitude, enu };
constexpr auto namesOf(FrameKind) {
  return std::array{"altitude", "enu"};
}

/// Definition of a frame, as in the metadata of files.
struct FrameOrigin {
  FrameKind kind = FrameKind::altitude;
  double latitude_deg = 0;
  double longitude_deg = 0;
  /// enu: the origin's height. altitude: the lowest height of the region; z is measured from mean sea level.
  double height_msl_m = 0;
};

/// The frame as WKT 2 (ISO 19162:2019), with x, y, z as its axes. altitude: the azimuthal equidistant
/// projection with heights above EGM96 (EPSG:5773). enu: a topocentric system derived from WGS84 (EPSG's
/// method 9837).
/// @throws Error (bad_input) for an origin that is not on the earth
std::string wktOf(const FrameOrigin& frame);

/// Converts between a local frame and WGS84. Immutable; safe to share between threads.
class GeoFrame {
 public:
  explicit GeoFrame(const FrameOrigin& origin);
  ~GeoFrame();
  GeoFrame(const GeoFrame&);
  GeoFrame& operator=(const GeoFrame&);

  const FrameOrigin& origin() const;
  /// Local position (m) of a geodetic position.
  Vec3d toLocal(const GeodeticPosition& position) const;
  /// Geodetic position of a local position (m).
  GeodeticPosition toGeodetic(const Vec3d& local_m) const;
  /// Height above mean sea level of a local position (m).
  double heightMsl_m(const Vec3d& local_m) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Earth-centred, earth-fixed coordinates (m), WGS84.
Vec3d toEcef(const GeodeticPosition& position);
GeodeticPosition fromEcef(const Vec3d& ecef_m);

/// Length (m) and initial azimuth (rad, clockwise from north, 0..2 pi) of the geodesic between two points.
struct GeodesicInverse {
  double distance_m = 0;
  double azimuth_rad = 0;
};
GeodesicInverse geodesicInverse(double latitude1_deg, double longitude1_deg, double latitude2_deg,
                                double longitude2_deg);
/// The point at a distance along a geodesic; its height is 0.
GeodeticPosition geodesicDirect(double latitude_deg, double longitude_deg, double azimuth_rad,
                                double distance_m);

/// Longitude wrapped to -180..180 (deg).
double wrapLongitude_deg(double longitude_deg);

}  // namespace emscape
