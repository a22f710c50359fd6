#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "emscape/base/units.h"
#include "scenario/antenna/pattern.h"
#include "scenario/antenna/shapes.h"
#include "tests/scenario/antenna_directions.h"
#include "tests/support/errors.h"

namespace emscape::scenario {
namespace {

using testing::HasSubstr;

constexpr double kHalfPower_db = 3.0102999566;

double lossAt_db(const AntennaPtr& antenna, double azimuth_deg, double elevation_deg) {
  return antenna->gain_dbi - gainTowards_dbi(*antenna, towards(azimuth_deg, elevation_deg));
}

/// Directivity (dBi): 4 pi over the integral of the pattern, over the whole sphere or down to an elevation.
double directivity_dbi(const AntennaPtr& antenna, double step_deg) {
  double integral = 0;
  for (double elevation_deg = -90 + step_deg / 2; elevation_deg < 90; elevation_deg += step_deg) {
    double row = 0;
    for (double azimuth_deg = -180 + step_deg / 2; azimuth_deg < 180; azimuth_deg += step_deg) {
      const double amplitude = antenna->amplitudeTowards(towards(azimuth_deg, elevation_deg), 0, 0);
      row += amplitude * amplitude;
    }
    integral += row * std::cos(degToRad(elevation_deg));
  }
  return ratioToDb(4 * kPi / (integral * degToRad(step_deg) * degToRad(step_deg)));
}

/// Largest difference (dB) between the loops' float pattern and the double one within 40 dB of the maximum,
/// over a fine raster of directions in front and a coarse one all round.
double worstOfView_db(const AntennaPtr& antenna, double az_range_deg, double el_range_deg, double steer_u = 0,
                      double steer_v = 0) {
  const PatternView view = antenna->view();
  double worst = 0;
  const auto check = [&](double azimuth_deg, double elevation_deg) {
    const Vec3f direction = vecCast<float>(towards(azimuth_deg, elevation_deg));
    // The direction as rounded in the loops: the rounding of its components is not an error of the pattern.
    const double exact = antenna->amplitudeTowards(vecCast<double>(direction), steer_u, steer_v);
    if (exact < 0.01) return;
    const double got = patternAmplitude(view, direction, float(steer_u), float(steer_v));
    worst = std::max(worst, std::abs(20 * std::log10(got / exact)));
  };
  constexpr int kSteps = 600;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; j += 7) {
      check(az_range_deg * i / kSteps, el_range_deg * j / kSteps);
      check(az_range_deg * j / kSteps, el_range_deg * i / kSteps);
    }
  }
  for (double azimuth_deg = -180; azimuth_deg <= 180; azimuth_deg += 1.7) {
    for (double elevation_deg = -90; elevation_deg <= 90; elevation_deg += 1.3)
      check(azimuth_deg, elevation_deg);
  }
  return worst;
}

void expectError(const std::function<void()>& action, const std::string& part) {
  EXPECT_THAT(test::errorOf(action, ErrorCode::bad_input), HasSubstr(part));
}

TEST(IsotropicAntenna, HasItsGainEverywhere) {
  const AntennaPtr antenna = makeIsotropic(2.15);
  for (const double azimuth_deg : {-180.0, -30.0, 0.0, 120.0}) {
    for (const double elevation_deg : {-90.0, 0.0, 45.0, 90.0}) {
      EXPECT_DOUBLE_EQ(gainTowards_dbi(*antenna, towards(azimuth_deg, elevation_deg)), 2.15);
    }
  }
  EXPECT_EQ(patternAmplitude(antenna->view(), {-1, 0, 0}, 0, 0), 1.0f);
  EXPECT_EQ(antenna->apertureDimension_m(0.1), 0.0);
}

