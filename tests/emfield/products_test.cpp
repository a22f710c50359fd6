// Radars' products through the whole pipeline against closed forms: the values are read from voxels.

#include "emfield/products.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "base/units.h"
#include "emfield/radar_receiver.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kFrequency_hz = 3e9;
constexpr double kGain_dbi = 30;
constexpr double kFarthest_m = 40e3;
constexpr double kSpacing_m = 1000;

scenario::Emitter radarOf(scenario::AntennaPtr antenna) {
  scenario::Emitter radar = plainEmitter("radar", 0);
  radar.kind = scenario::EmitterKind::radar;
  radar.frequency_hz = kFrequency_hz;
  radar.power_w = 2e4;
  radar.losses_db = 2;
  radar.polarization = scenario::Polarization::horizontal;
  radar.antenna = std::move(antenna);
  radar.receiver.noise_figure_db = 4;
  radar.receiver.losses_db = 1;
  radar.receiver.target_rcs_m2 = 5;
  return radar;
}

scenario::Emitter trackingRadar() {
  return radarOf(scenario::makeGaussian(kGain_dbi, 3, 4, -35));
}

/// Noise over 20 MHz from an isotropic antenna.
scenario::Emitter jammerOf(double power_w) {
  scenario::Emitter jammer = plainEmitter("jammer", 0);
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.frequency_hz = kFrequency_hz;
  jammer.bandwidth_hz = 20e6;
  jammer.power_w = power_w;
  jammer.losses_db = 0.5;
  jammer.polarization = scenario::Polarization::slant_45;
  return jammer;
}

/// The point this far east and north of the middle voxel, in its plane.
GeodeticPosition pointAt(const scenario::Scenario& scenario, double east_m, double north_m) {
  const volume::Grid grid = gridOf(scenario.region);
  const Vec3d middle = grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
  return GeoFrame(grid.frame).toGeodetic(middle + Vec3d{east_m, north_m, 0});
}

/// A radar in the middle of a line of voxels, and a jammer.
std::shared_ptr<scenario::Scenario> duel(const scenario::Emitter& radar, const scenario::Emitter& jammer,
                                         double jammer_east_m, double jammer_north_m) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), radar);
  addEmitter(*scenario, pointAt(*scenario, jammer_east_m, jammer_north_m), jammer);
  return scenario;
}

float east(const std::shared_ptr<scenario::Scenario>& scenario, const char* quantity, double range_m) {
  scenario->output.quantities = {quantity};
  return valueEast(*solve(scenario), range_m);
}

/// The same radar and jammer for the closed forms.
RadarLink linkTowardsTarget(const scenario::Emitter& radar) {
  RadarLink link = radarLinkOf(radar);
  link.gain_dbi = radar.antenna->gain_dbi;
  return link;
}

JammerLink linkTowardsRadar(const scenario::Emitter& jammer, double radar_gain_dbi) {
  JammerLink link;
  link.eirp_w = jammer.power_w * dbToRatio(jammer.antenna->gain_dbi - jammer.losses_db);
  link.bandwidth_hz = jammer.bandwidth_hz;
  link.radar_gain_dbi = radar_gain_dbi;
  link.polarization_loss_db = 10 * std::log10(2.0);
  link.radar_receive_losses_db = 1;
  return link;
}

TEST(JammerToSignal, OfASelfScreeningJammerIsTheClosedForm) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(2);
  for (const double range_m : {5e3, 10e3, 40e3}) {
    const auto scenario = duel(radar, jammer, range_m, 0);
    const double expected =
        jammerToSignalDb(linkTowardsTarget(radar), 5, range_m, linkTowardsRadar(jammer, kGain_dbi), range_m);
    EXPECT_NEAR(east(scenario, "jammer_to_signal_db", range_m), expected, 1e-3);
  }
}

