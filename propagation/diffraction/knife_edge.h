/// Diffraction loss of a single knife edge.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"

namespace emscape::propagation {

/// 20 / ln(10).
template <class Real>
constexpr Real kDbPerNeper = Real(8.685889638065037);

/// Below this nu the approximation is 0.
template <class Real>
constexpr Real kKnifeEdgeClear = Real(-0.78);

/// J(nu), the loss (dB) of a knife edge over free space: the approximation that all other methods here use.
/// Rises from 0 at nu = -0.78 (a step of 0.02 dB) and is within 0.13 dB of knifeEdgeExactDb from -0.5 up.
/// @param nu  height of the edge above the line of sight in first Fresnel radii, times sqrt(2)
/// @accuracy float within 1e-5 dB of double up to nu = 100
/// @see P.526-15 eq. (31)
template <class Real>
EMSCAPE_HD Real knifeEdgeDb(Real nu) {
  if (!(nu > kKnifeEdgeClear<Real>)) return nu <= kKnifeEdgeClear<Real> ? Real(0) : nu;
  const Real above = nu - Real(0.1);
  const Real root = std::sqrt(above * above + 1);
  // root + above would cancel for above < 0
  const Real sum = above >= 0 ? root + above : 1 / (root - above);
  return Real(6.9) + kDbPerNeper<Real> * std::log(sum);
}

/// Auxiliary functions of the Fresnel integrals for x >= 1: C = 1/2 + f sin - g cos, S = 1/2 - f cos - g sin
/// of pi x^2 / 2.
struct FresnelAuxiliary {
  double f, g;
};

/// The trapezoidal rule over
///   f + i g = sqrt(2) / pi * integral of (1 + i u^2) exp(-pi x^2 u^2 / 2) / (1 + u^4) over u > 0,
/// which converges exponentially: the integrand is even and its poles lie at a distance of sqrt(1/2).
/// @accuracy 1e-9 for x >= 1
/// @see Abramowitz and Stegun 7.3.5, 7.3.6 with 7.4.22, 7.4.23
EMSCAPE_HD inline FresnelAuxiliary fresnelAuxiliary(double x) {
  // step as required by the poles and the width of the bell
  const double step = x > 2.5 ? 0.5 / x : 0.2;
  double f = 0.5, g = 0;
  for (int i = 1; i <= 24; ++i) {
    const double u2 = (i * step) * (i * step);
    const double weight = std::exp(-kPi / 2 * x * x * u2) / (1 + u2 * u2);
    f += weight;
    g += weight * u2;
  }
  const double scale = 1.4142135623730951 / kPi * step;
  return {scale * f, scale * g};
}

/// Fresnel integrals C(x) and S(x) of pi t^2 / 2.
struct FresnelIntegrals {
  double c, s;
};
EMSCAPE_HD inline FresnelIntegrals fresnelIntegrals(double x) {
  const double size = std::fabs(x);
  double c = 0, s = 0;
  const double phase = kPi / 2 * x * x;
  if (size < 1.5) {
    // x sum (-i phase)^n / (n! (2 n + 1)): even terms make C, odd ones -S
    double term = size;
    for (int n = 0; n < 40; ++n) {
      const double part = term / (2 * n + 1);
      switch (n % 4) {
        case 0:
          c += part;
          break;
        case 1:
          s += part;
          break;
        case 2:
          c -= part;
          break;
        default:
          s -= part;
      }
      term *= phase / (n + 1);
    }
  } else {
    const FresnelAuxiliary a = fresnelAuxiliary(size);
    c = 0.5 + a.f * std::sin(phase) - a.g * std::cos(phase);
    s = 0.5 - a.f * std::cos(phase) - a.g * std::sin(phase);
  }
  return x < 0 ? FresnelIntegrals{-c, -s} : FresnelIntegrals{c, s};
}

/// J(nu) exactly (dB). Below nu = -0.78 it oscillates about 0 because of the interference with the diffracted
/// field.
/// @accuracy 1e-6 dB
/// @see P.526-15 eq. (7), (30)
EMSCAPE_HD inline double knifeEdgeExactDb(double nu) {
  if (nu >= 1.5) {
    const FresnelAuxiliary a = fresnelAuxiliary(nu);  // (1/2 - C)^2 + (1/2 - S)^2 would cancel
    return -10 * std::log10((a.f * a.f + a.g * a.g) / 2);
  }
  const FresnelIntegrals fresnel = fresnelIntegrals(nu);
  const double c = 0.5 - fresnel.c, s = 0.5 - fresnel.s;
  return -10 * std::log10((c * c + s * s) / 2);
}

}  // namespace emscape::propagation