TEST(GaussianBeam, IsHalfPowerAtHalfItsBeamwidths) {
  const AntennaPtr antenna = makeGaussian(34, 1.6, 4, -60);
  EXPECT_DOUBLE_EQ(gainTowards_dbi(*antenna, {1, 0, 0}), 34);
  EXPECT_NEAR(lossAt_db(antenna, 0.8, 0), kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, -0.8, 0), kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0, 2), kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0, -2), kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0.8, 2), 2 * kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 1.6, 0), 4 * kHalfPower_db, 1e-9);
}

TEST(GaussianBeam, DoesNotFallBelowItsSideLobes) {
  const AntennaPtr antenna = makeGaussian(30, 2, 2, -35);
  for (const double azimuth_deg : {10.0, 90.0, 180.0, -90.0})
    EXPECT_NEAR(lossAt_db(antenna, azimuth_deg, 0), 35, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0, 90), 35, 1e-9);
}

TEST(GaussianBeam, FullWidthIsEqualInEveryAzimuth) {
  const AntennaPtr antenna = makeGaussian(8, 360, 20, -30);
  EXPECT_DOUBLE_EQ(lossAt_db(antenna, 180, 0), 0);
  EXPECT_NEAR(lossAt_db(antenna, 135, 10), kHalfPower_db, 1e-9);
}

TEST(GaussianBeam, GainInLoopsIsWithin1e4DbOfClosedForm) {
  for (const double width_deg : {1.0, 1.6, 5.0, 40.0, 120.0}) {
    EXPECT_LT(worstOfView_db(makeGaussian(30, width_deg, width_deg, -80), 2 * width_deg,
                             std::min(2 * width_deg, 90.0)),
              1e-4)
        << width_deg;
  }
  EXPECT_LT(worstOfView_db(makeGaussian(30, 1, 60, -80), 2, 90), 1e-4);
}

TEST(SincPattern, IsHalfPowerAtHalfItsBeamwidths) {
  for (const double width_deg : {1.0, 10.0, 65.0, 120.0}) {
    const AntennaPtr antenna = makeSinc(30, width_deg, width_deg / 2, -50);
    EXPECT_NEAR(lossAt_db(antenna, width_deg / 2, 0), kHalfPower_db, 1e-9);
    EXPECT_NEAR(lossAt_db(antenna, -width_deg / 2, 0), kHalfPower_db, 1e-9);
    EXPECT_NEAR(lossAt_db(antenna, 0, width_deg / 4), kHalfPower_db, 1e-9);
  }
}

TEST(SincPattern, HasTheNullsAndSideLobesOfAnEvenlyLitAperture) {
  // Side D = 20 wavelengths: nulls at sin(angle) = n / 20, first side lobe -13.26 dB near 1.43 / 20.
  const double width_deg = 2 * radToDeg(std::asin(1.3915573782515103 / (kPi * 20)));
  const AntennaPtr antenna = makeSinc(36, width_deg, width_deg, -200);
  for (int n = 1; n <= 5; ++n) EXPECT_GT(lossAt_db(antenna, radToDeg(std::asin(n / 20.0)), 0), 150) << n;
  double highest_db = -100;
  for (double u = 1.0 / 20; u < 2.0 / 20; u += 1e-5) {
    highest_db = std::max(highest_db, -lossAt_db(antenna, radToDeg(std::asin(u)), 0));
  }
  EXPECT_NEAR(highest_db, -13.2615, 1e-3);
  EXPECT_NEAR(antenna->apertureDimension_m(0.1), 2.0, 1e-3);
}

TEST(SincPattern, DoesNotFallBelowItsSideLobeLevelInItsNullsOrBehind) {
  const AntennaPtr antenna = makeSinc(36, 3, 3, -45);
  EXPECT_NEAR(lossAt_db(antenna, 180, 0), 45, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 120, 30), 45, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 25, 25), 45, 1e-9);
  const double first_null_deg = radToDeg(std::asin(std::sin(degToRad(1.5)) / 0.4429464695));
  EXPECT_NEAR(lossAt_db(antenna, first_null_deg, 0), 45, 1e-9);
  const Vec3f null = vecCast<float>(towards(first_null_deg, 0));
  EXPECT_FLOAT_EQ(patternAmplitude(antenna->view(), null, 0, 0), std::pow(10.0f, -45 / 20.0f));
}