TEST(JammerToSignal, OfAStandOffJammerGrowsWithTheFourthPowerOfRange) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(500);
  const auto scenario = duel(radar, jammer, 0, 60e3);  // a right angle off: through the side lobes
  for (const double range_m : {5e3, 10e3, 20e3, 40e3}) {
    const double expected = jammerToSignalDb(linkTowardsTarget(radar), 5, range_m,
                                             linkTowardsRadar(jammer, kGain_dbi - 35), 60e3);
    EXPECT_NEAR(east(scenario, "jammer_to_signal_db", range_m), expected, 1e-3);
  }
}

TEST(JammerToSignal, IsAdamysAndTheNavysDecibelForm) {
  // D. L. Adamy, EW 101, 2001, chapter 9, and NAWCWD TP 8347, section 4-7, with ERP in dBm, ranges in km:
  //   self-protection J/S = 71 + ERPj - ERPs + 20 log R - 10 log RCS
  //   stand-off       J/S = 71 + ERPj - ERPs + 40 log R - 20 log Rj + Gs - Gm - 10 log RCS
  // 71 rounds 10 log(4 pi 10^6) = 70.992.
  scenario::Emitter radar = trackingRadar(), jammer = jammerOf(500);
  jammer.bandwidth_hz = 0;
  jammer.polarization = radar.polarization;
  jammer.losses_db = 0;
  const double erp_s_dbm = ratioToDb(radar.power_w) + 30 - radar.losses_db + kGain_dbi;
  const double erp_j_dbm = ratioToDb(jammer.power_w) + 30;
  const double common_db = 70.992 + erp_j_dbm - erp_s_dbm - 10 * std::log10(5.0);
  EXPECT_NEAR(east(duel(radar, jammer, 20e3, 0), "jammer_to_signal_db", 20e3),
              common_db + 20 * std::log10(20.0), 2e-3);
  EXPECT_NEAR(east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3),
              common_db + 40 * std::log10(20.0) - 20 * std::log10(60.0) - 35, 2e-3);
}

TEST(JammerToSignal, EntersThroughThePatternAtTheAngleBetweenTargetAndJammer) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(100);
  const double in_line = east(duel(radar, jammer, 60e3, 0), "jammer_to_signal_db", 20e3);
  for (const double off_deg : {1.0, 1.5, 3.0, 4.5}) {
    const auto scenario =
        duel(radar, jammer, 60e3 * std::cos(degToRad(off_deg)), 60e3 * std::sin(degToRad(off_deg)));
    const double pattern_db = std::max(-35.0, 10 * std::log10(0.5) * std::pow(off_deg / 1.5, 2));
    EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3) - in_line, pattern_db, 0.01) << off_deg;
  }
}

TEST(JammerToSignal, KnowsTheJammersOwnAntenna) {
  const scenario::Emitter radar = trackingRadar();
  scenario::Emitter jammer = jammerOf(100);
  const double isotropic = east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3);
  jammer.antenna = scenario::makeGaussian(20, 10, 10, -40);
  jammer.scan.azimuth_deg = 185;  // the radar lies to the south, below the jammer's own horizontal plane
  jammer.scan.elevation_deg = -radToDeg(60e3 / 6.37e6);
  const double off_by_half = ratioToDb(0.5);
  EXPECT_NEAR(east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3) - isotropic, 20 + off_by_half,
              0.02);
}

TEST(JammerToSignal, KnowsBandsAndPolarisations) {
  const scenario::Emitter radar = trackingRadar();
  scenario::Emitter jammer = jammerOf(100);
  const auto ratio = [&] { return east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3); };
  const double wide = ratio();
  jammer.bandwidth_hz = 1e5;
  EXPECT_NEAR(ratio() - wide, ratioToDb(20.0), 1e-3) << "all of a narrow jammer's power enters";
  jammer.frequency_hz = kFrequency_hz + 10e6;
  EXPECT_EQ(ratio(), -300) << "beside the band: no jamming, the floor";
  jammer = jammerOf(100);
  jammer.polarization = scenario::Polarization::horizontal;
  EXPECT_NEAR(ratio() - wide, ratioToDb(2.0), 1e-3);
  jammer.polarization = scenario::Polarization::vertical;
  EXPECT_NEAR(ratio() - wide, ratioToDb(2.0) - scenario::kCrossPolarIsolation_db, 1e-3);
}

