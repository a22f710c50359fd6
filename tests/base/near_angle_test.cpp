#include "base/near_angle.h"

#include <gtest/gtest.h>

#include <random>

namespace emscape {
namespace {

TEST(NearAngle, IsSineAndCosine) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-4, 4), near(-2e-3, 2e-3);
  NearAngle angle;
  for (int n = 0; n < 2000; ++n) {
    const double first_rad = any(random);
    for (int m = 0; m < 5; ++m) {
      const double angle_rad = first_rad + near(random);
      const SineCosine found = angle.at(angle_rad);
      ASSERT_NEAR(found.sine, std::sin(angle_rad), 4e-16) << angle_rad;
      ASSERT_NEAR(found.cosine, std::cos(angle_rad), 4e-16) << angle_rad;
    }
  }
}

TEST(NearAngle, DoesNotDependOnTheAngleBefore) {
  NearAngle angle;
  const SineCosine first = angle.at(0.7);
  angle.at(0.6999);
  angle.at(-2);
  EXPECT_EQ(angle.at(0.7).sine, first.sine);
  EXPECT_EQ(angle.at(0.7).cosine, first.cosine);
}

}  // namespace
}  // namespace emscape
