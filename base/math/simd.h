/// Versions of a function for wider vector units, chosen when the program starts.
#pragma once

/// Placed before a function's definition: g++ compiles it, with everything that is inlined, for AVX-512, AVX2
/// and the baseline target. Off under sanitizers, whose run time is not initialised when the version is
/// chosen.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EMSCAPE_SIMD_CLONES __attribute__((flatten, target_clones("avx512f", "avx2", "default")))
#else
#define EMSCAPE_SIMD_CLONES
#endif
