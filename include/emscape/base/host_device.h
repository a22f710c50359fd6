/// Marks of functions that run on the host and, compiled by nvcc, on the device, and of their loops.
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
