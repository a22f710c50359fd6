/// Arithmetic of functions that run on the host and on the device, where the device has better than the plain
/// form: steps that compilers cannot choose differently, or that are fewer.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape {

/// a * b + c. On the device in one instruction also where the compiler is told to keep products and sums
/// apart, which makes results independent of the kernel that they are computed in.
EMSCAPE_HD inline float multiplyAdd(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return __fmaf_rn(a, b, c);
#else
  return a * b + c;
#endif
}

/// 1 / a of an ordinary number. On the device to a unit or two in the last place, in few instructions and
/// without a branch, so that several overlap.
EMSCAPE_HD inline double reciprocal(double a) {
#if defined(__CUDA_ARCH__)
  double near = 0;  // to 20 bits and more, which each step doubles
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(near) : "d"(a));
  near = __fma_rn(near, __fma_rn(-a, near, 1.0), near);
  return __fma_rn(near, __fma_rn(-a, near, 1.0), near);
#else
  return 1.0 / a;
#endif
}
EMSCAPE_HD inline float reciprocal(float a) {
#if defined(__CUDA_ARCH__)
  return __fdividef(1.0F, a);
#else
  return 1.0F / a;
#endif
}
/// a / b, as reciprocal().
template <class Real>
EMSCAPE_HD Real quotient(Real a, Real b) {
#if defined(__CUDA_ARCH__)
  return a * reciprocal(b);
#else
  return a / b;
#endif
}
/// a^b for a >= 0. On the device to 22 bits.
EMSCAPE_HD inline float power(float a, float b) {
#if defined(__CUDA_ARCH__)
  return __powf(a, b);
#else
  return std::pow(a, b);
#endif
}
/// 1 / sqrt(a), as reciprocal().
EMSCAPE_HD inline double reciprocalRoot(double a) {
#if defined(__CUDA_ARCH__)
  double near = 0;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(near) : "d"(a));
  const double half = 0.5 * a;
  near = __fma_rn(near, __fma_rn(-half * near, near, 0.5), near);
  return __fma_rn(near, __fma_rn(-half * near, near, 0.5), near);
#else
  return 1.0 / std::sqrt(a);
#endif
}

}  // namespace emscape
