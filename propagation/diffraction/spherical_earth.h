/// Diffraction loss of a smooth spherical earth: the first term of the residue series, ITU-R P.526-15 section
/// 3.1.1, and its interpolation to a path with sufficient clearance, section 3.2.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/knife_edge.h"
#include "propagation/ground_constants.h"

namespace emscape::propagation {

/// Parameters of the first term that depend on frequency, polarisation and ground. P.526 uses km, MHz and
/// GHz; here lengths are in metres.
template <class Real>
struct FirstTermGround {
  Real admittance;    ///< K a^(1/3), m^(1/3): eq. (15), (16)
  Real range_scale;   ///< X a^(2/3) / (beta d), m^(-1/3): eq. (18)
  Real height_scale;  ///< Y a^(1/3) / (beta h), m^(-2/3): eq. (20)
};

template <class Real>
FirstTermGround<Real> firstTermGround(double frequency_hz, const GroundConstants& ground,
                                      LinearPolarization polarization) {
  const double ghz = frequency_hz / 1e9;
  const double permittivity = ground.relative_permittivity;
  const double loss = 18 * ground.conductivity_s_per_m / ghz;
  // a^(1/3) in m^(1/3) is 10 times that in km^(1/3)
  double admittance =
      0.36 / std::cbrt(ghz) * std::pow((permittivity - 1) * (permittivity - 1) + loss * loss, -0.25);
  if (polarization == LinearPolarization::vertical) {
    admittance *= std::sqrt(permittivity * permittivity + loss * loss);
  }
  return {Real(admittance), Real(2.188 * std::cbrt(ghz)), Real(9.575 * std::cbrt(ghz * ghz))};
}

/// Gain of an antenna's height (dB), eq. (22), (23), with its lower bound.
/// @param b  beta Y, > = 0
template <class Real>
EMSCAPE_HD Real heightGainDb(Real b, Real admittance) {
  const Real least = 2 + kDbPerNeper<Real> * std::log(admittance);
  Real gain;
  if (b > 2) {
    gain = Real(17.6) * std::sqrt(b - Real(1.1)) - kDbPerNeper<Real> / 4 * std::log(b - Real(1.1)) - 8;
  } else {
    gain = kDbPerNeper<Real> * std::log(b + Real(0.1) * b * b * b);
  }
  return gain > least ? gain : least;
}

/// First term (dB), eq. (13): negative well within the horizon, where it is not valid.
/// @param distance_m, height1_m, height2_m  >= 0, heights above the smooth surface
/// @param earth_radius_m  effective
template <class Real>
EMSCAPE_HD Real firstTermLossDb(const FirstTermGround<Real>& ground, Real distance_m, Real height1_m,
                                Real height2_m, Real earth_radius_m) {
  const Real inverse_root = 1 / std::cbrt(earth_radius_m);
  const Real k = ground.admittance * inverse_root;
  const Real k2 = k * k, k4 = k2 * k2;
  const Real beta = (1 + Real(1.6) * k2 + Real(0.67) * k4) / (1 + Real(4.5) * k2 + Real(1.53) * k4);  // (17)
  const Real x = ground.range_scale * beta * inverse_root * inverse_root * distance_m;
  const Real distance_db =  // (21)
      x >= Real(1.6) ? 11 + kDbPerNeper<Real> / 2 * std::log(x) - Real(17.6) * x
                     : -kDbPerNeper<Real> * std::log(x) - Real(5.6488) * std::pow(x, Real(1.425));
  const Real per_height = ground.height_scale * beta * beta * inverse_root;
  return -distance_db - heightGainDb(per_height * height1_m, k) - heightGainDb(per_height * height2_m, k);
}

/// A smooth earth, partly sea.
template <class Real>
struct SphericalEarth {
  Real earth_radius_m;  ///< effective
  Real wavelength_m;
  Real sea_fraction;  ///< of the path, 0..1
  FirstTermGround<Real> land, sea;

