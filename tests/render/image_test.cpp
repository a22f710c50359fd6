#include "emscape/render/picture/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "render/cast/rgba.h"
#include "tests/support/errors.h"
#include "tests/support/stopping.h"
#include "tests/support/temporary_folder.h"

namespace emscape::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Image8 image8(int width, int height, std::vector<std::uint8_t> rgba) {
  return {{width, height}, std::move(rgba)};
}

TEST(Image, QuantisesToTheNearestLevelAndClamps) {
  EXPECT_EQ(quantized(0.0F), 0);
  EXPECT_EQ(quantized(1.0F), 255);
  EXPECT_EQ(quantized(0.5F / 255.0F + 1e-6F), 1);
  EXPECT_EQ(quantized(-3.0F), 0);
  EXPECT_EQ(quantized(7.0F), 255);
  EXPECT_EQ(quantized(std::numeric_limits<float>::quiet_NaN()), 0);
  for (int level = 0; level < 256; ++level) EXPECT_EQ(quantized(static_cast<float>(level) / 255.0F), level);
}

TEST(Image, SizesAreParsedStrictly) {
  EXPECT_EQ(parseImageSize("1200x900"), (ImageSize{1200, 900}));
  EXPECT_EQ(parseImageSize("1x1"), (ImageSize{1, 1}));
  EXPECT_EQ(parseImageSize("32767x1"), (ImageSize{32767, 1}));
  for (const char* bad : {"", "12", "x", "12x", "0x5", "5x-1", "12x12x12", "99999x2", "12 x12 "}) {
    EXPECT_THROW(parseImageSize(bad), Error) << bad;
  }
}

TEST(Png, RoundTripIsExact) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "opaque.png";
  const Image8 opaque = image8(2, 2, {1, 2, 3, 255, 255, 0, 7, 255, 0, 0, 0, 255, 90, 80, 70, 255});
  writePng(file, opaque);
  EXPECT_EQ(readPng(file).rgba, opaque.rgba);
  const Image8 clear = image8(2, 1, {0, 0, 0, 0, 64, 32, 128, 128});
  writePng(file, clear);
  const Image8 read = readPng(file);
  EXPECT_EQ(read.size, clear.size);
  for (std::size_t i = 0; i < clear.rgba.size(); ++i) EXPECT_NEAR(read.rgba[i], clear.rgba[i], 1);
}

TEST(Png, IsNotEncodedToItsEndOnceTheWorkIsStopped) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "large.png";
  Image8 large;
  large.size = {6000, 4000};
  large.rgba.resize(static_cast<std::size_t>(large.size.count()) * 4);
  std::uint32_t random = 1;
  for (std::uint8_t& byte : large.rgba)
    byte = static_cast<std::uint8_t>((random = random * 1664525 + 1013904223) >> 24);
  test::expectStopsWithinASecond([&] { writePng(file, large); }, 50);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Png, FailuresNameTheFileAndLeaveNoFile) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "missing_folder/picture.png";
  EXPECT_THAT(test::errorOf([&] { writePng(file, image8(1, 1, {1, 2, 3, 255})); }), HasSubstr("picture.png"));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_THROW(readPng(folder.write("broken.png", "not a picture")), Error);
  EXPECT_THROW(readPng(file), Error);
}

TEST(ImageDifference, CountsAsThePapersTablesDo) {
  const Image8 reference = image8(4, 1, {0, 0, 0, 0, 10, 20, 0, 30, 10, 20, 0, 30, 10, 20, 0, 30});
  const Image8 image = image8(4, 1, {0, 0, 0, 0, 12, 20, 0, 30, 9, 21, 0, 30, 10, 20, 0, 30});
  const ImageDifference d = compare(image, reference);
  EXPECT_THAT(d.max, ElementsAre(2, 1, 0, 0));
  EXPECT_THAT(d.mean, ElementsAre(1.5, 0.5, 0, 0));
  EXPECT_EQ(d.erroneous, 2);
  EXPECT_EQ(d.nonzero, 3);
  EXPECT_NEAR(d.ratio_percent, 200.0 / 3, 1e-9);
  EXPECT_NEAR(d.mean_all, 4.0 / 16, 1e-12);
  EXPECT_NEAR(d.psnr_db, 10 * std::log10(255.0 * 255.0 / (6.0 / 16)), 1e-9);
}

TEST(ImageDifference, EqualPicturesHaveInfinitePsnrAndOtherSizesAreRefused) {
  const Image8 image = image8(1, 1, {1, 2, 3, 4});
  EXPECT_TRUE(std::isinf(compare(image, image).psnr_db));
  EXPECT_THROW(compare(image, image8(2, 1, std::vector<std::uint8_t>(8))), Error);
}

}  // namespace
}  // namespace emscape::render
