#include "propagation/horizon/horizon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape::propagation {
namespace {

TEST(Horizon, TheSurfaceOfASmoothEarthIsLitUpToTheHorizon) {
  constexpr float kRadius_m = 4.0F / 3 * 6371000;
  for (const float height_m : {1.0F, 30.0F, 300.0F, 12000.0F}) {
    const HorizonGeometry<float> geometry{height_m, kRadius_m};
    const double horizon_m = std::sqrt(2.0 * static_cast<double>(kRadius_m * height_m));
    for (double range_m = 10; range_m < 0.999 * horizon_m; range_m += horizon_m / 3000) {
      const float edge_m =
          geometry.heightOn(smoothGrazingSlope(geometry, range_m), geometry.termsAt(range_m));
      ASSERT_LT(edge_m, 0) << height_m << " m, " << range_m << " m";
      ASSERT_GT(edge_m, -0.02) << height_m << " m, " << range_m << " m";
    }
    EXPECT_GT(
        geometry.heightOn(smoothGrazingSlope(geometry, 1.1 * horizon_m), geometry.termsAt(1.1 * horizon_m)),
        0.004 * static_cast<double>(height_m));
  }
}

}  // namespace
}  // namespace emscape::propagation
