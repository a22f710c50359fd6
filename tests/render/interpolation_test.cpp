#include "render/patterns/interpolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/patterns/reconstruction.h"

namespace emscape::render {
namespace {

Image randomImage(ImageSize size) {
  Image image(size);
  for (std::size_t n = 0; n < image.pixels.size(); ++n) {
    const auto part = [n](double factor) { return static_cast<float>(std::fmod(factor * (n + 1.0), 1.0)); };
    image.pixels[n] = {part(0.618), part(0.377), part(0.834), part(0.271)};
  }
  return image;
}

/// Source pixels of a pattern; the others are NaN, which would propagate to the result.
Image sourcesOf(Pattern pattern, const Image& image) {
  Image sources(image.size);
  for (Rgba& pixel : sources.pixels) pixel = {NAN, NAN, NAN, NAN};
  for (const Lattice& l : sourceLattices(pattern, image.size)) {
    for (int j = 0; j < l.rows; ++j) {
      for (int i = 0; i < l.columns; ++i) {
        const int x = l.first_x + i * l.step_x, y = l.first_y + j * l.step_y;
        sources.at(x, y) = image.at(x, y);
      }
    }
  }
  return sources;
}

template <class Arithmetic>
Image filledByCells(Pattern pattern, const Image& sources) {
  const ImageSize size = sources.size;
  Image filled(size);
  const auto source = [&](int x, int y) {
    EXPECT_TRUE(x >= 0 && x < size.width && y >= 0 && y < size.height) << x << " " << y;
    return sources.at(x, y);
  };
  for (int y = 0; y < size.height; y += 2) {
    for (int x = 0; x < size.width; x += 2) {
      fillCell<Arithmetic>(pattern, size, x, y, source, [&](int column, int row, const auto& color) {
        if (x + column < size.width && y + row < size.height) {
          filled.at(x + column, y + row) = toRgba(color);
        }
      });
    }
  }
  return filled;
}

template <class Arithmetic>
void expectSameAsRows(Pattern pattern, Interpolation interpolation, ImageSize size) {
  const Image sources = sourcesOf(pattern, randomImage(size));
  Image filled = sources;
  interpolate(pattern, interpolation, filled);
  EXPECT_TRUE(filledByCells<Arithmetic>(pattern, sources).pixels == filled.pixels)
      << toString(pattern) << " " << toString(interpolation) << " " << size.width << "x" << size.height;
}

TEST(Interpolation, CellByCellEqualsRows) {
  for (const Pattern pattern : {Pattern::full, Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
    for (int height = 1; height <= 9; ++height) {
      for (int width = 1; width <= 9; ++width) {
        expectSameAsRows<FloatArithmetic>(pattern, Interpolation::float32, {width, height});
        expectSameAsRows<Bits8Arithmetic>(pattern, Interpolation::bits8, {width, height});
      }
    }
  }
}

TEST(Interpolation, LevelsEqualRoundedFloats) {
  for (int level = 0; level < 256; ++level) {
    const auto value = static_cast<float>(level) / 255.0F;
    const Rgba8 p = quantized(Rgba{value, 0, 1, value});
    EXPECT_EQ(p.levels,
              (static_cast<std::uint32_t>(level) | 255U << 16 | static_cast<std::uint32_t>(level) << 24));
    EXPECT_EQ(toRgba(p), (Rgba{value, 0, 1, value}));
  }
}

TEST(Interpolation, MeansOfLevelsRoundHalfUp) {
  for (std::uint32_t a = 0; a < 256; ++a) {
    for (std::uint32_t b = 0; b < 256; ++b) {
      const Rgba8 p{a | b << 8 | a << 16 | b << 24}, q{b | b << 8 | a << 16 | a << 24};
      const std::uint32_t mean = (a + b + 1) / 2;
      EXPECT_EQ(Bits8Arithmetic::mean(p, q).levels, (mean | b << 8 | a << 16 | mean << 24)) << a << " " << b;
    }
  }
}

}  // namespace
}  // namespace emscape::render
