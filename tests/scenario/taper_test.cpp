#include "scenario/antenna/taper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "emscape/base/units.h"
#include "tests/support/errors.h"

namespace emscape::scenario {
namespace {

/// Levels (dB) of the side lobes of a continuous aperture, in their order, up to u_end.
std::vector<double> sideLobes_db(const Taper& taper, double u_end) {
  std::vector<double> levels_db;
  constexpr double kStep = 1e-4;
  double before = std::abs(taper.pattern(0)), now = std::abs(taper.pattern(kStep));
  for (double u = 2 * kStep; u < u_end; u += kStep) {
    const double next = std::abs(taper.pattern(u));
    if (now > before && now > next) levels_db.push_back(20 * std::log10(now));
    before = std::exchange(now, next);
  }
  return levels_db;
}

/// Numerical pattern of a distribution w(x) over x = -1/2..1/2.
template <class Weight>
double fourierOf(const Weight& weight, double u) {
  constexpr int kCount = 4000;
  double sum = 0, total = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = (i + 0.5) / kCount - 0.5;
    sum += weight(x) * std::cos(2 * kPi * u * x);
    total += weight(x);
  }
  return sum / total;
}

TEST(Taper, UniformAndCosineHaveTheFiguresOfBalanisTable12_1) {
  const Taper uniform(TaperKind::uniform), cosine(TaperKind::cosine);
  EXPECT_NEAR(2 * uniform.halfPower(), 0.8859, 1e-4);  // 50.8 deg lambda / D
  EXPECT_NEAR(sideLobes_db(uniform, 4).front(), -13.26, 0.01);
  EXPECT_NEAR(2 * cosine.halfPower(), 1.1890, 1e-4);  // 68.1 deg lambda / D
  EXPECT_NEAR(sideLobes_db(cosine, 4).front(), -23.0, 0.05);
  EXPECT_NEAR(cosine.arrayEfficiency(1000), 8 / (kPi * kPi), 1e-5);
  EXPECT_DOUBLE_EQ(uniform.arrayEfficiency(17), 1);
}

TEST(Taper, CosineEqualsFourierTransformOfItsDistribution) {
  const Taper cosine(TaperKind::cosine);
  for (const double u : {0.0, 0.3, 0.5, 1.0, 1.5, 3.7}) {
    EXPECT_NEAR(cosine.pattern(u), fourierOf([](double x) { return std::cos(kPi * x); }, u), 1e-6) << u;
  }
}

TEST(Taper, TaylorHasItsDesignSideLobesAndFallingOnesBeyond) {
  for (const double level_db : {-20.0, -30.0, -35.0, -40.0, -50.0}) {
    const Taper taylor(TaperKind::taylor, level_db);
    const std::vector<double> lobes_db = sideLobes_db(taylor, 40);
    EXPECT_NEAR(lobes_db.front(), level_db, 0.7) << level_db;
    for (std::size_t i = 1; i < lobes_db.size(); ++i) EXPECT_LT(lobes_db[i], lobes_db[i - 1] + 1e-3);
    // Beyond n-bar as those of even lighting, by 1 / u.
    EXPECT_NEAR(lobes_db[30] - lobes_db[15], 20 * std::log10(17.0 / 32), 0.3);
  }
}

TEST(Taper, TaylorsNullsAreWhereTheDesignPutsThem) {
  // 30 dB, n-bar 4: sigma sqrt(A^2 + (n - 1/2)^2) with A = arcosh(10^1.5) / pi, then the whole numbers.
  const Taper taylor(TaperKind::taylor, -30);
  const double a = std::acosh(std::pow(10.0, 1.5)) / kPi;
  const double sigma = 4 / std::sqrt(a * a + 3.5 * 3.5);
  for (int n = 1; n < 4; ++n) {
    EXPECT_NEAR(taylor.pattern(sigma * std::sqrt(a * a + (n - 0.5) * (n - 0.5))), 0, 1e-12) << n;
  }
  for (int n = 4; n < 9; ++n) EXPECT_NEAR(taylor.pattern(n), 0, 1e-12) << n;
}

TEST(Taper, ArrayEqualsSumOverElements) {
  for (const Taper& taper : {Taper(TaperKind::cosine), Taper(TaperKind::taylor, -35)}) {
    const double a = std::acosh(std::pow(10.0, 35 / 20.0)) / kPi;
    for (const int count : {1, 2, 7, 32}) {
      // Taylor's distribution from its harmonics, found here from the pattern at the whole numbers.
      const auto weight = [&](double x) {
        if (taper.kind() == TaperKind::cosine) return std::cos(kPi * x);
        double sum = 1;
        for (int m = 1; m < static_cast<int>(std::ceil(2 * a * a + 0.5)); ++m) {
          sum += 2 * taper.pattern(m) * std::cos(2 * kPi * m * x);
        }
        return sum;
      };
      for (const double phase : {0.0, 0.01, 0.37, 1.4, 3.0}) {
        double sum = 0, total = 0, squares = 0;
        for (int i = 0; i < count; ++i) {
          const double place = i - (count - 1) / 2.0;
          const double w = weight(place / count);
          sum += w * std::cos(2 * phase * place);
          total += w;
          squares += w * w;
        }
        EXPECT_NEAR(taper.arrayPattern(count, phase), sum / total, 1e-9) << count << " " << phase;
        EXPECT_NEAR(taper.arrayEfficiency(count), total * total / (count * squares), 1e-12);
      }
    }
  }
}

TEST(Taper, RefusesALevelOutsideTaylorsRange) {
  EXPECT_THAT(test::errorOf([] { Taper(TaperKind::taylor, -10); }, ErrorCode::bad_input),
              testing::HasSubstr("taper_side_lobe_db is -10 dB; allowed are -60 to -15 dB"));
}

}  // namespace
}  // namespace emscape::scenario
