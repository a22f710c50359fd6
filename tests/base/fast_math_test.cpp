#include "base/math/fast_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace emscape {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Calls body(x) for `count` floats, evenly from low to high.
template <class Body>
void sweep(double low, double high, int count, const Body& body) {
  for (int i = 0; i < count; ++i) {
    body(static_cast<float>(low + (high - low) * i / (count - 1)));
  }
}

TEST(FastExp2, IsWithinItsStatedError) {
  double worst = 0;
  const auto check = [&](float x) {
    const double exact = std::exp2(static_cast<double>(x));
    worst = std::max(worst, std::abs(fastExp2(x) / exact - 1));
  };
  sweep(-125.49, 127.999, 2000003, check);
  sweep(-1.0, 1.0, 1000003, check);
  EXPECT_LT(worst, 2e-7);
}

TEST(FastExp2, IsExactAtIntegers) {
  for (int i = -125; i <= 127; ++i) EXPECT_EQ(fastExp2(static_cast<float>(i)), std::ldexp(1.0f, i));
}

TEST(FastExp2, UnderflowsToZeroAndNeverOverflows) {
  EXPECT_EQ(fastExp2(-125.6f), 0.0f);
  EXPECT_EQ(fastExp2(-126.0f), 0.0f);
  EXPECT_EQ(fastExp2(-1e30f), 0.0f);
  EXPECT_EQ(fastExp2(-kInfinity), 0.0f);
  for (const float x : {128.0f, 129.0f, 1e30f, kInfinity}) {
    EXPECT_TRUE(std::isfinite(fastExp2(x)));
    EXPECT_GT(fastExp2(x), 3.39e38f);
  }
  EXPECT_TRUE(std::isnan(fastExp2(kNan)));
}

TEST(FastDbToRatio, IsWithinItsStatedError) {
  double worst = 0;
  const auto check = [&](float db) {
    worst = std::max(worst, std::abs(fastDbToRatio(db) / std::pow(10.0, static_cast<double>(db) / 10) - 1));
  };
  sweep(-377.7, 385.2, 2000003, check);
  sweep(-5.0, 5.0, 1000003, check);
  EXPECT_LT(worst, 2e-7);
}

TEST(FastDbToRatio, StaysFiniteFromMinus400To400Db) {
  EXPECT_EQ(fastDbToRatio(0.0f), 1.0f);
  EXPECT_EQ(fastDbToRatio(-400.0f), 0.0f);
  EXPECT_EQ(fastDbToRatio(-378.0f), 0.0f);
  EXPECT_TRUE(std::isfinite(fastDbToRatio(400.0f)));
  EXPECT_GT(fastDbToRatio(400.0f), 3.3e38f);
  EXPECT_EQ(fastDbToRatio(-kInfinity), 0.0f);
  EXPECT_TRUE(std::isnan(fastDbToRatio(kNan)));
}

TEST(FastLog2, IsWithinItsStatedError) {
  double worst = 0;
  const auto check = [&](float x) {
    const double exact = std::log2(static_cast<double>(x));
    worst = std::max(worst, std::abs(fastLog2(x) - exact) / std::max(1.0, std::abs(exact)));
  };
  sweep(-126.0, 127.99, 2000003,
        [&](float e) { check(static_cast<float>(std::exp2(static_cast<double>(e)))); });
  sweep(0.4, 2.5, 2000003, check);
  EXPECT_LT(worst, 1.5e-7);
}

TEST(FastLog2, IsExactAtPowersOfTwo) {
  for (int i = -126; i <= 127; ++i) EXPECT_EQ(fastLog2(std::ldexp(1.0f, i)), static_cast<float>(i));
}

TEST(FastLog2, IsBoundedWithoutALogarithm) {
  EXPECT_EQ(fastLog2(0.0f), -126.0f);
  EXPECT_EQ(fastLog2(-1.0f), -126.0f);
  EXPECT_EQ(fastLog2(1e-42f), -126.0f);
  EXPECT_TRUE(std::isnan(fastLog2(kNan)));
  EXPECT_TRUE(std::isnan(fastLog2(kInfinity)));
}

TEST(FastRatioToDb, IsWithinItsStatedError) {
  double worst = 0;
  const auto check = [&](float x) {
    const double exact = 10 * std::log10(static_cast<double>(x));
    worst = std::max(worst, std::abs(fastRatioToDb(x) - exact) / std::max(4.0, std::abs(exact)));
  };
  sweep(-126.0, 127.99, 2000003,
        [&](float e) { check(static_cast<float>(std::exp2(static_cast<double>(e)))); });
  sweep(0.4, 2.5, 2000003, check);
  EXPECT_LT(worst, 1e-7);
  EXPECT_NEAR(fastRatioToDb(0.0f), -379.3f, 0.01f);
}

TEST(FastAtan2, IsWithinItsStatedErrorInAllQuadrants) {
  double worst = 0;
  for (const double radius : {1e-30, 1e-3, 1.0, 1e30}) {
    sweep(-3.14159265, 3.14159265, 500001, [&](float angle) {
      const auto y = static_cast<float>(radius * std::sin(static_cast<double>(angle)));
      const auto x = static_cast<float>(radius * std::cos(static_cast<double>(angle)));
      worst = std::max(
          worst, std::abs(fastAtan2(y, x) - std::atan2(static_cast<double>(y), static_cast<double>(x))));
    });
  }
  EXPECT_LT(worst, 2e-7);
}

TEST(FastAtan2, KeepsItsRelativeAccuracyNearZero) {
  double worst = 0;
  sweep(-20.0, 0.0, 200001, [&](float decades) {
    const auto y = static_cast<float>(std::pow(10.0, static_cast<double>(decades)));
    worst = std::max(worst, std::abs(fastAtan2(y, 1.0f) / std::atan(static_cast<double>(y)) - 1));
  });
  EXPECT_LT(worst, 2e-7);
}

TEST(FastAtan2, IsRightOnTheAxes) {
  EXPECT_EQ(fastAtan2(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(fastAtan2(0.0f, -0.0f), 0.0f);
  EXPECT_EQ(fastAtan2(0.0f, 1.0f), 0.0f);
  EXPECT_FLOAT_EQ(fastAtan2(1.0f, 0.0f), 1.57079633f);
  EXPECT_FLOAT_EQ(fastAtan2(-1.0f, 0.0f), -1.57079633f);
  EXPECT_FLOAT_EQ(fastAtan2(0.0f, -1.0f), 3.14159265f);
  EXPECT_FLOAT_EQ(fastAtan2(-0.0f, -1.0f), -3.14159265f);
  EXPECT_TRUE(std::isnan(fastAtan2(kNan, 1.0f)));
  EXPECT_TRUE(std::isnan(fastAtan2(1.0f, kNan)));
}

TEST(FastAtan2, GivesAnglesOfUnitVectorsNearTheirEnds) {
  // Arc sine would lose half the digits here.
  const double angle = 1e-4;
  const auto y = static_cast<float>(std::cos(angle));
  const auto x = static_cast<float>(std::sin(angle));
  EXPECT_NEAR(fastAtan2(y, x), 1.5707963267948966 - angle, 2e-7);
}

}  // namespace
}  // namespace emscape
