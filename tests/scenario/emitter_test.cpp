#include "scenario/emitter.h"

#include <gtest/gtest.h>

namespace emscape::scenario {
namespace {

constexpr Polarization kAll[] = {Polarization::horizontal,     Polarization::vertical,
                                 Polarization::slant_45,       Polarization::slant_135,
                                 Polarization::circular_right, Polarization::circular_left};

TEST(PolarizationFactor, IsOneForEqualAndNothingForOrthogonalOnes) {
  for (const Polarization p : kAll) EXPECT_DOUBLE_EQ(polarizationFactor(p, p), 1);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::horizontal, Polarization::vertical), 0);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::slant_45, Polarization::slant_135), 0);
  EXPECT_DOUBLE_EQ(polarizationFactor(Polarization::circular_right, Polarization::circular_left), 0);
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
    EXPECT_DOUBLE_EQ(
        polarizationFactor(a, Polarization::horizontal) + polarizationFactor(a, Polarization::vertical), 1);
    EXPECT_DOUBLE_EQ(polarizationFactor(a, Polarization::circular_left) +
                         polarizationFactor(a, Polarization::circular_right),
                     1);
  }
}

}  // namespace
}  // namespace emscape::scenario
