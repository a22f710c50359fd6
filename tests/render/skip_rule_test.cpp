#include "render/cast/skip_rule.h"

#include <gtest/gtest.h>

namespace emscape::render {
namespace {

TEST(SkippingPays, WhereMuchOfTheVolumeIsTransparent) {
  EXPECT_TRUE(
      skippingPays(CompositingMode::dvr, 0.77));  // one radar over 200 km: a frame takes 0.6 of the time
  EXPECT_TRUE(skippingPays(CompositingMode::dvr, 1));
  EXPECT_TRUE(skippingPays(CompositingMode::mida, 1));
}

TEST(SkippingPays, NotWhereLittleOfTheVolumeIsTransparent) {
  EXPECT_FALSE(
      skippingPays(CompositingMode::dvr, 0.215));  // eme_200: nothing is gained, with few rays 0.1 lost
  EXPECT_FALSE(skippingPays(CompositingMode::mida, 0.215));  // half the time of a frame lost
  EXPECT_FALSE(skippingPays(CompositingMode::dvr, 0));
  EXPECT_FALSE(skippingPays(CompositingMode::mida, 0));
}

TEST(SkippingPays, AlwaysWhereThePictureIsOfOneSampleARay) {
  for (const CompositingMode mode : {CompositingMode::mip, CompositingMode::iso}) {
    EXPECT_TRUE(skippingPays(mode, 0)) << toString(mode);
    EXPECT_TRUE(skippingPays(mode, 1)) << toString(mode);
  }
}

}  // namespace
}  // namespace emscape::render
