/// Elementary functions for inner loops: branch-free, without tables and library calls, one source for host
/// and device, so that a plain loop over them under `#pragma omp simd` becomes SIMD code.
///
/// g++ 12 vectorises such loops with -O3 -fopenmp-simd -fno-trapping-math, and also needs -fno-math-errno if
/// they call std::sqrt: set these options only for the file with the loop. Never compile them with
/// -ffast-math or -fassociative-math: rounding to an integer relies on the order of additions. Accuracies
/// hold with and without fused multiply-add.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "emscape/base/host_device.h"

namespace emscape {
namespace fast_math_detail {

constexpr float kMinNormal = 1.17549435e-38f;
/// 1.5 * 2^23: adding it leaves a number's nearest integer in the low bits of the sum's mantissa.
constexpr float kRoundingMagic = 12582912.0f;
constexpr std::uint32_t kRoundingMagicBits = 0x4b400000u;
/// 10 log10(2) = kDbPerOctaveHigh + kDbPerOctaveLow; the high part has 16 bits, so that its product with any
/// exponent is exact.
constexpr float kDbPerOctaveHigh = 3.01025390625f;
constexpr float kDbPerOctaveLow = 4.60503898e-5f;

EMSCAPE_HD inline std::uint32_t bitsOf(float x) {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
EMSCAPE_HD inline float floatOf(std::uint32_t bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
/// Keeps NaN.
EMSCAPE_HD inline float clamp(float x, float low, float high) {
  const float bounded_below = x < low ? low : x;
  return bounded_below > high ? high : bounded_below;
}

/// A number and its nearest integer, |value| < 2^22.
struct Rounded {
  float as_float;
  std::uint32_t as_int;  ///< two's complement
};
EMSCAPE_HD inline Rounded roundToInt(float value) {
  const float shifted = value + kRoundingMagic;
  return {shifted - kRoundingMagic, bitsOf(shifted) - kRoundingMagicBits};
}

/// 2^(exponent - 1) for exponent in -126..128, where -126 gives 0.
EMSCAPE_HD inline float halfPowerOfTwo(std::uint32_t exponent) {
  return floatOf((exponent + 126u) << 23);
}

/// log2(x) = exponent + fraction, with the fraction in -0.5..0.5.
struct Log2Parts {
  float exponent;
  float fraction;
};
EMSCAPE_HD inline Log2Parts log2Parts(float x) {
  const float positive = x < kMinNormal ? kMinNormal : x;
  const std::uint32_t bits = bitsOf(positive);
  // Splits at sqrt(1/2), so that the mantissa is evenly distributed about 1.
  const std::uint32_t biased = (bits + (0x3f800000u - 0x3f3504f3u)) >> 23;
  const float f = floatOf(bits - ((biased - 127u) << 23)) - 1.0f;
  // Minimax polynomial of log2(1 + f) / f, weighted by |f|.
  float p = 0.125412434f;
  p = p * f - 0.210303336f;
  p = p * f + 0.217379376f;
  p = p * f - 0.23851943f;
  p = p * f + 0.287656665f;
  p = p * f - 0.360721201f;
  p = p * f + 0.48092252f;
  p = p * f - 0.721347153f;
  p = p * f + 1.4426949f;
  // x - x is 0, but NaN for infinity and NaN.
  return {static_cast<float>(static_cast<std::int32_t>(biased) - 127), p * f + (x - x)};
}

}  // namespace fast_math_detail

/// 2^x. Below x = -125.5: 0. From x = 128: the value just below, 3.4e38; never infinite. NaN stays NaN.
/// @accuracy relative error 2e-7
EMSCAPE_HD inline float fastExp2(float x) {
  using namespace fast_math_detail;
  const float bounded = clamp(x, -126.0f, 127.99999f);
  const Rounded i = roundToInt(bounded);
  const float f = bounded - i.as_float;
  // Minimax polynomial of 2 * 2^f, |f| <= 1/2.
  float p = 3.06916249e-4f;
  p = p * f + 2.67998618e-3f;
  p = p * f + 1.92369781e-2f;
  p = p * f + 0.111006573f;
  p = p * f + 0.480452925f;
  p = p * f + 1.38629436f;
  p = p * f + 2.0f;
  return p * halfPowerOfTwo(i.as_int);
}

/// Decibels to power ratio, 10^(db/10). Below -377.8 dB: 0. From 385.3 dB: 3.4e38; never infinite. NaN stays
/// NaN.
/// @accuracy relative error 2e-7 (1e-6 dB) of the result for the float given, over the whole range
EMSCAPE_HD inline float fastDbToRatio(float db) {
  using namespace fast_math_detail;
  const float bounded = clamp(db, -379.3f, 385.3f);
  const Rounded i = roundToInt(bounded * 0.332192809f);
  // Reduced in dB, not in octaves: the first difference is exact.
  const float f = (bounded - i.as_float * kDbPerOctaveHigh) - i.as_float * kDbPerOctaveLow;
  // Minimax polynomial of 2 * 10^(f/10), |f| <= 1.507 dB.
  float p = 4.12437345e-7f;
  p = p * f + 1.08414652e-5f;
  p = p * f + 2.34259831e-4f;
  p = p * f + 4.06929664e-3f;
  p = p * f + 5.30189723e-2f;
  p = p * f + 0.460517049f;
  p = p * f + 2.0f;
  return p * halfPowerOfTwo(i.as_int);
}

/// log2(x). Below the smallest normal number (1.2e-38, 0 and negative numbers too): -126. NaN for infinity
/// and NaN.
/// @accuracy error 1.5e-7 * max(1, |log2 x|)
EMSCAPE_HD inline float fastLog2(float x) {
  const fast_math_detail::Log2Parts parts = fast_math_detail::log2Parts(x);
  return parts.exponent + parts.fraction;
}

/// Power ratio to decibels, 10 log10(x). Below 1.2e-38 (0 and negative numbers too): -379.3. NaN for infinity
/// and NaN.
/// @accuracy error 1e-7 * max(4, |result|) dB
EMSCAPE_HD inline float fastRatioToDb(float x) {
  using namespace fast_math_detail;
  const Log2Parts parts = log2Parts(x);
  return parts.exponent * kDbPerOctaveHigh +
         (parts.exponent * kDbPerOctaveLow + parts.fraction * 3.01029996f);
}

/// Angle (rad, -pi..pi) of the point (x, y), finite; 0 at the origin. A negative zero as x counts as
/// positive. With y = sin and x = cos it is the way to an angle that stays exact near 0 and pi/2, unlike arc
/// sine and arc cosine.
/// @accuracy error 2e-7 rad; near 0 relative error 2e-7 (unless both are below 1e-38)
EMSCAPE_HD inline float fastAtan2(float y, float x) {
  using namespace fast_math_detail;
  const float abs_x = std::fabs(x);
  const float abs_y = std::fabs(y);
  const bool steep = abs_y > abs_x;
  const float smaller = steep ? abs_x : abs_y;
  const float larger = steep ? abs_y : abs_x;
  const float q = smaller / (larger < kMinNormal ? kMinNormal : larger);
  const float s = q * q;
  // Minimax polynomial of (atan(q) / q - 1) / q^2 in q^2, weighted by q^3, 0 <= q <= 1.
  float p = 2.62224372e-3f;
  p = p * s - 1.51325325e-2f;
  p = p * s + 4.11218517e-2f;
  p = p * s - 7.36670569e-2f;
  p = p * s + 0.105739318f;
  p = p * s - 0.141859755f;
  p = p * s + 0.199903965f;
  p = p * s - 0.333329856f;
  const float first_octant = q + q * s * p;
  // The half plane's four octants: 0 + a, pi/2 - a, pi/2 + a, pi - a; pi/2 and pi are the float next to them
  // and a rest.
  const bool left = x < 0.0f;
  const float from = steep ? 1.57079637f : (left ? 3.14159274f : 0.0f);
  const float rest = steep ? -4.37113883e-8f : (left ? -8.74227766e-8f : 0.0f);
  const float half_plane = from + ((steep != left ? -first_octant : first_octant) + rest);
  return std::copysign(half_plane, y);
}

}  // namespace emscape
