#include "recording/dis/orientation.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"

namespace emscape::interop::dis {
namespace {

/// North, east and down in ECEF.
BodyAxes localAxes(double latitude_deg, double longitude_deg) {
  const double lat = degToRad(latitude_deg), lon = degToRad(longitude_deg);
  const double sin_lat = std::sin(lat), cos_lat = std::cos(lat), sin_lon = std::sin(lon),
               cos_lon = std::cos(lon);
  return {{-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
          {-sin_lon, cos_lon, 0},
          {-cos_lat * cos_lon, -cos_lat * sin_lon, -sin_lat}};
}

double asinClamped(double sine) {
  return std::asin(std::clamp(sine, -1.0, 1.0));
}

}  // namespace

BodyAxes axesOf(const Vec3d& euler_rad) {
  const double sin_psi = std::sin(euler_rad.x), cos_psi = std::cos(euler_rad.x);
  const double sin_theta = std::sin(euler_rad.y), cos_theta = std::cos(euler_rad.y);
  const double sin_phi = std::sin(euler_rad.z), cos_phi = std::cos(euler_rad.z);
  return {{cos_theta * cos_psi, cos_theta * sin_psi, -sin_theta},
          {sin_phi * sin_theta * cos_psi - cos_phi * sin_psi,
           sin_phi * sin_theta * sin_psi + cos_phi * cos_psi, sin_phi * cos_theta},
          {cos_phi * sin_theta * cos_psi + sin_phi * sin_psi,
           cos_phi * sin_theta * sin_psi - sin_phi * cos_psi, cos_phi * cos_theta}};
}

Vec3d eulerOf(const BodyAxes& axes) {
  return {std::atan2(axes.x.y, axes.x.x), asinClamped(-axes.x.z), std::atan2(axes.y.z, axes.z.z)};
}

LocalAttitude attitudeOf(const BodyAxes& axes, double latitude_deg, double longitude_deg) {
  const BodyAxes local = localAxes(latitude_deg, longitude_deg);
  const Vec3d x = local.toBody(axes.x);  // in north, east and down
  const double heading_deg = radToDeg(std::atan2(x.y, x.x));
  return {heading_deg < 0 ? heading_deg + 360 : heading_deg, radToDeg(asinClamped(-x.z)),
          radToDeg(std::atan2(dot(axes.y, local.z), dot(axes.z, local.z)))};
}

BodyAxes axesOf(const LocalAttitude& attitude, double latitude_deg, double longitude_deg) {
  const BodyAxes local = localAxes(latitude_deg, longitude_deg);
  // The same turns as those of the Euler angles, from north, east and down.
  const BodyAxes turned = axesOf(
      Vec3d{degToRad(attitude.heading_deg), degToRad(attitude.pitch_deg), degToRad(attitude.roll_deg)});
  return {local.toWorld(turned.x), local.toWorld(turned.y), local.toWorld(turned.z)};
}

}  // namespace emscape::interop::dis
