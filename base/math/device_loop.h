/// What loops over posts need on host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"

/// A function that is called on the device, not inlined: its registers are not part of its callers', and its
/// code is there once. On the host the compiler chooses.
#if defined(__CUDACC__)
#define EMSCAPE_DEVICE_CALL __noinline__
#else
#define EMSCAPE_DEVICE_CALL
#endif

/// Unrolls the next loop by a number on the device; 1: not at all.
#if defined(__CUDA_ARCH__)
#define EMSCAPE_PRAGMA(text) _Pragma(#text)
#define EMSCAPE_UNROLL_BY(count) EMSCAPE_PRAGMA(unroll count)
#else
#define EMSCAPE_UNROLL_BY(count)
#endif

namespace emscape {

/// 1 / a for normal a or 0. On the device one instruction, within 2 units in the last place.
EMSCAPE_HD inline float approximateReciprocal(float a) {
#if defined(__CUDA_ARCH__)
  float result;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
  return result;
#else
  return 1.0F / a;
#endif
}
/// 1 / sqrt(a), in the same way.
EMSCAPE_HD inline float approximateReciprocalRoot(float a) {
#if defined(__CUDA_ARCH__)
  float result;
  asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(result) : "f"(a));
  return result;
#else
  return 1.0F / std::sqrt(a);
#endif
}

/// The smaller and the larger of two numbers.
EMSCAPE_HD inline int smaller(int a, int b) {
  return a < b ? a : b;
}
EMSCAPE_HD inline int larger(int a, int b) {
  return a < b ? b : a;
}

/// True on the device if it is true for any of the warp's threads that are here; on the host the same value.
EMSCAPE_HD inline bool isForAnyLane(bool is) {
#if defined(__CUDA_ARCH__)
  return __any_sync(__activemask(), is) != 0;
#else
  return is;
#endif
}

}  // namespace emscape
