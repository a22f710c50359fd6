/// Macros for functions that run on the host and, if compiled by nvcc, on the device, and for loops in them.
#pragma once

#if defined(__CUDACC__)
#define EMSCAPE_HD __host__ __device__
#else
#define EMSCAPE_HD
#endif

/// Unrolls the next loop on the device, so that the arrays that it indexes stay in registers. For loops of
/// few iterations.
#if defined(__CUDA_ARCH__)
#define EMSCAPE_UNROLL _Pragma("unroll")
#else
#define EMSCAPE_UNROLL
#endif