TEST(JammerToSignal, DoesNotCountProcessingWhichBurnThroughDoes) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.required_signal_to_jammer_db = 10;
  const scenario::Emitter jammer = jammerOf(100);
  const double ratio = east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3);
  EXPECT_NEAR(east(duel(radar, jammer, 0, 60e3), "burn_through_margin_db", 20e3), -ratio - 10, 1e-3);
  radar.receiver.processing_gain_db = 13;
  EXPECT_NEAR(east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3), ratio, 1e-3);
  EXPECT_NEAR(east(duel(radar, jammer, 0, 60e3), "burn_through_margin_db", 20e3), -ratio + 3, 1e-3);
}

TEST(JammerToSignal, TakesTheHorizonForTheJammerToo) {
  scenario::Emitter radar = trackingRadar(), jammer = jammerOf(1e5);
  jammer.propagation = scenario::PropagationModel::horizon;
  auto scenario = emptyScenario(FrameKind::altitude, 44, -71, {20e3, 20e3, 2000}, {20, 20, 4});
  addEmitter(*scenario, {44, -71, 30}, radar);
  addEmitter(*scenario, {45.5, -71, 100}, jammer);  // 167 km: the radio horizon is at 41 + 23 km
  scenario->output.quantities = {"jammer_to_signal_db"};
  EXPECT_EQ(valueAt(*solve(scenario), 3, 3, 1), -300);
  scenario->platforms.back().track[0].position.height_ellipsoid_m = 3000;
  EXPECT_GT(valueAt(*solve(scenario), 3, 3, 1), -50);
}

TEST(JammerToSignal, IsThatOfTheRadarThatBearsItBest) {
  scenario::Emitter strong = trackingRadar(), weak = trackingRadar();
  weak.name = "weak";
  weak.power_w /= 10;
  const scenario::Emitter jammer = jammerOf(100);
  auto scenario = duel(weak, jammer, 0, 60e3);
  const double alone = east(scenario, "jammer_to_signal_db", 20e3);
  addEmitter(*scenario, middleOf(*scenario), strong);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3), alone - 10, 1e-3);
  scenario->output.combine = scenario::CombineMode::per_emitter;
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3), alone, 1e-3) << "the first radar's own";
}

TEST(JammerToSignal, OfSeveralJammersIsOfTheSumOfTheirPowers) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(100);
  auto scenario = duel(radar, jammer, 0, 60e3);
  const double alone = east(scenario, "jammer_to_signal_db", 20e3);
  addEmitter(*scenario, pointAt(*scenario, 0, 60e3), jammer);
  addEmitter(*scenario, pointAt(*scenario, 0, -60e3), jammer);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3), alone + ratioToDb(3), 1e-3);
}

TEST(BurnThrough, OfASelfScreeningJammerIsAtItsClosedFormRange) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.required_signal_to_jammer_db = 6;
  scenario::Emitter jammer = jammerOf(1);
  // So strong that the target shows from 10 km inwards.
  jammer.power_w = std::pow(
      selfScreeningBurnThrough_m(linkTowardsTarget(radar), 5, linkTowardsRadar(jammer, kGain_dbi), -6) / 10e3,
      2);
  EXPECT_NEAR(east(duel(radar, jammer, 10e3, 0), "burn_through_margin_db", 10e3), 0, 1e-3);
  EXPECT_NEAR(east(duel(radar, jammer, 20e3, 0), "burn_through_margin_db", 20e3), -20 * std::log10(2.0),
              1e-3);
}

TEST(BurnThrough, OfAStandOffJammerIsAtItsClosedFormRange) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.required_signal_to_jammer_db = 6;
  scenario::Emitter jammer = jammerOf(1);
  jammer.power_w = std::pow(
      standOffBurnThrough_m(linkTowardsTarget(radar), 5, linkTowardsRadar(jammer, kGain_dbi - 35), 60e3, -6) /
          10e3,
      4);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 10e3), 0, 1e-3);
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 20e3), -40 * std::log10(2.0), 1e-3);
}

