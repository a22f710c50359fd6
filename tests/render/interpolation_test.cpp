#include "render/interpolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/reconstruction.h"

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

template <class Arithmetic>
void expectSameAsRows(Pattern pattern, Interpolation interpolation, ImageSize size) {
  const Image cast = randomImage(size);
  Image filled = cast;
  interpolate(pattern, interpolation, filled);
  const auto source = [&](int x, int y) { return cast.at(x, y); };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      EXPECT_EQ(pixelOf<Arithmetic>(pattern, source, size, x, y), filled.at(x, y))
          << toString(pattern) << " " << size.width << "x" << size.height << " at " << x << " " << y;
    }
  }
}

TEST(Interpolation, PixelByPixelIsWhatTheRowsAre) {
  for (const Pattern pattern : {Pattern::full, Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
    for (int height = 1; height <= 7; ++height) {
      for (int width = 1; width <= 7; ++width) {
        expectSameAsRows<FloatArithmetic>(pattern, Interpolation::float32, {width, height});
        expectSameAsRows<Bits8Arithmetic>(pattern, Interpolation::bits8, {width, height});
      }
    }
  }
}

}  // namespace
}  // namespace emscape::render
