#include "base/near_ecef.h"

#include <gtest/gtest.h>

#include <random>

namespace emscape {
namespace {

TEST(NearEcef, IsThePointOfTheEllipsoidAnywhere) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> latitude(-90, 90), longitude(-360, 360);
  NearEcef near;
  for (int n = 0; n < 2000; ++n) {
    const double latitude_deg = latitude(random), longitude_deg = longitude(random);
    const Vec3d expected = toEcef({latitude_deg, longitude_deg, 0});
    EXPECT_LT(length(near.at(latitude_deg, longitude_deg) - expected), 1e-8)
        << latitude_deg << " " << longitude_deg;
  }
  EXPECT_LT(length(near.at(90, 12) - toEcef({90, 12, 0})), 1e-8);
}

}  // namespace
}  // namespace emscape
