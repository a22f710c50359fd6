/// Orientation of entities: Euler angles of DIS from earth-centred axes, and heading, pitch and roll.
#pragma once

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/vec.h"

namespace emscape::interop::dis {

/// Axes of a body as unit vectors in ECEF: x forward, y to the right, z downwards.
struct BodyAxes {
  Vec3d x, y, z;

  /// A vector of the body in ECEF.
  Vec3d toWorld(const Vec3d& body) const { return x * body.x + y * body.y + z * body.z; }
  Vec3d toBody(const Vec3d& world) const { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

/// @param euler_rad  psi, theta, phi: turns about z, the new y and the new x, from ECEF axes
BodyAxes axesOf(const Vec3d& euler_rad);
/// psi, theta, phi (rad).
Vec3d eulerOf(const BodyAxes& axes);

/// Degrees; heading clockwise from true north, 0..360.
struct LocalAttitude {
  double heading_deg = 0, pitch_deg = 0, roll_deg = 0;
};
LocalAttitude attitudeOf(const BodyAxes& axes, double latitude_deg, double longitude_deg);
BodyAxes axesOf(const LocalAttitude& attitude, double latitude_deg, double longitude_deg);

}  // namespace emscape::interop::dis
