// Jamming through the whole pipeline against closed forms: the values are read from voxels.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/jamming_forms.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/radar_duel.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

TEST(JammerToSignal, SelfScreeningJammerEqualsClosedForm) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(2);
  for (const double range_m : {5e3, 10e3, 40e3}) {
    const auto scenario = duel(radar, jammer, range_m, 0);
    const double expected =
        jammerToSignalDb(linkTowardsTarget(radar), 5, range_m, linkTowardsRadar(jammer, kGain_dbi), range_m);
    EXPECT_NEAR(east(scenario, "jammer_to_signal_db", range_m), expected, 1e-3);
  }
}

TEST(JammerToSignal, OfAJammerOnTheRadarsOwnPlatformIsNotModelled) {
  const auto scenario = duel(trackingRadar(), jammerOf(5e4), 0, 60e3);
  scenario->output.radar_look = scenario::RadarAim::target;
  const float jammed = east(scenario, "detection_probability", 10e3);
  scenario->emitters[1].platform = 0;
  const float own = east(scenario, "detection_probability", 10e3);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const GeodeticPosition at = pointAt(*scenario, 10e3, 0);
  const PathBudget budget = pathBudget(snapshot, 0, {at, at.height_ellipsoid_m},
                                       propagation::PropagationModel::free_space, nullptr);
  EXPECT_EQ(budget.find("jammer_to_signal_db"), nullptr);
  scenario->emitters.pop_back();
  EXPECT_EQ(own, east(scenario, "detection_probability", 10e3));
  EXPECT_GT(own, jammed + 0.2f);
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

TEST(JammerToSignal, EqualsPublishedDecibelForms) {
  // D. L. Adamy, EW 101, 2001, chapter 9, and NAWCWD TP 8347, sections 4-7 and 4-9, with ERP in dBm, ranges
  // in km:
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

TEST(JammerToSignal, EntersAPhasedArrayFromBehindThroughItsErrorFloor) {
  scenario::Emitter radar = radarOf(scenario::makePhasedArray(kGain_dbi, 16, 16, 0.5, 0.5, -35));
  radar.scan.azimuth_deg = 90;
  const scenario::Emitter jammer = jammerOf(500);
  for (const double range_m : {5e3, 20e3}) {
    const double expected = jammerToSignalDb(linkTowardsTarget(radar), 5, range_m,
                                             linkTowardsRadar(jammer, kGain_dbi - 35), 60e3);
    EXPECT_NEAR(east(duel(radar, jammer, -60e3, 0), "jammer_to_signal_db", range_m), expected, 1e-3);
  }
}

TEST(JammerToSignal, UsesAntennaOfTheJammer) {
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

TEST(JammerToSignal, DependsOnBandsAndPolarizations) {
  const scenario::Emitter radar = trackingRadar();
  scenario::Emitter jammer = jammerOf(100);
  const auto ratio = [&] { return east(duel(radar, jammer, 0, 60e3), "jammer_to_signal_db", 20e3); };
  const double wide = ratio();
  jammer.bandwidth_hz = 1e5;
  EXPECT_NEAR(ratio() - wide, ratioToDb(20.0), 1e-3) << "all of a narrow jammer's power enters";
  jammer.frequency_hz = kFrequency_hz + 10e6;
  EXPECT_EQ(ratio(), -300) << "beside the band: no jamming, the floor";
  jammer = jammerOf(100);
  jammer.polarization = propagation::Polarization::horizontal;
  EXPECT_NEAR(ratio() - wide, ratioToDb(2.0), 1e-3);
  jammer.polarization = propagation::Polarization::vertical;
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
  jammer.propagation.model = propagation::PropagationModel::horizon;
  auto scenario = emptyScenario(FrameKind::altitude, 44, -71, {20e3, 20e3, 2000}, {20, 20, 4});
  addEmitter(*scenario, {44, -71, 30}, radar);
  addEmitter(*scenario, {45.5, -71, 100}, jammer);  // 167 km: the radio horizon is at 41 + 23 km
  scenario->output.quantities = {"jammer_to_signal_db"};
  EXPECT_EQ(valueAt(*solve(scenario), 3, 3, 1), -300);
  scenario->platforms.back().track[0].position.height_ellipsoid_m = 3000;
  EXPECT_GT(valueAt(*solve(scenario), 3, 3, 1), -50);
}

TEST(JammerToSignal, CountsAPathAcrossMissingTerrainAsFreeWhereThatIsAllowed) {
  const auto terrain = std::make_shared<const MadeTerrain>(44.5, -71.5, 1.0, 0.05);
  scenario::Emitter jammer = jammerOf(100);
  auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {10e3, 10e3, 4000}, {10, 10, 4});
  addEmitter(*scenario, {44.5, -71.5, 2500}, trackingRadar());
  addEmitter(*scenario, {44.97, -71.03, 2500}, jammer);  // behind the hole
  scenario->output.quantities = {"jammer_to_signal_db"};
  FieldOptions options;
  options.allow_missing_terrain = true;
  const float free = valueAt(*solve(scenario, terrain, options), 2, 3, 3);
  scenario->emitters[1].propagation.model = propagation::PropagationModel::horizon;
  SolvedField solver(scenario, terrain, options);
  EXPECT_NEAR(valueAt(*solver.volumes()[0].host(), 2, 3, 3), free, 0.02);
  EXPECT_THAT(solver.warnings(),
              ::testing::Contains(::testing::AllOf(::testing::HasSubstr("jammer 'jammer' to radar 'radar': "),
                                                   ::testing::HasSubstr("counted as a free path"))));
}

TEST(JammerToSignal, IsOfTheLeastAffectedRadar) {
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

TEST(JammerToSignal, SeveralJammersAddTheirPowers) {
  const scenario::Emitter radar = trackingRadar(), jammer = jammerOf(100);
  auto scenario = duel(radar, jammer, 0, 60e3);
  const double alone = east(scenario, "jammer_to_signal_db", 20e3);
  addEmitter(*scenario, pointAt(*scenario, 0, 60e3), jammer);
  addEmitter(*scenario, pointAt(*scenario, 0, -60e3), jammer);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3), alone + ratioToDb(3), 1e-3);
}

TEST(Jamming, ChannelsWithoutJammingEqualSilentJammers) {
  const auto jammed = duel(trackingRadar(), jammerOf(500), 0, 60e3);
  jammed->output.quantities = {"snr_db", "detection_probability"};
  FieldOptions options;
  options.also_per_emitter = options.also_unjammed = true;
  SolvedField solver(jammed, nullptr, options);
  const auto silent = std::make_shared<scenario::Scenario>(*jammed);
  silent->emitters[1].active_s = {{5, 10}};
  SolvedField without(silent);
  const Channel& last = solver.channels().back();
  EXPECT_EQ(last.name, "detection_probability without jamming");
  EXPECT_EQ(solver.channels()[solver.channels().size() - 2].name, "detection_probability:radar");
  EXPECT_EQ(solver.volumes().back().host()->values, without.volumes().back().host()->values);
  EXPECT_NE(solver.volumes()[1].host()->values, without.volumes().back().host()->values);
}

TEST(BurnThrough, SelfScreeningJammerEqualsClosedFormRange) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.required_signal_to_jammer_db = 6;
  scenario::Emitter jammer = jammerOf(1);
  // So strong that the target is detected within 10 km.
  jammer.power_w = std::pow(
      selfScreeningBurnThrough_m(linkTowardsTarget(radar), 5, linkTowardsRadar(jammer, kGain_dbi), -6) / 10e3,
      2);
  EXPECT_NEAR(east(duel(radar, jammer, 10e3, 0), "burn_through_margin_db", 10e3), 0, 1e-3);
  EXPECT_NEAR(east(duel(radar, jammer, 20e3, 0), "burn_through_margin_db", 20e3), -20 * std::log10(2.0),
              1e-3);
}