TEST(BurnThrough, AsksByDefaultForWhatHalfTheDetectionsTake) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.pulses = 8;
  EXPECT_DOUBLE_EQ(requiredSignalToJammerDb(radar.receiver), requiredSnrDb(detectorOf(radar.receiver), 0.5));
  // Against jamming far above the noise both say the same: where the margin is 0, Pd is 1/2.
  scenario::Emitter jammer = jammerOf(1e6);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarLook::target;
  const double margin_db = east(scenario, "burn_through_margin_db", 10e3);
  scenario->emitters[1].power_w *= dbToRatio(margin_db);
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 10e3), 0, 1e-3);
  EXPECT_NEAR(east(scenario, "detection_probability", 10e3), 0.5, 0.01);
}

TEST(BurnThrough, OfAnUnjammedRadarIsItsCeiling) {
  const auto scenario = duel(trackingRadar(), jammerOf(100), 0, 60e3);
  scenario->emitters[1].active_s = {{5, 10}};
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 20e3), 60, 1e-3);
}

class DetectionProduct : public ::testing::Test {
 protected:
  /// Exact probability from the closed form of the radar equation, with jamming over noise.
  static double exact(const scenario::Emitter& radar, double range_m, double jamming_to_noise = 0) {
    const Detector detector = detectorOf(radar.receiver);
    const double snr = dbToRatio(radarSnrDb(linkTowardsTarget(radar), radar.receiver.target_rcs_m2, range_m));
    return detectionProbability(detector, detectionThreshold(detector), snr / (1 + jamming_to_noise));
  }
};

TEST_F(DetectionProduct, IsTheExactProbabilityOfTheRadarEquation) {
  for (int swerling = 0; swerling <= 4; ++swerling) {
    scenario::Emitter radar = trackingRadar();
    radar.power_w = 300;
    radar.receiver.swerling = swerling;
    radar.receiver.pulses = 6;
    auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
    scenario->output.radar_look = scenario::RadarLook::target;
    scenario->output.quantities = {"detection_probability"};
    addEmitter(*scenario, middleOf(*scenario), radar);
    const auto volume = solve(scenario);
    for (double range_m = 1e3; range_m <= kFarthest_m; range_m += 1e3) {
      EXPECT_NEAR(valueEast(*volume, range_m), exact(radar, range_m), 1.2e-4) << swerling << ", " << range_m;
    }
  }
}

TEST_F(DetectionProduct, OfAJammedRadarTakesJammingForNoise) {
  scenario::Emitter radar = trackingRadar();
  const scenario::Emitter jammer = jammerOf(1000);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarLook::target;
  const RadarLink link = radarLinkOf(radar);
  const double jamming_to_noise = jammingPower_w(link, linkTowardsRadar(jammer, kGain_dbi - 35), 60e3) /
                                  noisePower_w(link.bandwidth_hz, link.noise_temperature_k);
  ASSERT_GT(jamming_to_noise, 5);
  for (double range_m = 2e3; range_m <= kFarthest_m; range_m += 4e3) {
    EXPECT_NEAR(east(scenario, "detection_probability", range_m), exact(radar, range_m, jamming_to_noise),
                1.2e-4);
  }
}

TEST_F(DetectionProduct, IsWhatACountOfRandomTrialsComesTo) {
  // Swerling 1 before noise and noise-like jamming: every amplitude a complex Gaussian number.
  scenario::Emitter radar = trackingRadar();
  radar.receiver.pfa = 1e-2;
  const scenario::Emitter jammer = jammerOf(100);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarLook::target;
  const double range_m = 16e3;
  const RadarLink link = radarLinkOf(radar);
  const double noise_w = noisePower_w(link.bandwidth_hz, link.noise_temperature_k);
  const double jamming_w = jammingPower_w(link, linkTowardsRadar(jammer, kGain_dbi - 35), 60e3);
  const double echo_w = echoPower_w(linkTowardsTarget(radar), 5, range_m);
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  const auto power = [&](double variance_w) {
    const double i = gauss(random), q = gauss(random);
    return variance_w / 2 * (i * i + q * q);
  };
  constexpr int kTrials = 100000;
  const double threshold = -std::log(radar.receiver.pfa) * (noise_w + jamming_w);
  int detected = 0;
  for (int n = 0; n < kTrials; ++n) detected += power(echo_w + noise_w + jamming_w) > threshold ? 1 : 0;
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), double(detected) / kTrials, 0.006);
}

