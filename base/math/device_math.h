/// Interpolation and arithmetic for functions on host and device. On the device they use faster instructions,
/// or instructions whose rounding does not depend on the compiler.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape {

/// a * b + c. On the device always one fused instruction, also with --fmad=false, so that results do not
/// depend on the kernel in which they are computed.
EMSCAPE_HD inline float multiplyAdd(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
  return __fmaf_rn(a, b, c);
#else
  return a * b + c;
#endif
}

/// a + fraction * (b - a): a at 0; fraction may be outside 0..1.
EMSCAPE_HD inline float lerp(float a, float b, float fraction) {
  return multiplyAdd(fraction, b - a, a);
}
EMSCAPE_HD inline double lerp(double a, double b, double fraction) {
  return a + fraction * (b - a);
}

/// 1 / a; a is finite, not subnormal and not 0. On the device within 2 units in the last place, in few
/// instructions and without a branch.
EMSCAPE_HD inline double reciprocal(double a) {
#if defined(__CUDA_ARCH__)
  double near = 0;  // at least 20 bits; each Newton step doubles them
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
/// a / b, with the limits of reciprocal().
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
/// 1 / sqrt(a), with the limits of reciprocal().
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
