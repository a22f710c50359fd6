/// Vector instructions: versions of a function for wider units, chosen when the program starts; and loops.
#pragma once

/// Placed before a function's definition: g++ compiles it, with everything that is inlined, for AVX-512, AVX2
/// and the baseline target. Levels of x86-64, as AVX-512F alone has no 16-bit numbers in vectors of 512 bits,
/// and neither it nor AVX2 fused products in those of 256: loops over excess codes took three times as long.
/// Off under sanitizers, whose run time is not initialised when the version is chosen.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EMSCAPE_SIMD_CLONES \
  __attribute__((flatten, target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define EMSCAPE_SIMD_CLONES
#endif

/// Before a loop whose iterations are independent but for reductions, which are named as OpenMP does:
/// EMSCAPE_SIMD(reduction(max : largest)). For loops of headers: vector instructions in sources that are
/// compiled with -fopenmp-simd and EMSCAPE_OPENMP_SIMD, a plain loop elsewhere.
#if defined(EMSCAPE_OPENMP_SIMD)
#define EMSCAPE_PRAGMA(...) _Pragma(#__VA_ARGS__)
#define EMSCAPE_SIMD(...) EMSCAPE_PRAGMA(omp simd __VA_ARGS__)
#else
#define EMSCAPE_SIMD(...)
#endif
