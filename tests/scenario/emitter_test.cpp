#include "emscape/scenario/model/emitter.h"

#include <gtest/gtest.h>

#include <limits>

#include "emscape/base/units.h"

namespace emscape::scenario {
namespace {

using namespace propagation;

constexpr double kIdeal = std::numeric_limits<double>::infinity();

constexpr Polarization kAll[] = {Polarization::horizontal,     Polarization::vertical,
                                 Polarization::slant_45,       Polarization::slant_135,
                                 Polarization::circular_right, Polarization::circular_left};

TEST(PolarizationFactor, IsOneForEqualAndZeroForOrthogonal) {
  for (const Polarization p : kAll) EXPECT_DOUBLE_EQ(polarizationFactor(p, p, kIdeal), 1);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::horizontal, Polarization::vertical, kIdeal), 0);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::slant_45, Polarization::slant_135, kIdeal), 0);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::circular_right, Polarization::circular_left, kIdeal), 0);
}

TEST(PolarizationFactor, IsHalfBetweenFamilies) {
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::horizontal, Polarization::slant_45), 0.5);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::circular_right, Polarization::vertical), 0.5);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::slant_135, Polarization::circular_left), 0.5);
}

TEST(PolarizationFactor, IsSymmetricAndWhole) {
  for (const Polarization a : kAll) {
    for (const Polarization b : kAll) EXPECT_DOUBLE_EQ(polarizationFactor(a, b), polarizationFactor(b, a));
    // Two orthogonal receivers together take all.
    EXPECT_DOUBLE_EQ(polarizationFactor(a, Polarization::horizontal, kIdeal) +
                         polarizationFactor(a, Polarization::vertical, kIdeal),
                     1);
    EXPECT_DOUBLE_EQ(polarizationFactor(a, Polarization::circular_left, kIdeal) +
                         polarizationFactor(a, Polarization::circular_right, kIdeal),
                     1);
  }
}

TEST(PolarizationFactor, EqualsTableInDocumentation) {
  // docs/models.md, in dB: rows transmit, columns receive, in the order of the enumeration.
  constexpr double kTable_db[6][6] = {{0, 25, 3.01, 3.01, 3.01, 3.01}, {25, 0, 3.01, 3.01, 3.01, 3.01},
                                      {3.01, 3.01, 0, 25, 3.01, 3.01}, {3.01, 3.01, 25, 0, 3.01, 3.01},
                                      {3.01, 3.01, 3.01, 3.01, 0, 25}, {3.01, 3.01, 3.01, 3.01, 25, 0}};
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 6; ++b) {
      EXPECT_NEAR(-ratioToDb(polarizationFactor(kAll[a], kAll[b])), kTable_db[a][b], 0.001);
    }
  }
}

TEST(PolarizationFactor, IsAtLeastTheIsolation) {
  EXPECT_NEAR(polarizationFactor(Polarization::horizontal, Polarization::vertical, 30), 1e-3, 1e-12);
  EXPECT_NEAR(polarizationFactor(Polarization::horizontal, Polarization::slant_45, 30), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::horizontal, Polarization::vertical, 0), 1);
}

}  // namespace
}  // namespace emscape::scenario
