/// OKLab, a colour space whose lightness and hue agree with perception, for sRGB colours.
/// @see B. Ottosson, "A perceptual color space for image processing", 2020
#pragma once

#include <algorithm>
#include <cmath>

#include "emscape/render/transfer/transfer_function.h"

namespace emscape::render {

struct Oklab {
  double lightness = 0;  ///< 0 black to 1 white
  double a = 0, b = 0;   ///< green to red, blue to yellow; chroma is their length, hue their angle
};

/// Linear light, 0..1 within the gamut.
struct LinearRgb {
  double r = 0, g = 0, b = 0;

  bool isInGamut() const {
    constexpr double kRounding = 1e-6;
    return std::min({r, g, b}) >= -kRounding && std::max({r, g, b}) <= 1 + kRounding;
  }
};

inline LinearRgb linearOf(const Rgb& color) {
  const auto linear = [](float part) {
    const auto c = static_cast<double>(part);
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {linear(color.r), linear(color.g), linear(color.b)};
}

/// Parts outside the gamut are limited to it.
inline Rgb encoded(const LinearRgb& light) {
  const auto part = [](double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
  };
  return {part(light.r), part(light.g), part(light.b)};
}

inline Oklab oklabOf(const Rgb& color) {
  const LinearRgb light = linearOf(color);
  const double l = std::cbrt(0.4122214708 * light.r + 0.5363325363 * light.g + 0.0514459929 * light.b);
  const double m = std::cbrt(0.2119034982 * light.r + 0.6806995451 * light.g + 0.1073969566 * light.b);
  const double s = std::cbrt(0.0883024619 * light.r + 0.2817188376 * light.g + 0.6299787005 * light.b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

inline LinearRgb linearOf(const Oklab& color) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(color.lightness + 0.3963377774 * color.a + 0.2158037573 * color.b);
  const double m = cube(color.lightness - 0.1055613458 * color.a - 0.0638541728 * color.b);
  const double s = cube(color.lightness - 0.0894841775 * color.a - 1.2914855480 * color.b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// A colour with another lightness, the same hue and chroma.
/// @param change  of the lightness; as much of it as the gamut of sRGB has at this hue and chroma
inline Rgb withLightness(const Rgb& color, double change) {
  constexpr int kHalvings = 10;
  const Oklab from = oklabOf(color);
  const auto at = [&](double part) {
    return linearOf(Oklab{from.lightness + part * change, from.a, from.b});
  };
  const LinearRgb whole = at(1);
  if (whole.isInGamut()) return encoded(whole);
  double inside = 0, outside = 1;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = (inside + outside) / 2;
    (at(middle).isInGamut() ? inside : outside) = middle;
  }
  return inside == 0 ? color : encoded(at(inside));
}

}  // namespace emscape::render