TEST(BurnThrough, StandOffJammerEqualsClosedFormRange) {
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

TEST(BurnThrough, DefaultThresholdIsHalfProbability) {
  scenario::Emitter radar = trackingRadar();
  radar.receiver.pulses = 8;
  EXPECT_DOUBLE_EQ(requiredSignalToJammerDb(radar), requiredSnrDb(detectorOf(radar.receiver), 0.5));
  scenario::Emitter by_formula = radar;
  by_formula.receiver.detection = scenario::DetectionMethod::shnidman;
  EXPECT_DOUBLE_EQ(requiredSignalToJammerDb(by_formula), shnidmanSnrDb(detectorOf(radar.receiver), 0.5));
  // If jamming is far above the noise both agree: where the margin is 0, Pd is 1/2.
  scenario::Emitter jammer = jammerOf(1e6);
  const auto scenario = duel(radar, jammer, 0, 60e3);
  scenario->output.radar_look = scenario::RadarAim::target;
  const double margin_db = east(scenario, "burn_through_margin_db", 10e3);
  scenario->emitters[1].power_w *= dbToRatio(margin_db);
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 10e3), 0, 1e-3);
  EXPECT_NEAR(east(scenario, "detection_probability", 10e3), 0.5, 0.01);
}

/// A radar whose targets low in the west lie behind the horizon, and a jammer high above it.
std::shared_ptr<scenario::Scenario> beyondTheHorizon() {
  auto scenario = emptyScenario(FrameKind::altitude, 44, -71, {300e3, 10e3, 4000}, {60, 2, 4});
  scenario::Emitter radar = trackingRadar(), jammer = jammerOf(1e3);
  radar.propagation.model = propagation::PropagationModel::horizon;
  addEmitter(*scenario, {44, -71, 30}, radar);
  jammer.active_s = {{0, 5}};
  addEmitter(*scenario, {44.2, -71, 5000}, jammer);
  return scenario;
}

