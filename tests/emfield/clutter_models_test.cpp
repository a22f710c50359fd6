// Reflectivity of land, sea and rain, filters against clutter, and the beams that see it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emfield/channels/radar_clutter.h"
#include "emfield/check/reference_check.h"
#include "emfield/clutter/mti.h"
#include "emfield/clutter/reflectivity.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/reference_data.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::MtiKind;

TEST(ClutterReference, AgreesWithThePublishedFigures) {
  for (const char* name : {"radar/sea_clutter_nathanson.csv", "radar/clutter_worked_examples.csv"}) {
    const auto file = test::referenceFile(std::string("reference/") + name);
    ASSERT_TRUE(file) << name;
    const auto& all = referenceDatasets();
    const auto row = std::find_if(all.begin(), all.end(), [&](const auto& set) { return set.name == name; });
    ASSERT_NE(row, all.end());
    const DatasetCheck check = row->check(*file);
    EXPECT_GT(check.cases, 10);
    for (const FigureCheck& figure : check.figures)
      EXPECT_TRUE(figure.pass()) << name << ": " << figure.figure << " off by " << figure.max_abs_error;
  }
}

TEST(Reflectivity, LandEqualsGammaTimesSine) {
  SurfaceEcho surface;
  surface.has_land = true;
  surface.gamma = dbToRatio(scenario::landGammaDb(scenario::LandKind::woods, 10e9));
  EXPECT_NEAR(surface.reflectivity({false, surface.gamma}, 0.5), dbToRatio(-15) / 2, 1e-12);
  EXPECT_EQ(surface.reflectivity({false, surface.gamma}, -0.1), 0) << "a slope that is turned away";
  EXPECT_NEAR(scenario::landGammaDb(scenario::LandKind::flatland, 1e9), -25, 1e-12);
}

TEST(Clutter, OfAClassOfTheLandCoverIsThatOfItsKindAndOfWaterThatOfTheSea) {
  SurfaceEcho surface;
  surface.has_land = true;
  surface.gamma = 0.5;
  surface.gamma_of_kind[static_cast<int>(scenario::LandKind::urban)] = 2;
  const scenario::CoverValues city{true, 15, scenario::CoverZone::land,
                                   static_cast<int>(scenario::LandKind::urban)};
  const scenario::CoverValues other{true, 0, scenario::CoverZone::land, -1};
  const scenario::CoverValues lake{true, 0, scenario::CoverZone::water, -1};
  EXPECT_EQ(surface.faceOn(city).gamma, 0.5) << "a stated gamma stays";
  surface.by_cover = true;
  EXPECT_EQ(surface.faceOn(city).gamma, 2);
  EXPECT_EQ(surface.faceOn(other).gamma, 0.5);
  EXPECT_EQ(surface.reflectivity(surface.faceOn(lake), 0.1), 0) << "no sea_state: no echo";
  EXPECT_TRUE(surface.faceOn(lake).is_sea);
}

TEST(Reflectivity, RainEqualsRayleighFormula) {
  // eta = 7e-48 f^4 r^1.6 with f in Hz, Skolnik eq. (13.18) to its one digit: 7 f^4 r^1.6 10^-12, f in GHz
  EXPECT_NEAR(rainReflectivity_m2_m3(4, 3e9) / (7e-12 * 81 * std::pow(4, 1.6)), 1, 0.02);
  EXPECT_EQ(rainReflectivity_m2_m3(0, 3e9), 0);
}

MtiFilter filterOf(MtiKind kind, int pulses) {
  MtiFilter filter;
  filter.mti.kind = kind;
  filter.mti.pulses = pulses;
  filter.prf_hz = 1000;
  filter.frequency_hz = 3e9;
  return filter;
}

TEST(Filter, OfACancellerIsBlindAtMultiplesOfTheBlindSpeed) {
  for (int pulses = 2; pulses <= 5; ++pulses) {
    const MtiFilter filter = filterOf(MtiKind::canceller, pulses);
    const double blind_mps = wavelength_m(3e9) * 1000 / 2;
    double sum = 0;
    for (int n = 0; n < 1000; ++n) sum += filter.response(n * blind_mps / 1000) / 1000;
    EXPECT_NEAR(sum, 1, 1e-9) << "mean of all speeds";
    for (int n = -2; n <= 2; ++n) EXPECT_NEAR(filter.response(n * blind_mps), 0, 1e-20);
    EXPECT_EQ(filter.response(std::nullopt), 1);
  }
  EXPECT_NEAR(filterOf(MtiKind::canceller, 2).response(wavelength_m(3e9) * 250), 2, 1e-9);
}

TEST(Filter, OfPulseDopplerRejectsClutterButNotAtABlindSpeed) {
  MtiFilter filter = filterOf(MtiKind::pulse_doppler, 32);
  const double blind_mps = wavelength_m(3e9) * 1000 / 2;
  EXPECT_NEAR(filter.improvement(0.01, blind_mps), 1, 1e-3) << "the target is in the clutter's filter";
  EXPECT_GT(ratioToDb(filter.improvement(0.01, blind_mps / 2)), 90) << "the window's side lobes, -92 dB";
  EXPECT_EQ(filter.improvement(0.01, std::nullopt), filter.improvement(0.01, blind_mps / 2));
  // clutter as wide as white noise: the window's gain over it, N / 2.0 for Blackman-Harris
  EXPECT_NEAR(filter.improvement(1000, 10), 32 / 2.0, 0.1);
}