TEST(SincPattern, KeepsItsBeamwidthsWithATaperAndTakesALargerAperture) {
  for (const Taper& taper : {Taper(TaperKind::cosine), Taper(TaperKind::taylor, -30)}) {
    const AntennaPtr antenna = makeSinc(36, 2, 5, -60, taper);
    EXPECT_NEAR(lossAt_db(antenna, 1, 0), kHalfPower_db, 1e-9);
    EXPECT_NEAR(lossAt_db(antenna, 0, -2.5), kHalfPower_db, 1e-9);
    EXPECT_NEAR(antenna->apertureDimension_m(0.1), 2 * taper.halfPower() * 0.1 / degToRad(2.0), 1e-9);
    for (double azimuth_deg = 3.5; azimuth_deg < 90; azimuth_deg += 0.01) {
      EXPECT_GT(lossAt_db(antenna, azimuth_deg, 0), 22.9) << azimuth_deg;
    }
    EXPECT_LT(worstOfView_db(antenna, 8, 20), 1e-3);
  }
}

TEST(SincPattern, GainInLoopsIsWithin1e3DbOfClosedForm) {
  for (const double width_deg : {1.0, 2.0, 10.0, 80.0}) {
    EXPECT_LT(
        worstOfView_db(makeSinc(30, width_deg, width_deg, -60), 4 * width_deg, std::min(4 * width_deg, 90.0)),
        1e-3)
        << width_deg;
  }
}

TEST(Cosecant2Pattern, FollowsTheCosecantSquaredLaw) {
  const double nose_deg = 2;
  const AntennaPtr antenna = makeCosecant2(34, 1.6, 2 * nose_deg, 40, -50);
  EXPECT_DOUBLE_EQ(lossAt_db(antenna, 0, 0), 0);
  EXPECT_NEAR(lossAt_db(antenna, 0, -nose_deg), kHalfPower_db, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 0.8, 0), kHalfPower_db, 1e-9);
  for (const double elevation_deg : {2.0, 3.0, 7.5, 20.0, 40.0}) {
    const double law_db =
        kHalfPower_db + 20 * std::log10(std::sin(degToRad(elevation_deg)) / std::sin(degToRad(nose_deg)));
    EXPECT_NEAR(lossAt_db(antenna, 0, elevation_deg), law_db, 1e-9) << elevation_deg;
  }
}

TEST(Cosecant2Pattern, GivesATargetAtConstantHeightConstantPower) {
  const AntennaPtr antenna = makeCosecant2(34, 1.6, 4, 40, -50);
  const auto relative_db = [&](double elevation_deg) {
    const double range = 1 / std::sin(degToRad(elevation_deg));
    return -lossAt_db(antenna, 0, elevation_deg) - 20 * std::log10(range);
  };
  for (const double elevation_deg : {5.0, 12.0, 39.0})
    EXPECT_NEAR(relative_db(elevation_deg), relative_db(3), 1e-9);
}

TEST(Cosecant2Pattern, IsContinuousAndEndsAtTheSideLobeLevel) {
  const AntennaPtr antenna = makeCosecant2(34, 1.6, 4, 40, -50);
  for (const double corner_deg : {2.0, 40.0}) {
    EXPECT_NEAR(lossAt_db(antenna, 0, corner_deg - 1e-7), lossAt_db(antenna, 0, corner_deg + 1e-7), 1e-5);
  }
  EXPECT_LT(lossAt_db(antenna, 0, 40), 30);
  EXPECT_NEAR(lossAt_db(antenna, 0, 60), 50, 1e-9);
  EXPECT_NEAR(lossAt_db(antenna, 180, 10), 50, 1e-9);
}

