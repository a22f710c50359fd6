/// Complex numbers for physics that runs on the host and on the device, where std::complex does not.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape::propagation {

template <class Real>
struct Complex {
  Real re = 0;
  Real im = 0;
};

template <class Real>
EMSCAPE_HD Complex<Real> operator+(Complex<Real> a, Complex<Real> b) {
  return {a.re + b.re, a.im + b.im};
}
template <class Real>
EMSCAPE_HD Complex<Real> operator-(Complex<Real> a, Complex<Real> b) {
  return {a.re - b.re, a.im - b.im};
}
template <class Real>
EMSCAPE_HD Complex<Real> operator*(Complex<Real> a, Real b) {
  return {a.re * b, a.im * b};
}
template <class Real>
EMSCAPE_HD Complex<Real> operator*(Complex<Real> a, Complex<Real> b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
/// |a|^2.
template <class Real>
EMSCAPE_HD Real norm(Complex<Real> a) {
  return a.re * a.re + a.im * a.im;
}
template <class Real>
EMSCAPE_HD Real abs(Complex<Real> a) {
  return std::sqrt(norm(a));
}
template <class Real>
EMSCAPE_HD Complex<Real> operator/(Complex<Real> a, Complex<Real> b) {
  const Real scale = 1 / norm(b);
  return {(a.re * b.re + a.im * b.im) * scale, (a.im * b.re - a.re * b.im) * scale};
}
/// The square root with the real part >= 0.
template <class Real>
EMSCAPE_HD Complex<Real> sqrt(Complex<Real> a) {
  const Real half = (abs(a) + std::fabs(a.re)) / 2;
  if (half == 0) return {};
  const Real larger = std::sqrt(half);
  const Real smaller = a.im / (2 * larger);
  if (a.re >= 0) return {larger, smaller};
  return {std::fabs(smaller), a.im < 0 ? -larger : larger};
}

}  // namespace emscape::propagation
