/// The instruction set of which the compiled loops make use.
#pragma once

namespace emscape {

/// "avx512", "avx2" or the architecture's baseline: results of two sets differ in the last digits.
inline const char* instructionSet() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return "avx512";
  if (__builtin_cpu_supports("avx2")) return "avx2";
  return "x86-64";
#else
  return "generic";
#endif
}

}  // namespace emscape
