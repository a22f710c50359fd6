/// Fast powers of two, roots, sines and cosines for functions on host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

namespace emscape {

/// cos and sin of 2 pi turns. Absolute error on the device 5e-7.
/// @param turns  |turns| < 2^22
EMSCAPE_HD inline void cosSinOfTurns(float turns, float& cosine, float& sine) {
#if defined(__CUDA_ARCH__)
  __sincosf(6.283185307f * (turns - rintf(turns)), &sine, &cosine);
#else
  const double angle = 6.283185307179586 * (double(turns) - std::rint(double(turns)));
  cosine = float(std::cos(angle));
  sine = float(std::sin(angle));
#endif
}

/// 2^x. On the device to 22 bits.
EMSCAPE_HD inline float powerOfTwo(float x) {
#if defined(__CUDA_ARCH__)
  float power = 0;
  asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(power) : "f"(x));
  return power;
#else
  return std::exp2(x);
#endif
}

/// Square root of x >= 0. On the device to 22 bits.
EMSCAPE_HD inline float rootOf(float x) {
#if defined(__CUDA_ARCH__)
  float root = 0;
  asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(root) : "f"(x));
  return root;
#else
  return std::sqrt(x);
#endif
}

}  // namespace emscape
