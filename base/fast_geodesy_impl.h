/// Definitions of fast_geodesy.h's inline functions; included by it alone.
#pragma once

namespace emscape {

EMSCAPE_HD inline FastInverse fastInverse(const FastGeodesy& geodesy, const Vec3d& foot_ecef_m) {
  const Vec3d chord = foot_ecef_m - geodesy.station.ecef_m;
  const double east_m = dot(chord, geodesy.east);
  const double north_m = dot(chord, geodesy.north);
  const double tangent_m = std::sqrt(east_m * east_m + north_m * north_m);
  FastInverse result;
  if (tangent_m == 0.0) return result;
  result.sin_azimuth = east_m / tangent_m;
  result.cos_azimuth = north_m / tangent_m;
  const double radius_m = geodesy.radius_m(result.sin_azimuth, result.cos_azimuth);
  const double half_chord = 0.5 * length(chord) / radius_m;
  result.distance_m = 2.0 * radius_m * std::asin(half_chord < 1.0 ? half_chord : 1.0);
  return result;
}

EMSCAPE_HD inline FastDirect fastDirect(const FastGeodesy& geodesy, double sin_azimuth, double cos_azimuth,
                                        double distance_m) {
  const double radius_m = geodesy.radius_m(sin_azimuth, cos_azimuth);
  const double arc = distance_m / radius_m;
  const double along_m = radius_m * std::sin(arc);
  const double half_sine = std::sin(0.5 * arc);
  const double drop_m = 2.0 * radius_m * half_sine * half_sine;
  const Vec3d point = geodesy.station.ecef_m + geodesy.east * (along_m * sin_azimuth) +
                      geodesy.north * (along_m * cos_azimuth) - geodesy.station.up * drop_m;
  // The circle leaves the ellipsoid by metres only, where the latitude is that of the foot to 1e-8 rad.
  const double axis_distance_m = std::sqrt(point.x * point.x + point.y * point.y);
  return {std::atan2(point.z, (1.0 - kWgs84EccentricitySquared) * axis_distance_m),
          std::atan2(point.y, point.x)};
}

}  // namespace emscape
