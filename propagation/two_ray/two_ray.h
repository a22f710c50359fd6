/// Model `two_ray`: the direct ray, the ray reflected by a smooth spherical earth or sea, and their
/// interference (lobing).
///
/// The reflected ray has Fresnel's coefficient of its ground and polarisation, reduced by roughness and by
/// the divergence of the curved surface. Where the direct ray clears the earth by less than 0.552 Fresnel
/// radii the loss changes to diffraction, linearly in the remaining clearance; beyond the horizon it is that
/// of the spherical earth alone:
///   L = q L_two-ray + (1 - q) L_first-term(a_m), q = clearance / required clearance, 0..1
/// which is P.526's interpolation (section 3.2) with the interference instead of 0 dB. It is continuous in
/// range, heights and frequency.
///
/// There is no terrain: heights are above one smooth surface. The loss is for isotropic antennas; TwoRayPath
/// has the reflected ray's amplitude and direction, with which the field weights the two rays by the
/// antennas' gains (emfield/columns/two_rays.h).
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/propagation/reflected_ray.h"
#include "emscape/propagation/settings.h"
#include "propagation/complex.h"
#include "propagation/diffraction/spherical_earth.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kTwoRayFrequency{
    "frequency", "MHz", 1e6, 20, 50000, Beyond::warned, "below, the ground wave is missing"};
constexpr ModelLimit kTwoRayHeight{"antenna height above the surface",
                                   "m",
                                   1,
                                   1,
                                   20000,
                                   Beyond::clamped,
                                   "lower, the reflected ray's near field and the ground wave count"};
constexpr ModelLimit kTwoRayRoughness{
    "roughness (rms)", "m", 1, 0, 10, Beyond::warned, "shadowing of waves by waves is not modelled"};
constexpr const ModelLimit* kTwoRayLimits[] = {&kTwoRayFrequency, &kTwoRayHeight, &kTwoRayRoughness};

struct TwoRayParameters {
  double frequency_hz = 0;
  double effective_earth_radius_m = 0;
  LinearPolarization polarization = LinearPolarization::horizontal;
  GroundConstants ground = kDiffractionLand;  ///< at the frequency
  double roughness_m = 0;                     ///< standard deviation of the surface's height
  RoughnessModel roughness_model = RoughnessModel::miller_brown;
  TwoRaySum sum = TwoRaySum::coherent;
};

/// Fresnel's reflection coefficient of a plane ground.
/// @param permittivity  eps' - i eps''; time dependence exp(+i omega t)
/// @param sine          of the grazing angle, 0..1
/// @return -1 at grazing for both polarisations
/// @see P.526-15 section 4.1, eq. (9), (10) of P.2040
template <class Real>
EMSCAPE_HD Complex<Real> fresnelReflection(Complex<Real> permittivity, LinearPolarization polarization,
                                           Real sine) {
  const Complex<Real> inner = sqrt(permittivity - Complex<Real>{1 - sine * sine, 0});
  const Complex<Real> outer =
      polarization == LinearPolarization::horizontal ? Complex<Real>{sine, 0} : permittivity * sine;
  return (outer - inner) / (outer + inner);
}

/// exp(-z) I0(z), z >= 0.
/// @accuracy 2e-7
/// @see Abramowitz and Stegun 9.8.1, 9.8.2
template <class Real>
EMSCAPE_HD Real scaledBesselI0(Real z) {
  if (z < Real(3.75)) {
    const Real t = z / Real(3.75), s = t * t;
    return std::exp(-z) *
           (1 + s * (Real(3.5156229) +
                     s * (Real(3.0899424) +
                          s * (Real(1.2067492) +
                               s * (Real(0.2659732) + s * (Real(0.0360768) + s * Real(0.0045813)))))));
  }
  const Real t = Real(3.75) / z;
  return (Real(0.39894228) +
          t * (Real(0.01328592) +
               t * (Real(0.00225319) +
                    t * (Real(-0.00157565) +
                         t * (Real(0.00916281) +
                              t * (Real(-0.02057706) +
                                   t * (Real(0.02635537) +
                                        t * (Real(-0.01647633) + t * Real(0.00392377))))))))) /
         std::sqrt(z);
}

/// Coherent fraction (0..1) of the reflection.
/// @param sine  of the grazing angle
template <class Real>
EMSCAPE_HD Real roughnessFactor(RoughnessModel model, Real roughness_m, Real sine, Real wavelength_m) {
  const Real phase = Real(2 * kPi) * roughness_m * sine / wavelength_m;
  const Real z = 2 * phase * phase;
  return model == RoughnessModel::ament ? std::exp(-z) : scaledBesselI0(z);
}