TEST_F(DetectionProduct, OfSeveralRadarsIsThatOfIndependentDetections) {
  scenario::Emitter radar = trackingRadar();
  radar.power_w = 100;
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario->output.radar_look = scenario::RadarLook::target;
  addEmitter(*scenario, middleOf(*scenario), radar);
  scenario::Emitter other = radar;
  other.receiver.swerling = 0;
  addEmitter(*scenario, middleOf(*scenario), other);
  const double range_m = 11e3;
  const double a = exact(radar, range_m), b = exact(other, range_m);
  ASSERT_GT(std::min(a, b), 0.05);
  ASSERT_LT(std::max(a, b), 0.95);
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), 1 - (1 - a) * (1 - b), 2e-4);
  scenario->output.combine = scenario::CombineMode::max;
  EXPECT_NEAR(east(scenario, "detection_probability", range_m), std::max(a, b), 2e-4);
}

TEST_F(DetectionProduct, IsNoneWhereThereIsNoEcho) {
  scenario::Emitter radar = trackingRadar();
  radar.propagation = scenario::PropagationModel::horizon;
  auto scenario = emptyScenario(FrameKind::altitude, 44, -71, {300e3, 20e3, 2000}, {60, 4, 4});
  addEmitter(*scenario, {44, -71, 30}, radar);
  scenario->output.radar_look = scenario::RadarLook::target;
  scenario->output.quantities = {"detection_probability"};
  const auto volume = solve(scenario);
  EXPECT_EQ(valueAt(*volume, 0, 2, 0), 0) << "below the horizon";
  EXPECT_GT(valueAt(*volume, 28, 2, 0), 0.99);
  EXPECT_EQ(volume->info.floor, 0);
}

TEST_F(DetectionProduct, FormulasStandInForTheExactStatistics) {
  scenario::Emitter radar = trackingRadar();
  radar.power_w = 300;
  radar.receiver.swerling = 0;
  radar.receiver.pulses = 10;
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  scenario->output.radar_look = scenario::RadarLook::target;
  addEmitter(*scenario, middleOf(*scenario), radar);
  for (const auto method : {scenario::DetectionMethod::albersheim, scenario::DetectionMethod::shnidman}) {
    scenario->emitters[0].receiver.detection = method;
    double worst = 0;
    for (double range_m = 15e3; range_m <= kFarthest_m; range_m += 1e3) {
      const double pd = exact(radar, range_m);
      if (pd < 0.1 || pd > 0.9) continue;
      worst = std::max(worst, std::abs(east(scenario, "detection_probability", range_m) - pd));
    }
    EXPECT_GT(worst, 1e-3) << "it is a formula";
    EXPECT_LT(worst, 0.06);
  }
}

/// Values along the line for a radar that looks at targets, over those where its beam is right on them.
double lookGain_db(scenario::Emitter radar, double east_m, double up_m) {
  auto scenario = emptyScenario(FrameKind::enu, 44.3, -71.4, {40.5e3, 1500, 20500}, {81, 3, 41});
  scenario->atmosphere.k_factor = 1;
  const volume::Grid grid = gridOf(scenario->region);
  const Vec3d site = grid.center_m(40, 1, 0);
  addEmitter(*scenario, GeoFrame(grid.frame).toGeodetic(site), std::move(radar));
  scenario->output.quantities = {"snr_db"};
  scenario->output.radar_look = scenario::RadarLook::target;
  const auto volume = solve(scenario);
  const double range_m = std::hypot(east_m, up_m);
  const scenario::Emitter& used = scenario->emitters[0];
  return (valueAt(*volume, 40 + int(std::lround(east_m / 500)), 1, int(std::lround(up_m / 500))) -
          radarSnrDb(linkTowardsTarget(used), 5, range_m)) /
         2;
}

