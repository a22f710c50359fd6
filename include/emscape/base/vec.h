/// Small fixed-size vectors, plain data for host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape {

template <class Real>
struct Vec3 {
  Real x = 0, y = 0, z = 0;

  EMSCAPE_HD Vec3 operator+(const Vec3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  EMSCAPE_HD Vec3 operator-(const Vec3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  EMSCAPE_HD Vec3 operator-() const { return {-x, -y, -z}; }
  EMSCAPE_HD Vec3 operator*(Real s) const { return {x * s, y * s, z * s}; }
  EMSCAPE_HD Vec3 operator/(Real s) const { return {x / s, y / s, z / s}; }
  EMSCAPE_HD bool operator==(const Vec3& o) const { return x == o.x && y == o.y && z == o.z; }
  EMSCAPE_HD bool operator!=(const Vec3& o) const { return !(*this == o); }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

template <class Real>
EMSCAPE_HD Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
EMSCAPE_HD Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
EMSCAPE_HD Real length(const Vec3<Real>& a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector; the argument must not be zero.
template <class Real>
EMSCAPE_HD Vec3<Real> normalized(const Vec3<Real>& a) {
  return a / length(a);
}
template <class To, class From>
EMSCAPE_HD Vec3<To> vecCast(const Vec3<From>& a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

/// Numbers of cells along x, y and z.
struct Dims {
  int x = 0, y = 0, z = 0;

  EMSCAPE_HD long long count() const { return static_cast<long long>(x) * y * z; }
  EMSCAPE_HD bool operator==(const Dims& o) const { return x == o.x && y == o.y && z == o.z; }
  EMSCAPE_HD bool operator!=(const Dims& o) const { return !(*this == o); }
};

}  // namespace emscape