/// The model at one frequency, as plain data.
template <class Real>
struct TwoRayModel {
  SphericalEarth<Real> earth;
  Complex<Real> permittivity;
  LinearPolarization polarization;
  Real roughness_m;
  RoughnessModel roughness_model;
  TwoRaySum sum;
};

template <class Real>
TwoRayModel<Real> twoRayModel(const TwoRayParameters& parameters) {
  TwoRayModel<Real> model;
  model.earth.earth_radius_m = Real(parameters.effective_earth_radius_m);
  model.earth.wavelength_m = Real(wavelength_m(parameters.frequency_hz));
  model.earth.sea_fraction = 0;
  model.earth.land =
      firstTermGround<Real>(parameters.frequency_hz, parameters.ground, parameters.polarization);
  model.earth.sea = model.earth.land;
  model.permittivity = {Real(parameters.ground.relative_permittivity),
                        Real(-parameters.ground.lossFactor(parameters.frequency_hz))};
  model.polarization = parameters.polarization;
  model.roughness_m = Real(parameters.roughness_m);
  model.roughness_model = parameters.roughness_model;
  model.sum = parameters.sum;
  return model;
}

/// The two rays over a spherical earth.
template <class Real>
struct ReflectedPath {
  Real path_difference_m;  ///< reflected minus direct
  Real length_ratio;       ///< direct over reflected, 0..1
  Real sine;               ///< of the grazing angle
  Real divergence;         ///< 0..1
  Real point_m = 0;        ///< of the reflection, along the surface from end 1
};

/// @param distance_m            along the surface, > 0
/// @param height1_m, height2_m  > 0, within their common horizon
/// @see P.526-15 eq. (25) for the point; Blake 1980, eq. (6.29) for the divergence, D^-2 = 1 + 2 d1 d2 / (a d
/// sin psi); the path difference is exact for these angles, without cancellation:
/// (r1 + r2)^2 - r^2 = 4 r1 r2 sin^2 psi
template <class Real>
EMSCAPE_HD ReflectedPath<Real> reflectedPath(Real earth_radius_m, Real distance_m, Real height1_m,
                                             Real height2_m) {
  const Real low = height1_m < height2_m ? height1_m : height2_m;
  const Real high = height1_m < height2_m ? height2_m : height1_m;
  const Real d1 = reflectionFromLower_m(distance_m, low, high, earth_radius_m), d2 = distance_m - d1;
  // straight length from the surface, or from another height, to a height at a range
  const auto length = [&](Real range_m, Real from_m, Real to_m) {
    const Real chord = 2 * earth_radius_m * std::sin(range_m / (2 * earth_radius_m));
    return std::sqrt((to_m - from_m) * (to_m - from_m) +
                     chord * chord * (1 + from_m / earth_radius_m) * (1 + to_m / earth_radius_m));
  };
  // height above the tangent plane at the point
  const auto overPlane = [&](Real range_m, Real height_m) {
    const Real half_sine = std::sin(range_m / (2 * earth_radius_m));
    return height_m - 2 * (earth_radius_m + height_m) * half_sine * half_sine;
  };
  const Real r1 = length(d1, 0, low), r2 = length(d2, 0, high), r = length(distance_m, low, high);
  // The point is exact to a relative error of height over radius: use the mean of the two angles.
  const Real sine = (overPlane(d1, low) / r1 + overPlane(d2, high) / r2) / 2;
  ReflectedPath<Real> path;
  path.sine = sine > 0 ? sine : Real(0);
  path.path_difference_m = 4 * r1 * r2 * path.sine * path.sine / (r1 + r2 + r);
  path.length_ratio = r / (r1 + r2);
  path.divergence = std::sqrt(path.sine / (path.sine + 2 * d1 * d2 / (earth_radius_m * distance_m)));
  path.point_m = height1_m < height2_m ? d1 : d2;
  return path;
}

/// Sine of the angle below the horizontal at which the straight line from an antenna meets the surface.
/// @param point_m  distance of the point along the surface
template <class Real>
EMSCAPE_HD Real depressionSine(Real earth_radius_m, Real height_m, Real point_m) {
  const Real half_sine = std::sin(point_m / (2 * earth_radius_m));
  const Real drop_m = height_m + 2 * earth_radius_m * half_sine * half_sine;
  const Real level_m = 2 * earth_radius_m * half_sine * std::sqrt(1 - half_sine * half_sine);
  return drop_m / std::sqrt(drop_m * drop_m + level_m * level_m);
}

