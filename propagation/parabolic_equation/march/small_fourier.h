/// Fourier transforms of 2, 4, 8 and 16 numbers that stay in registers.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/complex.h"

namespace emscape::propagation {

template <class Real>
EMSCAPE_HD Complex<Real> conjugate(Complex<Real> a) {
  return {a.re, -a.im};
}

/// Type of a constant factor of numbers of type Real.
template <class Real>
using ScalarOf = Real;

#include "propagation/parabolic_equation/march/small_fourier-inl.h"

}  // namespace emscape::propagation
