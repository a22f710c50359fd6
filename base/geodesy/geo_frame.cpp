#include "emscape/base/geodesy/geo_frame.h"

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"

namespace emscape {
namespace {

/// Rejects an origin that is not a position on the earth, before anything is computed from it.
const FrameOrigin& checked(const FrameOrigin& origin) {
  if (!(std::abs(origin.latitude_deg) <= 90.0)) {
    throw Error(ErrorCode::bad_input, "frame origin: latitude_deg " + std::to_string(origin.latitude_deg) +
                                          " is outside -90..90 degrees");
  }
  if (!std::isfinite(origin.longitude_deg) || !std::isfinite(origin.height_msl_m)) {
    throw Error(ErrorCode::bad_input, "frame origin: longitude_deg and height_msl_m must be finite numbers");
  }
  return origin;
}

}  // namespace

struct GeoFrame::Impl {
  explicit Impl(const FrameOrigin& frame_origin)
      : origin(checked(frame_origin)),
        enu(origin.latitude_deg, origin.longitude_deg,
            origin.height_msl_m + geoidUndulation_m(origin.latitude_deg, origin.longitude_deg)) {}

  FrameOrigin origin;
  GeographicLib::LocalCartesian enu;
  GeographicLib::AzimuthalEquidistant plane;
};

GeoFrame::GeoFrame(const FrameOrigin& origin) : impl_(std::make_shared<const Impl>(origin)) {}
GeoFrame::~GeoFrame() = default;
GeoFrame::GeoFrame(const GeoFrame&) = default;
GeoFrame& GeoFrame::operator=(const GeoFrame&) = default;

const FrameOrigin& GeoFrame::origin() const {
  return impl_->origin;
}

Vec3d GeoFrame::toLocal(const GeodeticPosition& position) const {
  Vec3d local;
  if (impl_->origin.kind == FrameKind::enu) {
    impl_->enu.Forward(position.latitude_deg, position.longitude_deg, position.height_ellipsoid_m, local.x,
                       local.y, local.z);
  } else {
    impl_->plane.Forward(impl_->origin.latitude_deg, impl_->origin.longitude_deg, position.latitude_deg,
                         position.longitude_deg, local.x, local.y);
    local.z = position.height_ellipsoid_m - geoidUndulation_m(position.latitude_deg, position.longitude_deg);
  }
  return local;
}

GeodeticPosition GeoFrame::toGeodetic(const Vec3d& local_m) const {
  GeodeticPosition position;
  if (impl_->origin.kind == FrameKind::enu) {
    impl_->enu.Reverse(local_m.x, local_m.y, local_m.z, position.latitude_deg, position.longitude_deg,
                       position.height_ellipsoid_m);
  } else {
    impl_->plane.Reverse(impl_->origin.latitude_deg, impl_->origin.longitude_deg, local_m.x, local_m.y,
                         position.latitude_deg, position.longitude_deg);
    position.height_ellipsoid_m =
        local_m.z + geoidUndulation_m(position.latitude_deg, position.longitude_deg);
  }
  return position;
}

double GeoFrame::heightMsl_m(const Vec3d& local_m) const {
  if (impl_->origin.kind == FrameKind::altitude) return local_m.z;
  const GeodeticPosition position = toGeodetic(local_m);
  return position.height_ellipsoid_m - geoidUndulation_m(position.latitude_deg, position.longitude_deg);
}

Vec3d toEcef(const GeodeticPosition& position) {
  Vec3d ecef;
  GeographicLib::Geocentric::WGS84().Forward(position.latitude_deg, position.longitude_deg,
                                             position.height_ellipsoid_m, ecef.x, ecef.y, ecef.z);
  return ecef;
}

GeodeticPosition fromEcef(const Vec3d& ecef_m) {
  GeodeticPosition position;
  GeographicLib::Geocentric::WGS84().Reverse(ecef_m.x, ecef_m.y, ecef_m.z, position.latitude_deg,
                                             position.longitude_deg, position.height_ellipsoid_m);
  return position;
}

GeodesicInverse geodesicInverse(double latitude1_deg, double longitude1_deg, double latitude2_deg,
                                double longitude2_deg) {
  GeodesicInverse result;
  double azimuth1_deg = 0, azimuth2_deg = 0;
  GeographicLib::Geodesic::WGS84().Inverse(latitude1_deg, longitude1_deg, latitude2_deg, longitude2_deg,
                                           result.distance_m, azimuth1_deg, azimuth2_deg);
  result.azimuth_rad = degToRad(azimuth1_deg < 0.0 ? azimuth1_deg + 360.0 : azimuth1_deg);
  return result;
}

GeodeticPosition geodesicDirect(double latitude_deg, double longitude_deg, double azimuth_rad,
                                double distance_m) {
  GeodeticPosition position;
  GeographicLib::Geodesic::WGS84().Direct(latitude_deg, longitude_deg, radToDeg(azimuth_rad), distance_m,
                                          position.latitude_deg, position.longitude_deg);
  return position;
}

double wrapLongitude_deg(double longitude_deg) {
  if (std::abs(longitude_deg) < 180) return longitude_deg;
  return std::remainder(longitude_deg, 360.0);
}

}  // namespace emscape
