/// Macros for functions that run on the host and, compiled by nvcc, on the device, and for their loops.
#pragma once

#if defined(__CUDACC__)
#define EMSCAPE_HD __host__ __device__
#else
#define EMSCAPE_HD
#endif

/// Put before a loop of few iterations: on the device it is unrolled, so that arrays it indexes stay in
/// registers.
#if defined(__CUDA_ARCH__)
#define EMSCAPE_UNROLL _Pragma("unroll")
#else
#define EMSCAPE_UNROLL
#endif
