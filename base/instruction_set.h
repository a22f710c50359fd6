/// The instruction set of which the compiled loops make use.
#pragma once

namespace emscape {

/// "avx512", "avx2" or the architecture's baseline: results of two sets differ in the last digits.
inline const char* instructionSet() {
#if defined(__x86_64__)
  // Those of EMSCAPE_SIMD_CLONES.
  if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) return "avx512";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "avx2";
  return "x86-64";
#else
  return "generic";
#endif
}

}  // namespace emscape