/// Amplitude of the reflected ray relative to the direct ray, both between isotropic antennas; for the
/// envelope its magnitude.
template <class Real>
EMSCAPE_HD Complex<Real> reflectedAmplitude(const TwoRayModel<Real>& model, const ReflectedPath<Real>& path) {
  const Complex<Real> reflection = fresnelReflection(model.permittivity, model.polarization, path.sine);
  const Real amplitude =
      path.divergence * path.length_ratio *
      roughnessFactor(model.roughness_model, model.roughness_m, path.sine, model.earth.wavelength_m);
  if (model.sum == TwoRaySum::envelope) return {amplitude * abs(reflection), 0};
  const Real cycles = path.path_difference_m / model.earth.wavelength_m;
  const Real phase = Real(2 * kPi) * (cycles - std::floor(cycles));
  return reflection * (Complex<Real>{std::cos(phase), -std::sin(phase)} * amplitude);
}

/// Propagation factor of the two rays: the field's amplitude relative to free space.
template <class Real>
EMSCAPE_HD Real interferenceFactor(const TwoRayModel<Real>& model, const ReflectedPath<Real>& path) {
  return abs(Complex<Real>{1, 0} + reflectedAmplitude(model, path));
}

/// Loss of a path, and its reflected ray.
template <class Real>
struct TwoRayPath {
  Real excess_db = 0;        ///< loss over free space between isotropic antennas
  Complex<Real> reflected;   ///< reflectedAmplitude(); 0 beyond the horizon
  Real weight = 0;           ///< q: weight of the interference in the loss, 0..1
  Real depression_sine = 0;  ///< of the reflected ray at end 1
};

/// The loss and the reflected ray.
/// @param distance_m            along the surface; below 1 m: 1 m
/// @param height1_m, height2_m  above the surface; see kTwoRayHeight
/// @return a loss of at most 60 dB in the nulls, negative in the lobes
/// @accuracy float within 0.05 dB of double outside the nulls, where F > -20 dB, up to 1e4 wavelengths of
/// path difference
template <class Real>
EMSCAPE_HD TwoRayPath<Real> twoRayPath(const TwoRayModel<Real>& model, Real distance_m, Real height1_m,
                                       Real height2_m) {
  const Real lowest = Real(kTwoRayHeight.min);
  const Real h1 = height1_m > lowest ? height1_m : lowest, h2 = height2_m > lowest ? height2_m : lowest;
  const Real radius_m = model.earth.earth_radius_m;
  distance_m = distance_m < 1 ? Real(1) : distance_m;  // vertically above: finite
  const Real roots = std::sqrt(h1) + std::sqrt(h2);
  TwoRayPath<Real> path;
  if (distance_m >= std::sqrt(2 * radius_m) * roots) {
    const Real loss_db = model.earth.firstTermDb(distance_m, h1, h2, radius_m);
    path.excess_db = loss_db > 0 ? loss_db : Real(0);
    return path;
  }
  const ReflectedPath<Real> rays = reflectedPath(radius_m, distance_m, h1, h2);
  path.reflected = reflectedAmplitude(model, rays);
  path.depression_sine = depressionSine(radius_m, h1, rays.point_m);
  const Real factor = abs(Complex<Real>{1, 0} + path.reflected);
  constexpr Real kMin = Real(kMinInterference);
  const Real interference_db = -kDbPerNeper<Real> * std::log(factor > kMin ? factor : kMin);
  const LeastClearance<Real> least = leastClearance(model.earth, distance_m, h1, h2);
  path.weight = least.clearance_m / least.required_m;
  if (path.weight >= 1) {
    path.weight = 1;
    path.excess_db = interference_db;
    return path;
  }
  const Real grazing_radius_m = distance_m / roots * (distance_m / roots) / 2;
  const Real first_term_db = model.earth.firstTermDb(distance_m, h1, h2, grazing_radius_m);
  path.excess_db =
      path.weight * interference_db + (1 - path.weight) * (first_term_db > 0 ? first_term_db : Real(0));
  return path;
}

/// Only the loss (dB).
template <class Real>
EMSCAPE_HD Real twoRayExcessDb(const TwoRayModel<Real>& model, Real distance_m, Real height1_m,
                               Real height2_m) {
  return twoRayPath(model, distance_m, height1_m, height2_m).excess_db;
}

}  // namespace emscape::propagation
