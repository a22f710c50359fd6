/// Prediction of a pixel from the known pixels around it, with an estimate of its error: single source for
/// host and device over plain data.
///
/// A midpoint is half-way between two known pixels along each of two directions. Along a direction the four
/// nearest known pixels give a cubic prediction, (9 (a + b) - (c + d)) / 16, whose deviation from the linear
/// one, (a + b) / 2, is limited to a quarter of the step between a and b, so that edges do not ring. The
/// direction along which the picture changes less has more weight.
///
/// Color is Rgba, or a vector of the four channels that has the operators and the functions below.
#pragma once

#include <cmath>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "render/cast/rgba.h"

namespace emscape::render {

/// A level of 255 in units of a colour's components, and the inverse.
constexpr float kLevel = 1.0F / 255;
constexpr float kLevels = 255;

// --- What a Color needs besides +, -, a product with a float and addScaled() ---

EMSCAPE_HD inline float lesser(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fminf(a, b);  // one instruction
#else
  return a < b ? a : b;
#endif
}
EMSCAPE_HD inline float greater(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}
EMSCAPE_HD inline Rgba operator-(const Rgba& p, const Rgba& q) {
  return {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a};
}
EMSCAPE_HD inline Rgba lesser(const Rgba& p, const Rgba& q) {
  return {lesser(p.r, q.r), lesser(p.g, q.g), lesser(p.b, q.b), lesser(p.a, q.a)};
}
EMSCAPE_HD inline Rgba greater(const Rgba& p, const Rgba& q) {
  return {greater(p.r, q.r), greater(p.g, q.g), greater(p.b, q.b), greater(p.a, q.a)};
}
EMSCAPE_HD inline Rgba magnitude(const Rgba& p) {
  return {std::fabs(p.r), std::fabs(p.g), std::fabs(p.b), std::fabs(p.a)};
}
EMSCAPE_HD inline float largestChannel(const Rgba& p) {
  return greater(greater(p.r, p.g), greater(p.b, p.a));
}
/// A colour of equal components.
template <class Color>
EMSCAPE_HD Color uniform(float value);
template <>
EMSCAPE_HD inline Rgba uniform<Rgba>(float value) {
  return {value, value, value, value};
}

// --- Predictions ---

/// A prediction along one direction; magnitudes are those of the largest channel.
template <class Color>
struct Along {
  Color color;
  float step = 0;  ///< |a - b|
  float bend = 0;  ///< |cubic - linear| before it is limited
};

/// Prediction from the two nearest pixels of a direction and the next two beyond them.
template <class Color>
EMSCAPE_HD Along<Color> predictAlong(const Color& a, const Color& b, const Color& beyond_a,
                                     const Color& beyond_b) {
  const Color zero = uniform<Color>(0);
  const Color sum = a + b;
  const Color difference = a - b;
  const Color step = magnitude(difference);
  const Color bend = (sum - (beyond_a + beyond_b)) * (1.0F / 16);
  const Color limit = addScaled(step, 0.25F, uniform<Color>(0.5F * kLevel));
  const Color limited = greater(lesser(bend, limit), zero - limit);
  return {greater(addScaled(sum, 0.5F, limited), zero), largestChannel(step),
          largestChannel(magnitude(bend))};
}
/// Prediction from only the two nearest pixels.
template <class Color>
EMSCAPE_HD Along<Color> predictAlong(const Color& a, const Color& b) {
  return {(a + b) * 0.5F, largestChannel(magnitude(a - b)), 0.0F};
}

/// A predicted pixel, and an estimate of its error in levels, which is compared with the tolerance.
template <class Color>
struct Prediction {
  Color color;
  float error_levels = 0;
};

/// A larger step indicates that an edge may be there, however well the predictions agree.
constexpr float kSteep = 8 * kLevel;

EMSCAPE_HD inline float steepness(float step) {
  return 0.5F * greater(step - kSteep, 0.0F);
}

/// Prediction from both directions, with an error from their difference, the bend of the straighter one, and
/// the steepness of the flatter one.
template <class Color>
EMSCAPE_HD Prediction<Color> predict(const Along<Color>& p, const Along<Color>& q) {
  constexpr float kNoise = 0.5F * kLevel;
  const Color apart = p.color - q.color;
  const float share = quotient(q.step + kNoise, p.step + q.step + 2 * kNoise);
  const float disagreement = largestChannel(magnitude(apart));
  return {addScaled(apart, share, q.color),
          (disagreement + lesser(p.bend, q.bend) + steepness(lesser(p.step, q.step))) * kLevels};
}
/// Prediction from one direction, at the picture's edge, with half the step instead of the difference.
template <class Color>
EMSCAPE_HD Prediction<Color> predict(const Along<Color>& p) {
  return {p.color, (0.5F * p.step + p.bend + steepness(p.step)) * kLevels};
}

}  // namespace emscape::render
