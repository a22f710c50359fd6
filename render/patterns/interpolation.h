/// Interpolation of the pixels that are not cast: single source for host and device.
#pragma once

#include <cstdint>

#include "emscape/base/host_device.h"
#include "render/cast/rgba.h"
#include "render/patterns/reconstruction.h"

namespace emscape::render {

/// A pixel in 8-bit levels: r in the lowest byte, then g, b and a.
struct Rgba8 {
  std::uint32_t levels = 0;
};
EMSCAPE_HD inline Rgba8 quantized(const Rgba8& p) {
  return p;
}
EMSCAPE_HD inline Rgba8 quantized(const Rgba& p) {
  return {quantized(p.r) | std::uint32_t{quantized(p.g)} << 8 | std::uint32_t{quantized(p.b)} << 16 |
          std::uint32_t{quantized(p.a)} << 24};
}
EMSCAPE_HD inline Rgba toRgba(const Rgba& p) {
  return p;
}
EMSCAPE_HD inline Rgba toRgba(const Rgba8& p) {
  const auto part = [&](int bit) { return static_cast<float>(p.levels >> bit & 0xFFU) / 255.0F; };
  return {part(0), part(8), part(16), part(24)};
}

/// The two kinds of arithmetic; see Interpolation. Color is the interpolated type. The mean of a colour and
/// itself is that colour, so that an edge pixel copies its only neighbour.
struct FloatArithmetic {
  using Color = Rgba;
  EMSCAPE_HD static const Rgba& of(const Rgba& source) { return source; }
  EMSCAPE_HD static Rgba mean(const Rgba& p, const Rgba& q) { return (p + q) * 0.5F; }
};
struct Bits8Arithmetic {
  using Color = Rgba8;
  EMSCAPE_HD static Rgba8 of(const Rgba& source) { return quantized(source); }
  /// (p + q + 1) / 2 of each byte: the bits that at least one has, minus half of the bits that only one has.
  EMSCAPE_HD static Rgba8 mean(const Rgba8& p, const Rgba8& q) {
    return {(p.levels | q.levels) - ((p.levels ^ q.levels) >> 1 & 0x7F7F7F7FU)};
  }
};

/// Four pixels of a pattern, (x, y) to (x + 1, y + 1), from source pixels, each of which is read once:
/// interpolate() by cells.
/// @param x, y  even
/// @param source  source(x, y): a pixel that was cast
/// @param put  put(column, row, color) takes pixel (x + column, y + row): Rgba, a source pixel, or
///             Arithmetic::Color. Values for pixels beyond the picture are undefined.
template <class Arithmetic, class Source, class Put>
EMSCAPE_HD void fillCell(Pattern pattern, ImageSize size, int x, int y, const Source& source,
                         const Put& put) {
  const auto meanOf = [](const Rgba& p, const Rgba& q) {
    return Arithmetic::mean(Arithmetic::of(p), Arithmetic::of(q));
  };
  // Neighbours, and those of the same parity; at an edge replaced by pixels of the cell.
  const int right = x + 1 < size.width ? x + 1 : x;
  const int below = y + 1 < size.height ? y + 1 : y;
  const int next_x = x + 2 < size.width ? x + 2 : x;
  const int next_y = y + 2 < size.height ? y + 2 : y;
  const Rgba here = source(x, y);
  switch (pattern) {
    case Pattern::full:
    case Pattern::adaptive: {
      const Rgba beside = source(right, y), under = source(x, below), across = source(right, below);
      put(0, 0, here);
      put(1, 0, beside);
      put(0, 1, under);
      put(1, 1, across);
      return;
    }
    case Pattern::columns: {
      const Rgba next = source(next_x, y), under = source(x, below), next_under = source(next_x, below);
      put(0, 0, here);
      put(1, 0, meanOf(here, next));
      put(0, 1, under);
      put(1, 1, meanOf(under, next_under));
      return;
    }
    case Pattern::checkerboard: {
      const Rgba next = source(next_x, y);
      put(0, 0, here);
      put(1, 0, meanOf(here, next));
      if (below == y) return;
      if (size.width == 1) return put(0, 1, meanOf(here, source(x, next_y)));
      const int after = right > x ? right : x - 1;
      const Rgba across = source(after, below), before = source(x > 0 ? x - 1 : after, below);
      put(0, 1, meanOf(before, across));
      put(1, 1, across);
      return;
    }
    case Pattern::quarter: {
      const Rgba next = source(next_x, y), lower = source(x, next_y), next_lower = source(next_x, next_y);
      const auto column = meanOf(here, lower);
      put(0, 0, here);
      put(1, 0, meanOf(here, next));
      put(0, 1, column);
      put(1, 1, Arithmetic::mean(column, meanOf(next, next_lower)));
      return;
    }
  }
}

}  // namespace emscape::render
