#include "base/geodesy/fast_geodesy.h"

#include <GeographicLib/Math.hpp>

namespace emscape {

SurfacePoint surfacePoint(double latitude_deg, double longitude_deg) {
  double sin_latitude, cos_latitude, sin_longitude, cos_longitude;
  GeographicLib::Math::sincosd(latitude_deg, sin_latitude, cos_latitude);
  GeographicLib::Math::sincosd(longitude_deg, sin_longitude, cos_longitude);
  SurfacePoint point;
  point.up = {cos_latitude * cos_longitude, cos_latitude * sin_longitude, sin_latitude};
  const double prime_radius_m =
      kWgs84SemiMajor_m / std::sqrt(1.0 - kWgs84EccentricitySquared * sin_latitude * sin_latitude);
  point.ecef_m = point.up * prime_radius_m;
  point.ecef_m.z *= 1.0 - kWgs84EccentricitySquared;
  return point;
}

FastGeodesy fastGeodesy(double latitude_deg, double longitude_deg) {
  double sin_latitude, cos_latitude, sin_longitude, cos_longitude;
  GeographicLib::Math::sincosd(latitude_deg, sin_latitude, cos_latitude);
  GeographicLib::Math::sincosd(longitude_deg, sin_longitude, cos_longitude);
  FastGeodesy geodesy;
  geodesy.station = surfacePoint(latitude_deg, longitude_deg);
  geodesy.latitude_rad = degToRad(latitude_deg);
  geodesy.longitude_rad = degToRad(wrapLongitude_deg(longitude_deg));
  geodesy.east = {-sin_longitude, cos_longitude, 0.0};
  geodesy.north = {-sin_latitude * cos_longitude, -sin_latitude * sin_longitude, cos_latitude};
  const double w = 1.0 - kWgs84EccentricitySquared * sin_latitude * sin_latitude;
  geodesy.prime_radius_m = kWgs84SemiMajor_m / std::sqrt(w);
  geodesy.meridian_radius_m = geodesy.prime_radius_m * (1.0 - kWgs84EccentricitySquared) / w;
  return geodesy;
}

}  // namespace emscape