TEST(Look, OfARotatingRadarTurnsRoundAndKeepsItsElevation) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  radar.scan.elevation_deg = 2;
  const double level_db = 10 * std::log10(0.5);  // 2 degrees below a beam of 4
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), level_db, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), level_db, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), -35, 1e-3) << "far above the beam";
}

TEST(Look, OfASectorReachesItsEnds) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::sector;
  radar.scan.azimuth_deg = 60;  // east is 30 degrees to the right of its middle
  radar.scan.rate_deg_s = 10;
  radar.scan.width_deg = 60;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 0, 1e-3);
  radar.scan.width_deg = 57;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 10 * std::log10(0.5), 1e-3) << "half a beamwidth beyond the end";
  EXPECT_NEAR(lookGain_db(radar, -10e3, 0), -35, 1e-3);
}

TEST(Look, OfARasterStaysBetweenItsBars) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::raster;
  radar.scan.azimuth_deg = 90;
  radar.scan.width_deg = 20;
  radar.scan.rate_deg_s = 10;
  radar.scan.elevation_deg = 24;
  radar.scan.elevation_step_deg = 10;
  radar.scan.bars = 5;  // 4 to 44 degrees
  EXPECT_NEAR(lookGain_db(radar, 10e3, 5e3), 0, 1e-3);
  const double above_deg = 1;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 10 * std::log10(0.5) * std::pow(above_deg / 2, 2), 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 4 * 10 * std::log10(0.5), 1e-3) << "4 degrees below";
}

TEST(Look, OfARadarWithoutAScanIsOnEveryTarget) {
  const scenario::Emitter radar = trackingRadar();
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 0, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, -10e3, 2e3), 0, 1e-3);
  EXPECT_NEAR(lookGain_db(radar, 0, 10e3), 0, 1e-3) << "the zenith";
}

TEST(Look, OfASteeredArrayLosesItsElementsPattern) {
  scenario::Emitter radar = radarOf(scenario::makePhasedArray(kGain_dbi, 16, 16, 0.5, 1));
  radar.scan.azimuth_deg = 90;
  EXPECT_NEAR(lookGain_db(radar, 10e3, 0), 0, 1e-3);
  // an element's amplitude is cos(45 degrees)
  EXPECT_NEAR(lookGain_db(radar, 10e3, 10e3), 10 * std::log10(0.5), 5e-3);
  EXPECT_LT(lookGain_db(radar, -10e3, 0), -30) << "it does not look behind itself";
}

TEST(Look, OfAScanIsWhereTheBeamIs) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.azimuth_deg = 88.5;
  const auto scenario = duel(radar, jammerOf(1), 0, 1e6);
  const double expected =
      radarSnrDb(linkTowardsTarget(radar), 5, 20e3) + 2 * 10 * std::log10(0.5);  // there and back
  EXPECT_NEAR(east(scenario, "snr_db", 20e3), expected, 1e-3);
  scenario->emitters[1].active_s = {{5, 10}};
  const Detector detector = detectorOf(radar.receiver);
  EXPECT_NEAR(east(scenario, "detection_probability", 20e3),
              detectionProbability(detector, detectionThreshold(detector), dbToRatio(expected)), 1.2e-4);
}

TEST(RadarChannels, AreComputedAnewOnlyWhereSomethingChanged) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  scenario::Emitter jammer = jammerOf(100);
  jammer.active_s = {{0, 3}};
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.quantities = {"snr_db", "jammer_to_signal_db"};
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto before = solver.volumes();
  solver.update(scenario::snapshotAt(scenario, nullptr, 1));
  EXPECT_NE(solver.volumes()[0], before[0]) << "the beam turned";
  EXPECT_EQ(solver.volumes()[1], before[1]) << "the look did not";
  solver.update(scenario::snapshotAt(scenario, nullptr, 4));
  EXPECT_NE(solver.volumes()[1], before[1]) << "the jammer fell silent";
  EXPECT_EQ(valueEast(*solver.volumes()[1], 20e3), -300);
}