TEST(JammerToSignal, WithoutEchoIsCeilingUnderJammingOnly) {
  const auto scenario = beyondTheHorizon();
  scenario->output.quantities = {"jammer_to_signal_db", "burn_through_margin_db"};
  FieldSolver solver(scenario, nullptr, {});
  const auto at = [&](int channel, int i, int k) {
    return valueAt(*solver.volumes()[static_cast<std::size_t>(channel)].host(), i, 1, k);
  };
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  EXPECT_NEAR(at(0, 0, 0), 100, 1e-3) << "500 m above the sea at 147 km: no echo";
  EXPECT_NEAR(at(1, 0, 0), -60, 1e-3);
  EXPECT_LT(at(0, 25, 3), 60);
  EXPECT_GT(at(1, 29, 3), -60);
  EXPECT_EQ(solver.volumes()[0].info().extra.at(volume::kLegendNoteKey), "no echo: 100");
  EXPECT_EQ(solver.volumes()[1].info().extra.at(volume::kLegendNoteKey), "no echo: -60");

  solver.update(scenario::snapshotAt(scenario, nullptr, 7));
  EXPECT_EQ(at(0, 0, 0), -300) << "no echo and no jamming: nothing";
  EXPECT_EQ(at(1, 0, 0), -300);
  EXPECT_EQ(at(0, 29, 3), -300) << "not jammed";
  EXPECT_NEAR(at(1, 29, 3), 60, 1e-3);
}

TEST(BurnThrough, UnjammedRadarIsAtCeiling) {
  const auto scenario = duel(trackingRadar(), jammerOf(100), 0, 60e3);
  scenario->emitters[1].active_s = {{5, 10}};
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 20e3), 60, 1e-3);
}

TEST(JammerToSignal, IsOfTheJammedRadarsWhereAnotherIsNotJammed) {
  const scenario::Emitter jammer = jammerOf(100);
  auto scenario = duel(trackingRadar(), jammer, 0, 60e3);
  const double alone = east(scenario, "jammer_to_signal_db", 20e3);
  const double margin_db = east(scenario, "burn_through_margin_db", 20e3);
  scenario::Emitter unjammed = trackingRadar();
  unjammed.name = "unjammed";
  unjammed.frequency_hz *= 2;
  addEmitter(*scenario, middleOf(*scenario), unjammed);
  EXPECT_NEAR(east(scenario, "jammer_to_signal_db", 20e3), alone, 1e-3);
  EXPECT_LT(margin_db, 60);
  EXPECT_NEAR(east(scenario, "burn_through_margin_db", 20e3), 60, 1e-3) << "that radar sees the target";
}

}  // namespace
}  // namespace emscape::emfield