  EMSCAPE_HD Real firstTermDb(Real distance_m, Real height1_m, Real height2_m, Real radius_m) const {
    Real loss_db = 0;
    if (sea_fraction < 1) {
      loss_db += (1 - sea_fraction) * firstTermLossDb(land, distance_m, height1_m, height2_m, radius_m);
    }
    if (sea_fraction > 0) {
      loss_db += sea_fraction * firstTermLossDb(sea, distance_m, height1_m, height2_m, radius_m);
    }
    return loss_db;
  }
};

/// Largest ratio of the clearance that a path needs to be free of loss to sqrt(lambda d1 d2 / d): P.526 eq.
/// (27), 17.456 in km and m.
template <class Real>
constexpr Real kRequiredClearance = Real(0.5520071);

/// Range (m) from the lower of two antennas to the reflection point on a smooth earth.
///
/// P.526 gives the point by b, which solves m b^3 - (m + 1) b + c = 0, through an arc cosine. Here 1 - b is
/// computed by two Halley steps from the solution of the quadratic equation for small values: this is
/// accurate near the lower antenna, also in single precision, and takes a quarter of the time.
/// @param low_m, high_m  heights, 0 < low_m <= high_m, within their common horizon
/// @accuracy 2e-7 relative at the horizon, 4e-9 to 7/10 of the way there, 4e-15 to a third
/// @see P.526-15 eq. (25)
template <class Real>
EMSCAPE_HD Real reflectionFromLower_m(Real distance_m, Real low_m, Real high_m, Real earth_radius_m) {
  const Real sum = low_m + high_m;
  const Real m = distance_m * distance_m / (4 * earth_radius_m * sum);
  const Real rest = 2 * low_m / sum;  // 1 - c
  const Real linear = 1 - 2 * m;
  Real u = 2 * rest / (linear + std::sqrt(linear * linear + 12 * m * rest));  // 1 - b
  for (int i = 0; i < 2; ++i) {
    const Real value = u * (linear + m * u * (3 - u)) - rest;
    const Real slope = linear + 3 * m * u * (2 - u);
    u -= value * slope / (slope * slope - value * (3 * m * (1 - u)));
  }
  return distance_m * u / 2;
}

/// The clearance of a line of sight over a smooth earth at the reflection point.
template <class Real>
struct LeastClearance {
  Real clearance_m;
  Real required_m;  ///< to be free of loss
};

/// @param height1_m, height2_m  > 0, within their common horizon
/// @see P.526-15 eq. (24), (27)
template <class Real>
EMSCAPE_HD LeastClearance<Real> leastClearance(const SphericalEarth<Real>& earth, Real distance_m,
                                               Real height1_m, Real height2_m) {
  const Real low = height1_m < height2_m ? height1_m : height2_m;
  const Real high = height1_m < height2_m ? height2_m : height1_m;
  const Real d_low = reflectionFromLower_m(distance_m, low, high, earth.earth_radius_m);
  const Real d_high = distance_m - d_low;
  const Real half_curvature = 1 / (2 * earth.earth_radius_m), inverse_distance = 1 / distance_m;
  const Real clearance =
      (low - d_low * d_low * half_curvature) * d_high + (high - d_high * d_high * half_curvature) * d_low;
  return {clearance * inverse_distance,
          kRequiredClearance<Real> * std::sqrt(earth.wavelength_m * d_low * d_high * inverse_distance)};
}

/// Terms that determine the clearance of a line of sight, from the antennas' heights h1 and h2.
template <class Real>
struct SightLine {
  Real sum_m;     ///< (sqrt(h1) + sqrt(h2))^2
  Real middle_m;  ///< sqrt(h1 h2)
  Real bulge_m;   ///< d^2 / (2 a): the line does not intersect the smooth earth if this is below sum_m
};

template <class Real>
EMSCAPE_HD SightLine<Real> sightLine(const SphericalEarth<Real>& earth, Real distance_m, Real height1_m,
                                     Real height2_m) {
  const Real middle = std::sqrt(height1_m * height2_m);
  return {height1_m + height2_m + 2 * middle, middle, distance_m * distance_m / (2 * earth.earth_radius_m)};
}

/// True if the clearance is everywhere at least the required one; then it is also for every greater height.
/// This holds for most paths with the required clearance at the reflection point, which is the condition of
/// P.526.
///
/// At the fraction x of the path the required clearance is R sqrt(x (1 - x)), R = 0.552 sqrt(lambda d), which
/// is at most R/2 (x / s + s (1 - x)) for any s: a straight line. With s = sqrt(h1 / h2), the line of sight
/// minus this line is a line between heights reduced by the factor 1 - R / (2 sqrt(h1 h2)), which the earth
/// must not intersect.
template <class Real>
EMSCAPE_HD bool isClearThroughout(const SphericalEarth<Real>& earth, Real distance_m,
                                  const SightLine<Real>& line) {
  const Real most_m = kRequiredClearance<Real> * std::sqrt(earth.wavelength_m * distance_m) / 2;
  return line.sum_m * (line.middle_m - most_m) > line.bulge_m * line.middle_m;
}
template <class Real>
EMSCAPE_HD bool isClearThroughout(const SphericalEarth<Real>& earth, Real distance_m, Real height1_m,
                                  Real height2_m) {
  return isClearThroughout(earth, distance_m, sightLine(earth, distance_m, height1_m, height2_m));
}

/// Loss (dB) of a smooth earth, >= 0.
/// @param distance_m            > 0
/// @param height1_m, height2_m  > 0
/// @accuracy float within 0.01 dB of double
/// @see P.526-15 section 3.2
template <class Real>
EMSCAPE_HD Real sphericalEarthLossDb(const SphericalEarth<Real>& earth, Real distance_m, Real height1_m,
                                     Real height2_m) {
  const SightLine<Real> line = sightLine(earth, distance_m, height1_m, height2_m);
  if (isClearThroughout(earth, distance_m, line)) return 0;
  Real radius_m = earth.earth_radius_m;
  Real part = 1;
  if (line.bulge_m < line.sum_m) {
    const LeastClearance<Real> least = leastClearance(earth, distance_m, height1_m, height2_m);
    if (least.clearance_m > least.required_m) return 0;
    // eq. (28): the radius that would put the horizon at this distance
    radius_m *= line.bulge_m / line.sum_m;
    part = 1 - least.clearance_m / least.required_m;
  }
  const Real loss_db = earth.firstTermDb(distance_m, height1_m, height2_m, radius_m);
  return loss_db > 0 ? part * loss_db : Real(0);
}

}  // namespace emscape::propagation
