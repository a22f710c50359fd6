#include "apps/view/colors.h"

#include <gtest/gtest.h>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

render::TransferFunction sample() {
  render::TransferFunction function;
  function.colors = {{-90, {0, 0, 0}}, {-30, {1, 1, 1}}};
  function.opacities = {{-90, 0}, {-60, 0.1}, {-30, 0.6}};
  return function;
}

TEST(Colors, NoAdjustmentChangesNothing) {
  EXPECT_TRUE(ColorAdjustment().empty());
  const render::TransferFunction same = adjusted(sample(), {});
  EXPECT_DOUBLE_EQ(same.lowest(), -90);
  EXPECT_DOUBLE_EQ(same.opacity(-60), 0.1);
}

TEST(Colors, ARangeMovesColoursAndOpacitiesAlike) {
  ColorAdjustment adjustment;
  adjustment.range = volume::ValueRange{-100, 0};
  const render::TransferFunction function = adjusted(sample(), adjustment);
  EXPECT_DOUBLE_EQ(function.lowest(), -100);
  EXPECT_DOUBLE_EQ(function.highest(), 0);
  EXPECT_NEAR(function.opacity(-50), 0.1, 1e-12);
  EXPECT_NEAR(function.color(-50).r, 0.5, 1e-6);
}

TEST(Colors, OpacityIsMultipliedAndStaysBelowOne) {
  ColorAdjustment adjustment;
  adjustment.opacity_factor = 3;
  const render::TransferFunction function = adjusted(sample(), adjustment);
  EXPECT_NEAR(function.opacity(-60), 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(function.opacity(-30), 1);
}

TEST(Colors, AColourMapSpansTheInterval) {
  ColorAdjustment adjustment;
  adjustment.color_map = "cividis";
  const render::TransferFunction function = adjusted(sample(), adjustment);
  EXPECT_DOUBLE_EQ(function.colors.front().at, -90);
  EXPECT_DOUBLE_EQ(function.colors.back().at, -30);
  EXPECT_NEAR(function.color(-90).b, render::colorMap("cividis").at(0).b, 1e-6);
}

TEST(Colors, EmptyRangesAndUnknownMapsAreRefused) {
  ColorAdjustment adjustment;
  adjustment.range = volume::ValueRange{5, 5};
  EXPECT_THROW(adjusted(sample(), adjustment), Error);
  adjustment = {};
  adjustment.color_map = "rainbow";
  EXPECT_THROW(adjusted(sample(), adjustment), Error);
}

TEST(Colors, CategoriesStayAsTheyAre) {
  render::TransferFunction function;
  function.categorical = true;
  function.opacities = {{0, 0.5}};
  ColorAdjustment adjustment;
  adjustment.opacity_factor = 0.1;
  EXPECT_DOUBLE_EQ(adjusted(function, adjustment).opacities.front().opacity, 0.5);
}

}  // namespace
}  // namespace emscape::view
