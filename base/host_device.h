/// Marks functions that run on the host and, compiled by nvcc, on the device.
#pragma once

#if defined(__CUDACC__)
#define EMSCAPE_HD __host__ __device__
#else
#define EMSCAPE_HD
#endif

/// Put before a loop of few turns: on the device it is unrolled, so that what it indexes stays in registers.
#if defined(__CUDA_ARCH__)
#define EMSCAPE_UNROLL _Pragma("unroll")
#else
#define EMSCAPE_UNROLL
#endif

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

}  // namespace emscape