TEST(Filter, IsLimitedByTheRadarsStability) {
  MtiFilter filter = filterOf(MtiKind::canceller, 3);
  EXPECT_TRUE(std::isinf(filter.improvement(0, std::nullopt)));
  filter.mti.improvement_limit_db = 45;
  EXPECT_NEAR(ratioToDb(filter.improvement(0, std::nullopt)), 45, 1e-9);
  const double alone = filterOf(MtiKind::canceller, 3).improvement(0.5, std::nullopt);
  EXPECT_NEAR(filter.improvement(0.5, std::nullopt), 1 / (1 / alone + dbToRatio(-45)), 1e-6);
}

TEST(Beam, HasTheWidthsOfItsTwoWayPower) {
  const ClutterBeam beam = clutterBeam(*scenario::makeGaussian(30, 2, 4, -80));
  const double factor = std::sqrt(kPi / (8 * std::log(2.0)));
  EXPECT_NEAR(radToDeg(beam.azimuth_rad), 2 * factor, 1e-3);
  EXPECT_NEAR(radToDeg(beam.elevation_rad), 4 * factor, 2e-2);
  const ClutterBeam all_round = clutterBeam(*scenario::makeIsotropic());
  EXPECT_NEAR(all_round.azimuth_rad * all_round.elevation_rad, 4 * kPi, 1e-4);
}

/// Rain's clutter over noise of a beam along an axis, per that of rain all round.
double partInRain(const scenario::Antenna& antenna, const Aim& aim, double axis_elevation_rad,
                  double top_elevation_rad) {
  constexpr float kRange_m = 20e3f;
  ClutterTask task;
  task.rain = kRange_m * kRange_m;
  task.rain_top_m = kRange_m * static_cast<float>(std::sin(top_elevation_rad));
  task.sea_level_m = -1e6f;
  task.below = clutterBeam(antenna).below;
  EmitterBeam beam;
  beam.forward = {0, static_cast<float>(std::cos(axis_elevation_rad)),
                  static_cast<float>(std::sin(axis_elevation_rad))};
  beam.right = {1, 0, 0};
  beam.up = {0, -beam.forward.z, beam.forward.y};
  beam.pattern = antenna.view();
  return static_cast<double>(rainToNoise(task, beam, aim, kRange_m));
}

TEST(RainClutter, AboveItsTopIsThatOfTheTwoWayPatternBelow) {
  constexpr double kWidth_deg = 2;
  const scenario::AntennaPtr antenna = scenario::makeGaussian(35, kWidth_deg, kWidth_deg, -80);
  // The two-way power of a Gaussian beam has a standard deviation of 0.3003 half-power widths.
  const double deviation_deg = kWidth_deg / std::sqrt(16 * std::log(2.0));
  for (double above = -1; above <= 1; above += 0.125) {
    const double axis_deg = 5, top_deg = axis_deg - above * kWidth_deg;
    const double part = 0.5 * std::erfc(above * kWidth_deg / deviation_deg / std::sqrt(2.0));
    EXPECT_NEAR(ratioToDb(partInRain(*antenna, Aim{}, degToRad(axis_deg), degToRad(top_deg))),
                ratioToDb(part), 0.1)
        << above << " beamwidths above the rain";
  }
  EXPECT_NEAR(partInRain(*scenario::makeIsotropic(), Aim{}, 0, degToRad(30.0)), 0.75, 1e-3);
}

TEST(RainClutter, OfASteeredArrayEqualsTheIntegralOverItsPattern) {
  const scenario::AntennaPtr array = scenario::makePhasedArray(33, 40, 20, 0.5, 1.2);
  const auto solidAngle = [&](double steer_u) {  // of the two-way power, along the sines of both angles
    constexpr int kSteps = 1200;
    constexpr double kReach = 0.3;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double u = steer_u + kReach * (2 * (i + 0.5) / kSteps - 1),
                     v = kReach * (2 * (j + 0.5) / kSteps - 1);
        const double ahead2 = 1 - u * u - v * v;
        if (ahead2 <= 1e-6) continue;
        const double ahead = std::sqrt(ahead2);
        sum += std::pow(array->amplitudeTowards({ahead, u, v}, steer_u, 0), 4) / ahead;
      }
    }
    return sum * std::pow(2 * kReach / kSteps, 2);
  };
  const double broadside = solidAngle(0), alone = partInRain(*array, Aim{}, 0, kPi / 2);
  for (const double azimuth_deg : {15.0, 30.0, 45.0, 60.0}) {
    Aim aim;
    aim.steer_u = static_cast<float>(std::sin(degToRad(azimuth_deg)));
    const double ratio = partInRain(*array, aim, 0, kPi / 2) / alone;
    EXPECT_NEAR(ratioToDb(ratio / (solidAngle(std::sin(degToRad(azimuth_deg))) / broadside)), 0, 0.15)
        << azimuth_deg;
  }
}

TEST(SurfaceClutter, OfASteeredArrayIsWiderByTheCosine) {
  // Without elements' patterns echo and clutter fall alike but for the width of the beam.
  const scenario::AntennaPtr array = scenario::makePhasedArray(33, 40, 20, 0.5, 0);
  struct OneCell {
    ClutterCell cellAt(float, float) const { return {1, 0}; }
  };
  ClutterTask task;
  task.surface = 1;
  EmitterBeam beam;
  beam.forward = {0, 1, 0};
  beam.right = {1, 0, 0};
  beam.up = {0, 0, 1};
  beam.pattern = array->view();
  for (const double azimuth_deg : {0.0, 30.0, 60.0}) {
    Aim aim;
    aim.steer_u = static_cast<float>(std::sin(degToRad(azimuth_deg)));
    const auto found = static_cast<double>(
        surfaceToNoise<scenario::PatternKind::phased_array>(task, OneCell{}, beam, aim, 10e3f));
    EXPECT_NEAR(ratioToDb(found), -ratioToDb(std::cos(degToRad(azimuth_deg))), 0.01) << azimuth_deg;
  }
}

}  // namespace
}  // namespace emscape::emfield