TEST(RadarChannels, UpdatesGiveWhatAFreshSolverComputes) {
  scenario::Emitter radar = trackingRadar();
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  scenario::Emitter standing = trackingRadar();
  standing.name = "standing";
  const auto scenario = duel(radar, jammerOf(100), 5e3, 30e3);
  addEmitter(*scenario, pointAt(*scenario, 3e3, 0), standing);
  scenario::TrackPoint end = scenario->platforms[1].track.front();
  end.t_s = 10;
  end.position.longitude_deg += 0.2;
  scenario->platforms[1].track.push_back(end);
  for (const char* quantity :
       {"snr_db", "detection_probability", "jammer_to_signal_db", "burn_through_margin_db"}) {
    for (const auto look : {scenario::RadarLook::scan, scenario::RadarLook::target}) {
      SCOPED_TRACE(quantity);
      scenario->output.quantities = {quantity};
      scenario->output.radar_look = look;
      FieldOptions bounded;
      bounded.cache_bytes = 1;
      FieldSolver solver(scenario, nullptr, {}), uncached(scenario, nullptr, bounded);
      for (const double t_s : {0.0, 0.5, 0.5, 1.0, 5.0, 0.0}) {
        const auto snapshot = scenario::snapshotAt(scenario, nullptr, t_s);
        FieldSolver fresh(scenario, nullptr, {});
        fresh.update(snapshot);
        const auto& expected = fresh.volumes().front()->values;
        for (FieldSolver* updated : {&solver, &uncached}) {
          updated->update(snapshot);
          const auto& values = updated->volumes().front()->values;
          for (std::size_t v = 0; v < values.size(); ++v) ASSERT_NEAR(values[v], expected[v], 1e-4);
        }
      }
    }
  }
}

TEST(RadarChannels, HoldRadarsAndTheirJammers) {
  const auto scenario = duel(trackingRadar(), jammerOf(100), 0, 60e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  const auto channels = channelsOf(*scenario, {"snr_db", "detection_probability", "emitter_count"});
  EXPECT_THAT(channels[0].emitters, ElementsAre(0));
  EXPECT_THAT(channels[0].jammers, IsEmpty());
  EXPECT_THAT(channels[1].emitters, ElementsAre(0));
  EXPECT_THAT(channels[1].jammers, ElementsAre(1));
  EXPECT_THAT(channels[2].emitters, ElementsAre(0, 1, 2));
}

TEST(RadarChannels, NeedARadar) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  for (const char* quantity : {"snr_db", "detection_probability", "jammer_to_signal_db"}) {
    try {
      east(scenario, quantity, 0);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr(std::string("quantity '") + quantity + "' needs an emitter of kind 'radar'"));
    }
  }
}

TEST(Losses, OfTheChainCountOnceEach) {
  scenario::Emitter radar = trackingRadar();
  const auto snr = [&] { return east(duel(radar, jammerOf(1), 0, 60e3), "snr_db", 20e3); };
  radar.scan.azimuth_deg = 90;
  radar.losses_db = radar.receiver.losses_db = 0;
  const double lossless = snr();
  radar.losses_db = 3;
  EXPECT_NEAR(snr(), lossless - 3, 1e-3) << "of the transmit path: once, not once more on receiving";
  radar.receiver.losses_db = 2;
  EXPECT_NEAR(snr(), lossless - 5, 1e-3) << "of the receive path";
  radar.receiver.processing_gain_db = 10;
  EXPECT_NEAR(snr(), lossless + 5, 1e-3);
  // Receive losses attenuate jamming and echo alike; transmit losses only the echo.
  radar.receiver.processing_gain_db = 0;
  const auto ratio = [&] { return east(duel(radar, jammerOf(1), 0, 60e3), "jammer_to_signal_db", 20e3); };
  const double before = ratio();
  radar.receiver.losses_db = 7;
  EXPECT_NEAR(ratio(), before, 1e-3);
  radar.losses_db += 4;
  EXPECT_NEAR(ratio(), before + 4, 1e-3);
}

