/// What a pixel that is not cast follows from: single source for host and device.
#pragma once

#include "base/host_device.h"
#include "render/image.h"
#include "render/reconstruction.h"

namespace emscape::render {

/// The two ways to fill a pixel, by kind of arithmetic; see Interpolation.
struct FloatArithmetic {
  EMSCAPE_HD static Rgba mean(const Rgba& p, const Rgba& q) { return (p + q) * 0.5F; }
  EMSCAPE_HD static Rgba copy(const Rgba& p) { return p; }
};
struct Bits8Arithmetic {
  EMSCAPE_HD static float mean(float a, float b) {
    return static_cast<float>((quantized(a) + quantized(b) + 1) / 2) / 255.0F;
  }
  EMSCAPE_HD static float copy(float a) { return static_cast<float>(quantized(a)) / 255.0F; }
  EMSCAPE_HD static Rgba mean(const Rgba& p, const Rgba& q) {
    return {mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b), mean(p.a, q.a)};
  }
  EMSCAPE_HD static Rgba copy(const Rgba& p) { return {copy(p.r), copy(p.g), copy(p.b), copy(p.a)}; }
};

/// A pixel of a pattern, from source pixels alone: the plain form of interpolate().
/// @param source  source(x, y): a pixel that was cast
template <class Arithmetic, class Source>
EMSCAPE_HD Rgba pixelOf(Pattern pattern, const Source& source, ImageSize size, int x, int y) {
  const auto between_rows = [&](int column, int row) {
    if (row + 1 == size.height) return Arithmetic::copy(source(column, row - 1));
    return Arithmetic::mean(source(column, row - 1), source(column, row + 1));
  };
  const bool odd_x = x % 2 == 1;
  const bool odd_y = y % 2 == 1;
  if (pattern == Pattern::quarter) {
    const auto column = [&](int even_x) { return odd_y ? between_rows(even_x, y) : source(even_x, y); };
    if (!odd_x) return column(x);
    return x + 1 == size.width ? Arithmetic::copy(column(x - 1))
                               : Arithmetic::mean(column(x - 1), column(x + 1));
  }
  const bool missing =
      (pattern == Pattern::columns && odd_x) || (pattern == Pattern::checkerboard && odd_x != odd_y);
  if (!missing) return source(x, y);
  const bool has_left = x > 0;
  const bool has_right = x + 1 < size.width;
  if (has_left && has_right) return Arithmetic::mean(source(x - 1, y), source(x + 1, y));
  if (has_left || has_right) return Arithmetic::copy(source(has_left ? x - 1 : x + 1, y));
  return between_rows(x, y);  // a picture one pixel wide
}

}  // namespace emscape::render
