#include "render/cells/integral/psi.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace emscape::render {
namespace {

/// Psi by Simpson's rule.
double integrated(double back, double front) {
  constexpr int kParts = 20000;
  const auto at = [&](int n) {
    const double x = static_cast<double>(n) / kParts;
    return std::exp(-x * (front + 0.5 * (back - front) * x));
  };
  double sum = at(0) + at(kParts);
  for (int n = 1; n < kParts; ++n) sum += (n % 2 == 1 ? 4 : 2) * at(n);
  return sum / (3 * kParts);
}

TEST(Psi, ScaledErfcAndDawsonEqualTables) {
  // Abramowitz and Stegun, Handbook of Mathematical Functions, tables 7.1 and 7.5, and NIST DLMF 7.
  EXPECT_NEAR(scaledErfc(0), 1, 1e-15);
  EXPECT_NEAR(scaledErfc(1), 0.42758357615580700, 1e-15);
  EXPECT_NEAR(scaledErfc(10), 0.05614099274382259, 1e-16);
  EXPECT_NEAR(scaledErfc(1e8), 1e-8 / std::sqrt(std::acos(-1.0)), 1e-22);
  EXPECT_NEAR(dawson(1), 0.53807950691276841, 1e-15);
  EXPECT_NEAR(dawson(0.9241388730), 0.54104422463518170, 1e-15);
  EXPECT_NEAR(dawson(10), 0.05025384718759853, 1e-15);
  EXPECT_NEAR(dawson(1e8), 0.5e-8, 1e-22);
  // Both forms agree where one ends.
  for (const double x : {4.999999, 5.000001}) {
    EXPECT_NEAR(scaledErfc(x) * x * std::sqrt(std::acos(-1.0)), 0.98109, 1e-4);
  }
  EXPECT_NEAR(scaledErfc(5 - 1e-9) / scaledErfc(5 + 1e-9), 1, 1e-9);
  EXPECT_NEAR(dawson(7 - 1e-9) / dawson(7 + 1e-9), 1, 1e-9);
}

TEST(Psi, EqualsIntegralForEqualNearlyEqualAndUnequalEnds) {
  for (const double back : {0.0, 1e-6, 0.01, 0.3, 0.99, 1.01, 3.0, 20.0, 300.0}) {
    for (const double front : {0.0, 1e-6, 0.01, 0.3, 0.99, 1.01, 3.0, 20.0, 300.0}) {
      EXPECT_NEAR(psi(back, front), integrated(back, front), 1e-11) << back << ", " << front;
    }
    for (const double apart : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
      EXPECT_NEAR(psi(back, back * (1 + apart)), integrated(back, back * (1 + apart)), 1e-11);
      EXPECT_NEAR(psi(back * (1 + apart), back), integrated(back * (1 + apart), back), 1e-11);
    }
  }
  EXPECT_NEAR(psi(0, 0), 1, 1e-15);
  EXPECT_NEAR(psi(2, 2), (1 - std::exp(-2)) / 2, 1e-15);
}

TEST(PsiTable, BilinearInterpolationErrsByLessThan5e6) {
  const PsiLookup table = PsiTable::shared().lookup();
  const auto gamma = [](double depth) { return depth / (1 + depth); };
  double bilinear = 0, floor = 0, all = 0;
  constexpr int kSteps = 700;
  const double most = gamma(PsiLookup::kMaxDepth);
  constexpr int kLast = PsiLookup::kEntries - 1;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x = most * i / kSteps, y = most * j / kSteps;
      const double exact = psi(x / (1 - x), y / (1 - y));
      const double low = table.interpolated(std::floor(x * kLast) / kLast, std::floor(y * kLast) / kLast);
      bilinear = std::max(bilinear, std::abs(table.interpolated(x, y) - exact));
      floor = std::max(floor, std::abs(low - exact));
    }
  }
  for (int j = 0; j < 300; ++j) {
    for (int i = 0; i < 300; ++i) {
      const double back = std::exp(0.07 * (i - 200)), front = std::exp(0.07 * (j - 200));
      all = std::max(all, std::abs(table(back, front) - psi(back, front)));
    }
  }
  RecordProperty("bilinear", std::to_string(bilinear));
  std::printf("Psi table of 512 x 512, tau D <= 8: bilinear errs by %.2g, floor by %.2g; all depths %.2g\n",
              bilinear, floor, all);
  EXPECT_LT(bilinear, 5e-6);
  EXPECT_GT(floor, 1e-3);
  EXPECT_LT(floor, 5e-3);
  EXPECT_LT(all, 5e-6);
}

}  // namespace
}  // namespace emscape::render
