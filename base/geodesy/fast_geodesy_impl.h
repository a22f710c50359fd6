/// Definitions of fast_geodesy.h's inline functions; included by it alone.
#pragma once

namespace emscape {
namespace fast_geodesy_detail {

/// Angle of the point (x, y), as std::atan2; by a series (1.5e-11 of itself) where it is small.
EMSCAPE_HD inline double angleOf(double y, double x) {
  if (!(std::abs(y) <= 0.25 * x)) return std::atan2(y, x);
  const double r = y / x;
  const double q = r * r;
  return r * (1 - q * (1. / 3 -
                       q * (1. / 5 -
                            q * (1. / 7 - q * (1. / 9 - q * (1. / 11 - q * (1. / 13 - q * (1. / 15))))))));
}

/// sin(arc) and 1 - cos(arc); by series (1e-12 of themselves) up to 0.35 rad, 2200 km on the earth.
struct ArcParts {
  double sine, versine;
};
EMSCAPE_HD inline ArcParts partsOf(double arc) {
  if (!(std::abs(arc) <= 0.35)) {
    const double half_sine = std::sin(0.5 * arc);
    return {std::sin(arc), 2.0 * half_sine * half_sine};
  }
  const double q = arc * arc;
  return {arc * (1 - q * (1. / 6) * (1 - q * (1. / 20) * (1 - q * (1. / 42) * (1 - q * (1. / 72))))),
          0.5 * q * (1 - q * (1. / 12) * (1 - q * (1. / 30) * (1 - q * (1. / 56) * (1 - q * (1. / 90)))))};
}

}  // namespace fast_geodesy_detail

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
  const fast_geodesy_detail::ArcParts arc = fast_geodesy_detail::partsOf(distance_m / radius_m);
  const double east_m = radius_m * arc.sine * sin_azimuth;
  const double north_m = radius_m * arc.sine * cos_azimuth;
  const double up_m = -radius_m * arc.versine;

  // The point in the station's meridian plane (axis distance and height over the equator) and east of it.
  const double sin_latitude = geodesy.station.up.z;
  const double cos_latitude = geodesy.north.z;
  const double polar_factor = 1.0 - kWgs84EccentricitySquared;
  const double axial_m = (geodesy.prime_radius_m + up_m) * cos_latitude - north_m * sin_latitude;
  const double polar_m =
      (geodesy.prime_radius_m * polar_factor + up_m) * sin_latitude + north_m * cos_latitude;

  // The circle leaves the ellipsoid by metres only, where tan(latitude) is the foot's to 1e-8. Differences
  // from the station, not the angles themselves, so that short distances keep their digits.
  const double flattened_m = polar_factor * std::sqrt(axial_m * axial_m + east_m * east_m);
  FastDirect result;
  result.latitude_rad = geodesy.latitude_rad +
                        fast_geodesy_detail::angleOf(polar_m * cos_latitude - flattened_m * sin_latitude,
                                                     flattened_m * cos_latitude + polar_m * sin_latitude);
  result.longitude_rad = geodesy.longitude_rad + fast_geodesy_detail::angleOf(east_m, axial_m);
  if (result.longitude_rad > kPi) result.longitude_rad -= 2.0 * kPi;
  if (result.longitude_rad < -kPi) result.longitude_rad += 2.0 * kPi;
  return result;
}

}  // namespace emscape
