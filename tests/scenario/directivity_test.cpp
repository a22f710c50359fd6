
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"
#include "scenario/antenna/shapes.h"
#include "tests/scenario/antenna_directions.h"
#include "tests/support/files.h"

namespace emscape::scenario {
namespace {

TEST(Directivity, IsotropicAntennaHasOne) {
  EXPECT_DOUBLE_EQ(makeIsotropic(0)->directivity_dbi(), 0);
}

TEST(Directivity, NarrowGaussianBeamEqualsClosedForm) {
  // The power is exp(-4 ln 2 (angle / beamwidth)^2): its integral is pi / (4 ln 2) times the beamwidths.
  for (const double width_deg : {0.3, 1.0, 3.0}) {
    const double width_rad = degToRad(width_deg);
    const double expected = ratioToDb(16 * std::log(2.0) / (width_rad * 2 * width_rad));
    EXPECT_NEAR(makeGaussian(0, width_deg, 2 * width_deg, -200)->directivity_dbi(), expected, 0.01)
        << width_deg;
  }
}

TEST(Directivity, CountsTheSideLobesThatABeamDoesNotFallBelow) {
  // Around 2 x 2 degrees: the beam's own part, down to the floor, and the floor everywhere else.
  const double width_rad = degToRad(2.0), floor = 0.01;
  const double disc_sr = kPi * -std::log(floor) * width_rad * width_rad / (4 * std::log(2.0));
  const double beam_sr = kPi * width_rad * width_rad / (4 * std::log(2.0)) * (1 - floor);
  const double expected = ratioToDb(4 * kPi / (beam_sr + floor * (4 * kPi - disc_sr)));
  EXPECT_NEAR(expected, 19.96, 0.01);
  EXPECT_NEAR(makeGaussian(0, 2, 2, -20)->directivity_dbi(), expected, 0.01);
}

TEST(Directivity, ElementEqualsItsCosinePattern) {
  // cos^(2q) over the half space in front: 2 (2 q + 1).
  for (const double q : {0.0, 0.5, 1.0, 2.0}) {
    EXPECT_NEAR(makePhasedArray(0, 1, 1, 0.5, q)->directivity_dbi(), ratioToDb(2 * (2 * q + 1)), 0.01) << q;
  }
}

TEST(Directivity, HalfWavelengthLineArrayEqualsNumberOfElements) {
  // N elements at half a wavelength: N into the whole space, twice that into the half space in front.
  for (const int count : {2, 5, 16, 64, 256}) {
    EXPECT_NEAR(makePhasedArray(0, count, 1, 0.5, 0)->directivity_dbi(), ratioToDb(2.0 * count), 0.02)
        << count;
    EXPECT_NEAR(makePhasedArray(0, 1, count, 0.5, 0)->directivity_dbi(), ratioToDb(2.0 * count), 0.02)
        << count;
  }
}

TEST(Directivity, LargeApertureEqualsDirectivityOfItsArea) {
  // 4 pi A / lambda^2 with A from the sides at which the half-power points are at half the beamwidths.
  for (const Taper& taper :
       {Taper(TaperKind::uniform), Taper(TaperKind::cosine), Taper(TaperKind::taylor, -30)}) {
    const double side = taper.halfPower() / std::sin(degToRad(0.5));
    const double efficiency = taper.arrayEfficiency(4000);
    EXPECT_NEAR(makeSinc(0, 1, 1, -200, taper)->directivity_dbi(),
                ratioToDb(4 * kPi * side * side * efficiency * efficiency), 0.1);
    // The elements' cosine^(1/2) takes the difference between area and projected area.
    EXPECT_NEAR(makePhasedArray(0, 64, 64, 0.5, 0.5, -200, taper)->directivity_dbi(),
                gainFromArray_dbi(64, 64, 0.5, taper), 0.05);
  }
}

TEST(Directivity, ErrorFloorOfArrayCounts) {
  // With a floor above its side lobes the array holds the floor nearly everywhere.
  const double peak = dbToRatio(gainFromArray_dbi(64, 64, 0.5));
  const double expected = ratioToDb(1 / (1 / peak + dbToRatio(-30)));
  EXPECT_NEAR(makePhasedArray(0, 64, 64, 0.5, 0.5, -30)->directivity_dbi(), expected, 0.15);
}

TEST(Directivity, TablesEqualPlainSum) {
  for (const AntennaPtr& antenna :
       {makeCosecant2(0, 3, 4, 40, -45), readAntenna(test::shippedScenario("data/sector_450mhz.msi"))}) {
    double integral = 0;
    constexpr double kStep_deg = 0.2;
    for (double elevation_deg = -90 + kStep_deg / 2; elevation_deg < 90; elevation_deg += kStep_deg) {
      for (double azimuth_deg = -180 + kStep_deg / 2; azimuth_deg < 180; azimuth_deg += kStep_deg) {
        const double amplitude = antenna->amplitudeTowards(towards(azimuth_deg, elevation_deg), 0, 0);
        integral += amplitude * amplitude * std::cos(degToRad(elevation_deg));
      }
    }
    EXPECT_NEAR(antenna->directivity_dbi(),
                ratioToDb(4 * kPi / (integral * degToRad(kStep_deg) * degToRad(kStep_deg))), 0.01)
        << antenna->description;
  }
}

}  // namespace
}  // namespace emscape::scenario