TEST(Losses, OfTheLineAddNoiseAsBlakeHasIt) {
  // An antenna at 290 K: the line's losses add to the noise figure. A cold one gains less than the ratio of
  // the temperatures, for line and receiver stay warm.
  scenario::Emitter radar = trackingRadar();
  radar.receiver.losses_db = 2;
  radar.receiver.noise_figure_db = 3;
  const RadarLink warm = radarLinkOf(radar);
  EXPECT_NEAR(warm.noise_temperature_k, 290 * dbToRatio(3), 1e-9);
  radar.receiver.antenna_temperature_k = 100;
  const double at_antenna_k = 100 + 290 * (dbToRatio(2) - 1) + dbToRatio(2) * 290 * (dbToRatio(3) - 1);
  EXPECT_NEAR(radarLinkOf(radar).noise_temperature_k, at_antenna_k / dbToRatio(2), 1e-9);
}

// The traps of the products, each through the pipeline.

TEST(Traps, FieldOfOneKilowattErpIsThatOfItsEirp) {
  // ITU's curves are for 1 kW ERP, which is 2.15 dB more EIRP: 106.9 dBuV/m at 1 km.
  auto scenario = lineOfVoxels(2e3, 1e3);
  scenario::Emitter emitter = plainEmitter("dipole", 0);
  emitter.antenna = scenario::makeIsotropic(kDipoleGain_dbi);
  addEmitter(*scenario, middleOf(*scenario), emitter);
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 106.92, 0.01);
  scenario->emitters[0].antenna = scenario::makeIsotropic();
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 104.77, 0.01);
}

TEST(Traps, FieldStrengthIsRmsNotPeak) {
  // E = sqrt(30 EIRP) / d is RMS: 173.2 mV/m for 1 kW at 1 km; the peak would be 3.01 dB more.
  auto scenario = lineOfVoxels(2e3, 1e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("isotropic", 0));
  const double rms_v_per_m = std::sqrt(kFreeSpaceImpedance / (4 * kPi) * 1000) / 1e3;
  EXPECT_NEAR(east(scenario, "field_strength_dbuvm", 1e3), 20 * std::log10(rms_v_per_m * 1e6), 1e-3);
}

TEST(Traps, PowersAreAddedNotDecibels) {
  auto scenario = lineOfVoxels(2e3, 1e3);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("one", 0));
  for (const char* quantity : {"power_density_dbwm2", "field_strength_dbuvm"}) {
    const double one = east(scenario, quantity, 1e3);
    auto two = lineOfVoxels(2e3, 1e3);
    for (int i = 0; i < 2; ++i) addEmitter(*two, middleOf(*two), plainEmitter("one", 0));
    EXPECT_NEAR(east(two, quantity, 1e3) - one, 3.0103, 1e-3);
  }
}

TEST(Traps, RadarCountsThePathTwiceAndJammingOnce) {
  // Each doubling of range: 12.04 dB of an echo's, 6.02 dB of jamming's power; the pattern likewise.
  scenario::Emitter radar = trackingRadar();
  radar.scan.azimuth_deg = 90;
  const auto scenario = duel(radar, jammerOf(1), 0, 30e3);
  EXPECT_NEAR(east(scenario, "snr_db", 10e3) - east(scenario, "snr_db", 20e3), 40 * std::log10(2.0), 1e-3);
  const auto farther = duel(radar, jammerOf(1), 0, 60e3);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 10e3) - east(farther, "jammer_to_signal_db", 10e3),
              20 * std::log10(2.0), 1e-3);
  scenario->emitters[0].scan.azimuth_deg = 88.5;
  EXPECT_NEAR(east(scenario, "snr_db", 10e3) - radarSnrDb(linkTowardsTarget(radar), 5, 10e3),
              2 * 10 * std::log10(0.5), 1e-3);
}

TEST(Traps, InterceptIsOneWay) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("radio", 0));
  scenario->receivers = {scenario::ReceiverProfile{}};
  EXPECT_NEAR(east(scenario, "received_power_dbm", 10e3) - east(scenario, "received_power_dbm", 20e3),
              20 * std::log10(2.0), 1e-3);
}

}  // namespace
}  // namespace emscape::emfield