TEST(Cosecant2Pattern, GainInLoopsIsWithinStatedError) {
  EXPECT_LT(worstOfView_db(makeCosecant2(34, 1, 1, 40, -60), 2, 45), 3e-3);
  EXPECT_LT(worstOfView_db(makeCosecant2(34, 2.4, 4, 40, -60), 5, 45), 3e-3);
  EXPECT_LT(worstOfView_db(makeCosecant2(20, 360, 20, 90, -60), 180, 90), 3e-3);
}

TEST(PhasedArray, HasTheArrayFactorOfItsElements) {
  const int columns = 16, rows = 12;
  const double spacing = 0.5;
  const AntennaPtr antenna = makePhasedArray(27, columns, rows, spacing, 0);
  const auto factor_db = [&](int elements, double u) {
    const double x = kPi * spacing * u;
    return 20 * std::log10(std::abs(std::sin(elements * x) / (elements * std::sin(x))));
  };
  for (const double angle_deg : {1.0, 3.3, 10.0, 25.0, 70.0}) {
    EXPECT_NEAR(-lossAt_db(antenna, angle_deg, 0), factor_db(columns, std::sin(degToRad(angle_deg))), 1e-9);
    EXPECT_NEAR(-lossAt_db(antenna, 0, angle_deg), factor_db(rows, std::sin(degToRad(angle_deg))), 1e-9);
  }
  EXPECT_GT(lossAt_db(antenna, radToDeg(std::asin(1 / (columns * spacing))), 0), 150);
  // 0.886 lambda / (N d) of the aperture.
  EXPECT_NEAR(antenna->beamwidth_az_deg, radToDeg(0.886 / (columns * spacing)), 0.02);
  EXPECT_NEAR(antenna->apertureDimension_m(0.1), columns * spacing * 0.1, 0.01);
}

TEST(PhasedArray, LosesItsElementsPatternWhenSteered) {
  const AntennaPtr antenna = makePhasedArray(27, 16, 12, 0.5, 0.5);
  for (const double steer_deg : {0.0, 20.0, 45.0, 60.0}) {
    const double gain_dbi = gainTowards_dbi(*antenna, towards(steer_deg, 0), degToRad(steer_deg), 0);
    EXPECT_NEAR(gain_dbi, 27 + 10 * std::log10(std::cos(degToRad(steer_deg))), 1e-9) << steer_deg;
  }
  const double gain_dbi = gainTowards_dbi(*antenna, towards(-30, 20), degToRad(-30.0), degToRad(20.0));
  EXPECT_NEAR(gain_dbi, 27 + 10 * std::log10(std::cos(degToRad(30.0)) * std::cos(degToRad(20.0))), 1e-9);
}

TEST(PhasedArray, HasGratingLobesWhereTheSpacingPutsThem) {
  // Spacing 1 wavelength, steered to u = 0.5: a grating lobe at u = -0.5 as strong as the main lobe.
  const AntennaPtr wide = makePhasedArray(27, 20, 1, 1, 0);
  EXPECT_NEAR(gainTowards_dbi(*wide, towards(-30, 0), degToRad(30.0), 0), 27, 1e-6);
  EXPECT_NEAR(patternAmplitude(wide->view(), vecCast<float>(towards(-30, 0)), 0.5f, 0), 1.0f, 1e-5f);
  // Half a wavelength: none within the visible region.
  const AntennaPtr narrow = makePhasedArray(27, 20, 1, 0.5, 0);
  for (double azimuth_deg = -90; azimuth_deg < 15; azimuth_deg += 0.1) {
    EXPECT_LT(gainTowards_dbi(*narrow, towards(azimuth_deg, 0), degToRad(30.0), 0), 27 - 13);
  }
}

