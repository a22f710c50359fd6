// Rain's specific attenuation.
#include "propagation/air/rain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"

namespace emscape::propagation {
namespace {

TEST(Rain, MeetsThePublishedCoefficients) {
  // P.838-3 table 5
  const struct {
    double f_ghz, k_h, alpha_h, k_v, alpha_v;
  } rows[] = {{1, 0.0000259, 0.9691, 0.0000308, 0.8592},
              {10, 0.01217, 1.2571, 0.01129, 1.2156},
              {30, 0.2403, 0.9485, 0.2291, 0.9129},
              {100, 1.3671, 0.6815, 1.3680, 0.6765}};
  for (const auto& row : rows) {
    const auto horizontal = rainCoefficients(row.f_ghz * 1e9, 0, 0);
    const auto vertical = rainCoefficients(row.f_ghz * 1e9, 0, kPi / 2);
    EXPECT_NEAR(horizontal.k / row.k_h, 1, 2e-3) << row.f_ghz;
    EXPECT_NEAR(horizontal.alpha, row.alpha_h, 6e-5) << row.f_ghz;
    EXPECT_NEAR(vertical.k / row.k_v, 1, 2e-3) << row.f_ghz;
    EXPECT_NEAR(vertical.alpha, row.alpha_v, 6e-5) << row.f_ghz;
  }
}

TEST(Rain, SeesNoPolarizationFromAbove) {
  const auto a = rainCoefficients(2e10, kPi / 2, 0), b = rainCoefficients(2e10, kPi / 2, kPi / 2);
  EXPECT_NEAR(a.k, b.k, 1e-15);
  EXPECT_NEAR(a.alpha, b.alpha, 1e-14);
}

TEST(Rain, NoRainHasNoAttenuation) {
  EXPECT_EQ(rainCoefficients(1e10, 0, 0).specificAttenuation_db_per_km(0), 0);
}

TEST(Rain, FrequencyOutsideLimitsTakesNearestLimit) {
  EXPECT_EQ(rainCoefficients(1e8, 0, 0).k, rainCoefficients(1e9, 0, 0).k);
  EXPECT_EQ(rainCoefficients(2e12, 0, 0).k, rainCoefficients(1e12, 0, 0).k);
}

TEST(Rain, FloatIsCloseToDouble) {
  double worst = 0;
  for (double f = 1e9; f < 1e12; f *= 1.3) {
    const auto rain = rainCoefficients(f, 0.2, 0.4);
    const RainCoefficients<float> single{float(rain.k), float(rain.alpha)};
    for (double rate = 0.1; rate < 300; rate *= 1.7) {
      const double gamma = rain.specificAttenuation_db_per_km(rate);
      worst = std::max(worst, std::abs(single.specificAttenuation_db_per_km(float(rate)) - gamma) / gamma);
    }
  }
  EXPECT_LT(worst, 1e-5);
}

}  // namespace
}  // namespace emscape::propagation
