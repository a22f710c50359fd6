#include "render/patterns/reconstruction.h"

#include <gtest/gtest.h>

#include <limits>

#include "emscape/base/error.h"

namespace emscape::render {
namespace {

constexpr Pattern kLatticePatterns[] = {Pattern::full, Pattern::columns, Pattern::checkerboard,
                                        Pattern::quarter};
constexpr float kUnwritten = std::numeric_limits<float>::quiet_NaN();

void count(const std::vector<Lattice>& lattices, ImageSize size, std::vector<int>& written) {
  for (const Lattice& l : lattices) {
    for (int j = 0; j < l.rows; ++j) {
      for (int i = 0; i < l.columns; ++i) {
        const int x = l.first_x + i * l.step_x;
        const int y = l.first_y + j * l.step_y;
        ASSERT_LT(x, size.width);
        ASSERT_LT(y, size.height);
        ++written[static_cast<std::size_t>(y) * size.width + x];
      }
    }
  }
}

/// An image whose source pixels follow `value`; the others hold NaN.
template <class Value>
Image sourcesOf(Pattern pattern, ImageSize size, const Value& value) {
  Image image(size);
  for (Rgba& pixel : image.pixels) pixel = {kUnwritten, kUnwritten, kUnwritten, kUnwritten};
  for (const Lattice& l : sourceLattices(pattern, size)) {
    for (int j = 0; j < l.rows; ++j) {
      for (int i = 0; i < l.columns; ++i) {
        const int x = l.first_x + i * l.step_x;
        const int y = l.first_y + j * l.step_y;
        const float v = value(x, y);
        image.at(x, y) = {v, v, v, v};
      }
    }
  }
  return image;
}

TEST(Patterns, SourceAndMissingPixelsPartitionTheImage) {
  for (Pattern pattern : kLatticePatterns) {
    for (int height = 1; height <= 9; ++height) {
      for (int width = 1; width <= 9; ++width) {
        const ImageSize size{width, height};
        std::vector<int> written(static_cast<std::size_t>(size.count()));
        count(sourceLattices(pattern, size), size, written);
        count(missingLattices(pattern, size), size, written);
        for (int times : written) EXPECT_EQ(times, 1) << toString(pattern) << " " << width << "x" << height;
      }
    }
  }
}

TEST(Patterns, CountsAt1200x900EqualSpecification) {
  const ImageSize size{1200, 900};
  EXPECT_EQ(pixelCount(sourceLattices(Pattern::full, size)), 1080000);
  EXPECT_EQ(pixelCount(sourceLattices(Pattern::columns, size)), 540000);
  EXPECT_EQ(pixelCount(sourceLattices(Pattern::checkerboard, size)), 540000);
  EXPECT_EQ(pixelCount(sourceLattices(Pattern::quarter, size)), 270000);
  EXPECT_EQ(pixelCount(missingLattices(Pattern::quarter, size)), 810000);
}

TEST(Patterns, SourcePixelsEqualTable) {
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) {
      const auto isSource = [&](Pattern pattern) {
        const Image image = sourcesOf(pattern, {5, 5}, [](int, int) { return 1.0F; });
        return image.at(x, y).a == 1.0F;
      };
      EXPECT_EQ(isSource(Pattern::columns), x % 2 == 0);
      EXPECT_EQ(isSource(Pattern::checkerboard), (x + y) % 2 == 0);
      EXPECT_EQ(isSource(Pattern::quarter), x % 2 == 0 && y % 2 == 0);
    }
  }
}

TEST(Interpolation, WritesEveryPixelOfEverySizeFromSourcesAlone) {
  for (Interpolation interpolation : {Interpolation::float32, Interpolation::bits8}) {
    for (Pattern pattern : kLatticePatterns) {
      for (int height = 1; height <= 7; ++height) {
        for (int width = 1; width <= 7; ++width) {
          Image image = sourcesOf(pattern, {width, height}, [](int, int) { return 0.4F; });
          interpolate(pattern, interpolation, image);
          for (const Rgba& pixel : image.pixels) EXPECT_FLOAT_EQ(pixel.a, 0.4F) << toString(pattern);
        }
      }
    }
  }
}

TEST(Interpolation, IsExactForALinearRampButForCopiedEdges) {
  const auto ramp = [](int x, int y) { return static_cast<float>(x + 16 * y); };
  for (Pattern pattern : {Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
    Image image = sourcesOf(pattern, {9, 9}, ramp);
    interpolate(pattern, Interpolation::float32, image);
    for (int y = 0; y < 9; ++y) {
      for (int x = 1; x < 8; ++x)
        EXPECT_EQ(image.at(x, y).r, ramp(x, y)) << toString(pattern) << x << "," << y;
    }
  }
}

TEST(Interpolation, EdgesOfEvenSizesCopyTheirNeighbour) {
  const auto value = [](int x, int y) { return static_cast<float>(x + 16 * y); };
  Image quarter = sourcesOf(Pattern::quarter, {4, 4}, value);
  interpolate(Pattern::quarter, Interpolation::float32, quarter);
  EXPECT_EQ(quarter.at(0, 3).r, value(0, 2));
  EXPECT_EQ(quarter.at(3, 0).r, value(2, 0));
  EXPECT_EQ(quarter.at(3, 3).r, value(2, 2));
  EXPECT_EQ(quarter.at(1, 1).r, value(1, 1));
  Image board = sourcesOf(Pattern::checkerboard, {4, 2}, value);
  interpolate(Pattern::checkerboard, Interpolation::float32, board);
  EXPECT_EQ(board.at(3, 0).r, value(2, 0));
  EXPECT_EQ(board.at(0, 1).r, value(1, 1));
}

TEST(Interpolation, EightBitRoundsEachPassAndLeavesSources) {
  const auto value = [](int x, int) { return x == 0 ? 10.3F / 255 : 13.2F / 255; };
  Image image = sourcesOf(Pattern::columns, {3, 1}, value);
  interpolate(Pattern::columns, Interpolation::bits8, image);
  EXPECT_EQ(image.at(0, 0).r, 10.3F / 255);
  EXPECT_FLOAT_EQ(image.at(1, 0).r, 12.0F / 255);  // (10 + 13 + 1) / 2
}

TEST(Patterns, NamesReadBackAndOthersAreRefused) {
  for (Pattern pattern : allPatterns()) EXPECT_EQ(parsePattern(toString(pattern)), pattern);
  EXPECT_EQ(parseInterpolation("8bit"), Interpolation::bits8);
  EXPECT_THROW(parsePattern("third"), Error);
  EXPECT_THROW(parseInterpolation("16bit"), Error);
}

}  // namespace
}  // namespace emscape::render