TEST(PhasedArray, DoesNotFallBelowItsErrorFloorInNullsOrBehind) {
  const AntennaPtr antenna = makePhasedArray(27, 16, 12, 0.5, 0.5, -35);
  const auto floor = std::pow(10.0f, -35 / 20.0f);
  const Vec3d null = towards(radToDeg(std::asin(1 / (16 * 0.5))), 0);
  for (const Vec3d& direction : {null, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, towards(100, 40), towards(40, 40)}) {
    EXPECT_NEAR(gainTowards_dbi(*antenna, direction), 27 - 35, 1e-9);
    EXPECT_FLOAT_EQ(patternAmplitude(antenna->view(), vecCast<float>(direction), 0, 0), floor);
  }
  // Steered, the floor stays relative to the maximum of the unsteered array.
  EXPECT_NEAR(gainTowards_dbi(*antenna, {-1, 0, 0}, degToRad(50.0), 0), 27 - 35, 1e-9);
}

TEST(PhasedArray, TaperedHasLowerSideLobesAWiderBeamAndLessGain) {
  const Taper taylor(TaperKind::taylor, -30), cosine(TaperKind::cosine);
  const AntennaPtr even = makePhasedArray(0, 32, 32, 0.5, 0);
  for (const Taper& taper : {taylor, cosine}) {
    const AntennaPtr antenna = makePhasedArray(0, 32, 32, 0.5, 0, -200, taper);
    const double first_null_deg =
        radToDeg(std::asin(taper.kind() == TaperKind::cosine ? 1.5 / 16 : 1.8 / 16));
    double highest_db = -100;
    for (double azimuth_deg = first_null_deg; azimuth_deg < 90; azimuth_deg += 0.01) {
      highest_db = std::max(highest_db, -lossAt_db(antenna, azimuth_deg, 0));
    }
    EXPECT_NEAR(highest_db, taper.kind() == TaperKind::cosine ? -23 : -30, 0.5);
    EXPECT_NEAR(antenna->beamwidth_az_deg / even->beamwidth_az_deg, taper.halfPower() / 0.44294647, 2e-3);
    EXPECT_NEAR(directivity_dbi(antenna, 0.2) - directivity_dbi(even, 0.2),
                20 * std::log10(taper.arrayEfficiency(32)), 0.1);
    EXPECT_NEAR(gainFromArray_dbi(32, 32, 0.5, taper) - gainFromArray_dbi(32, 32, 0.5),
                20 * std::log10(taper.arrayEfficiency(32)), 1e-9);
    EXPECT_LT(worstOfView_db(antenna, 60, 60), 1e-3);
  }
}

TEST(PhasedArray, GainInLoopsIsWithin1e3DbOfClosedForm) {
  EXPECT_LT(worstOfView_db(makePhasedArray(27, 16, 12, 0.5, 0.5), 60, 60), 1e-3);
  EXPECT_LT(worstOfView_db(makePhasedArray(40, 100, 50, 0.5, 1), 4, 8), 1e-3);
  EXPECT_LT(worstOfView_db(makePhasedArray(27, 16, 12, 0.9, 0.5), 80, 80, std::sin(0.5), std::sin(-0.2)),
            1e-3);
  EXPECT_LT(worstOfView_db(makePhasedArray(5, 1, 1, 0.5, 0.5), 89, 89), 1e-3);
}

TEST(AntennaAxes, AzimuthIsClockwiseAndElevationUp) {
  // An array steered right and up has its maximum there.
  const AntennaPtr antenna = makePhasedArray(27, 16, 16, 0.5, 0);
  const double to_right = gainTowards_dbi(*antenna, {std::cos(0.5), std::sin(0.5), 0}, 0.5, 0);
  const double to_left = gainTowards_dbi(*antenna, {std::cos(0.5), -std::sin(0.5), 0}, 0.5, 0);
  EXPECT_NEAR(to_right, 27, 1e-9);
  EXPECT_LT(to_left, 15);
  EXPECT_NEAR(gainTowards_dbi(*antenna, {std::cos(0.5), 0, std::sin(0.5)}, 0, 0.5), 27, 1e-9);
}

TEST(AntennaLoops, GainIsFiniteInEveryDirection) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const AntennaPtr& antenna : {makeGaussian(30, 2, 2, -40), makeCosecant2(30, 2, 2, 30, -40),
                                    makeSinc(30, 2, 2, -40), makePhasedArray(27, 16, 12, 0.5, 0.5)}) {
    const PatternView view = antenna->view();
    for (const Vec3f direction :
         {Vec3f{0, 0, 1}, Vec3f{0, 0, -1}, Vec3f{-1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 0},
          Vec3f{-1, -0.0f, 0}, Vec3f{1.0001f, 0, 0}, Vec3f{0, 0, 1.0001f}}) {
      const float amplitude = patternAmplitude(view, direction, 0, 0);
      EXPECT_GE(amplitude, 0.0f);
      EXPECT_LE(amplitude, 1.001f);
    }
    patternAmplitude(view, {kNan, kNan, kNan}, 0, 0);
    patternAmplitude(view, {1, kNan, 0}, 0, 0);
    patternAmplitude(view, {1e30f, 1e30f, -1e30f}, 0, 0);
  }
}

TEST(GainOfBeamwidths, EqualsPracticalGainOfStutzmanAndThiele) {
  EXPECT_NEAR(gainFromBeamwidths_dbi(1, 1), 44.15, 0.005);
  EXPECT_NEAR(gainFromBeamwidths_dbi(1.6, 4), 36.09, 0.005);
  EXPECT_EQ(gainFromBeamwidths_dbi(360, 180), 0.0);
}

TEST(GainOfBeamwidths, LiesALittleBelowTheDirectivityOfTheShapes) {
  // 26000 allows for losses and side lobes: 1.5 dB against an ideal Gaussian (36400), 1 dB against an even
  // aperture (32400).
  const auto helperBelow_db = [](const AntennaPtr& antenna) {
    return directivity_dbi(antenna, 0.2) -
           gainFromBeamwidths_dbi(antenna->beamwidth_az_deg, antenna->beamwidth_el_deg);
  };
  EXPECT_NEAR(helperBelow_db(makeGaussian(0, 5, 8, -100)), 1.46, 0.05);
  EXPECT_NEAR(helperBelow_db(makeSinc(0, 5, 8, -100)), 0.95, 0.15);
  EXPECT_NEAR(helperBelow_db(makePhasedArray(0, 30, 20, 0.5, 0)), 0.95, 0.2);
}

TEST(GainOfArray, EqualsDirectivityOfItsArea) {
  EXPECT_NEAR(gainFromArray_dbi(16, 12, 0.5), 10 * std::log10(kPi * 16 * 12), 1e-9);
  // With elements of cos^(1/2), whose power falls with the projected area.
  EXPECT_NEAR(directivity_dbi(makePhasedArray(0, 16, 12, 0.5, 0.5), 0.5), gainFromArray_dbi(16, 12, 0.5),
              0.3);
}

TEST(AntennaShapes, RefuseImpossibleShapes) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  expectError([] { makeIsotropic(kNan); }, "gain_dbi is nan dBi; allowed are -100 to 100 dBi");
  expectError([] { makeGaussian(30, 0, 2, -40); }, "beamwidth_az_deg is 0 deg; allowed are 0.001 to 360 deg");
  expectError([] { makeGaussian(30, 2, 181, -40); },
              "beamwidth_el_deg is 181 deg; allowed are 0.001 to 180 deg");
  expectError([] { makeGaussian(30, 2, 2, 3); }, "side_lobe_db is 3 dB; allowed are -200 to 0 dB");
  expectError([] { makeSinc(30, 200, 2, -40); }, "beamwidth_az_deg of a sinc pattern is 200 deg");
  expectError([] { makeCosecant2(30, 2, 10, 4, -40); },
              "max_elevation_deg is 4 deg; allowed are 5 to 90 deg");
  expectError([] { makePhasedArray(30, 0, 8, 0.5, 1); },
              "columns is 0 elements; allowed are 1 to 1024 elements");
  expectError([] { makePhasedArray(30, 8, 8, 2, 1); }, "spacing_wavelengths is 2 wavelengths");
}

}  // namespace
}  // namespace emscape::scenario
