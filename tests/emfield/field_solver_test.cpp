// What the solver recomputes and keeps, and how it reports this.

#include "emscape/emfield/solver/field_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emfield/channels/categories.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "volume/labels.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kLatitude_deg = 12, kLongitude_deg = 34;

scenario::Emitter rotatingRadar(const std::string& name) {
  scenario::Emitter radar = plainEmitter(name, 0);
  radar.kind = scenario::EmitterKind::radar;
  radar.antenna = scenario::makeGaussian(30, 5, 10, -40);
  radar.scan.kind = scenario::ScanKind::rotate;
  radar.scan.rate_rpm = 10;
  radar.propagation.model = propagation::PropagationModel::horizon;
  return radar;
}

/// A rotating radar, a jammer on a track, a transmitter that is switched on from second 3 on, and a second
/// transmitter.
std::shared_ptr<scenario::Scenario> battlefield() {
  auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {40e3, 40e3, 4000}, {20, 22, 10});
  addEmitter(*scenario, {kLatitude_deg + 0.05, kLongitude_deg, 300}, rotatingRadar("radar"));

  scenario::Emitter jammer = plainEmitter("jammer", 0);
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.propagation.model = propagation::PropagationModel::horizon;
  addEmitter(*scenario, {kLatitude_deg, kLongitude_deg - 0.1, 500}, jammer);
  scenario::TrackPoint end = scenario->platforms.back().track.front();
  end.t_s = 10;
  end.position.longitude_deg += 0.02;
  scenario->platforms.back().track.push_back(end);

  scenario::Emitter radio = plainEmitter("radio", 0);
  radio.active_s = {{3, 100}};
  addEmitter(*scenario, {kLatitude_deg - 0.1, kLongitude_deg + 0.1, 200}, radio);
  addEmitter(*scenario, {kLatitude_deg + 0.1, kLongitude_deg + 0.1, 200}, plainEmitter("beacon", 0));
  return scenario;
}

UnsetVector<float> freshValues(const std::shared_ptr<scenario::Scenario>& scenario, double t_s) {
  SolvedField solver(scenario, nullptr, {}, t_s);
  return solver.volumes().front().host()->values;
}

/// Expects bit-identical fields.
void expectSameField(const UnsetVector<float>& a, const UnsetVector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) ASSERT_EQ(a[v], b[v]) << "voxel " << v;
}

TEST(FieldSolver, ReportsMovedAndTurnedEmitters) {
  const auto scenario = battlefield();
  FieldSolver solver(scenario, nullptr, {});
  const FieldChanged first = solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  EXPECT_TRUE(first.any);
  EXPECT_TRUE(first.grid);

  const FieldChanged second = solver.update(scenario::snapshotAt(scenario, nullptr, 1));
  EXPECT_TRUE(second.any);
  EXPECT_FALSE(second.grid);
  EXPECT_THAT(second.moved, ElementsAre(1));
  EXPECT_THAT(second.turned, ElementsAre(0));

  const FieldChanged switched_on = solver.update(scenario::snapshotAt(scenario, nullptr, 3));
  EXPECT_THAT(switched_on.moved, ElementsAre(1, 2));

  const FieldChanged again = solver.update(scenario::snapshotAt(scenario, nullptr, 3));
  EXPECT_FALSE(again.any);
}

TEST(FieldSolver, KeepsTheGeometryOfAnEmitterThatMovedLessThanTheTolerance) {
  const auto scenario = battlefield();
  FieldOptions options;
  options.move_tolerance_m = 1e5;
  SolvedField solver(scenario, nullptr, options);
  EXPECT_THAT(solver.update(scenario::snapshotAt(scenario, nullptr, 1)).moved, IsEmpty());
}

TEST(FieldSolver, UpdatesEqualNewSolver) {
  for (const auto combine : {scenario::CombineMode::sum, scenario::CombineMode::max}) {
    for (const char* quantity : {"power_density_dbwm2", "snr_db", "emitter_count", "dominant_emitter"}) {
      SCOPED_TRACE(quantity);
      const auto scenario = battlefield();
      scenario->output.combine = combine;
      scenario->output.quantities = {quantity};
      FieldSolver solver(scenario, nullptr, {});
      for (double t_s : {0.0, 0.5, 1.0, 2.9, 3.0, 3.5, 4.0, 4.5, 9.0, 0.0}) {
        solver.update(scenario::snapshotAt(scenario, nullptr, t_s));
        expectSameField(solver.volumes().front().host()->values, freshValues(scenario, t_s));
      }
    }
  }
}

TEST(FieldSolver, MemoryBoundKeepsTheField) {
  const auto scenario = battlefield();
  FieldOptions options;
  options.cache_bytes = 20 * 22 * 40 * 2 + 1;
  FieldSolver bounded(scenario, nullptr, options);
  for (double t_s : {0.0, 1.0, 3.0, 3.5}) {
    bounded.update(scenario::snapshotAt(scenario, nullptr, t_s));
    expectSameField(bounded.volumes().front().host()->values, freshValues(scenario, t_s));
  }
  EXPECT_EQ(bounded.memoryUse().uncached_emitters, 2);
}

TEST(FieldSolver, DoesNotDependOnTheNumberOfThreads) {
  const auto scenario = battlefield();
  setThreadLimit(1);
  const auto one = freshValues(scenario, 4);
  setThreadLimit(0);
  EXPECT_EQ(one, freshValues(scenario, 4));
}

TEST(FieldSolver, KeepsVolumesThatACallerHolds) {
  const auto scenario = battlefield();
  SolvedField solver(scenario);
  const auto kept = solver.volumes().front().host();
  const auto values = kept->values;
  for (double t_s : {1.0, 2.0, 3.0}) solver.update(scenario::snapshotAt(scenario, nullptr, t_s));
  EXPECT_EQ(kept->values, values);
  EXPECT_EQ(kept->info.time_s, 0);
}

TEST(FieldSolver, MakesOneVolumePerEmitterOrBand) {
  const auto scenario = battlefield();
  scenario->output.combine = scenario::CombineMode::per_emitter;
  scenario->output.quantities = {"power_density_dbwm2", "emitter_count"};
  EXPECT_THAT(channelsOf(*scenario, {}), SizeIs(5));
  EXPECT_EQ(channelsOf(*scenario, {})[1].name, "power_density_dbwm2:jammer");
  scenario->output.combine = scenario::CombineMode::per_band;
  EXPECT_THROW(channelsOf(*scenario, {}), Error);
  scenario->bands = {{"L", 1e9, 2e9}, {"S", 2e9, 4e9}};
  scenario->emitters[0].frequency_hz = 3e9;
  const auto channels = channelsOf(*scenario, {"power_density_dbwm2"});
  ASSERT_THAT(channels, SizeIs(2));
  EXPECT_THAT(channels[0].emitters, ElementsAre(1, 2, 3));
  EXPECT_THAT(channels[1].emitters, ElementsAre(0));
}

TEST(FieldSolver, OnlyTheChannelsOfAChangedEmitterAreNew) {
  const auto scenario = battlefield();
  scenario->output.combine = scenario::CombineMode::per_emitter;
  SolvedField solver(scenario);
  const auto before = solver.volumes();
  solver.update(scenario::snapshotAt(scenario, nullptr, 1));
  EXPECT_NE(solver.volumes()[0].dense(), before[0].dense()) << "the radar turned";
  EXPECT_EQ(solver.volumes()[3].dense(), before[3].dense()) << "the beacon did not";
  for (const volume::Volume& volume : solver.volumes()) EXPECT_EQ(volume.info().time_s, 1);
}

TEST(FieldSolver, UnchangedVolumesHaveTheTimeOfTheLastUpdate) {
  const auto scenario = battlefield();
  scenario->emitters = {scenario->emitters[3]};
  SolvedField solver(scenario);
  const auto before = solver.volumes();
  EXPECT_FALSE(solver.update(scenario::snapshotAt(scenario, nullptr, 1)).any);
  EXPECT_EQ(solver.volumes()[0].dense(), before[0].dense());
  EXPECT_EQ(solver.volumes()[0].info().time_s, 1);
  EXPECT_EQ(before[0].info().time_s, 0);
}

TEST(FieldSolver, DominantEmitterIsNearestOfEqualOnes) {
  auto scenario = emptyScenario(FrameKind::altitude, 0, 0, {20e3, 20e3, 2000}, {20, 20, 4});
  addEmitter(*scenario, {0, -0.05, 500}, plainEmitter("west", 0));
  addEmitter(*scenario, {0, 0.05, 500}, plainEmitter("east", 0));
  scenario->output.quantities = {"dominant_emitter"};
  const auto volume = solve(scenario);
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(valueAt(*volume, i, j, 1), i < 10 ? 0 : 1);
  }
  EXPECT_TRUE(volume->info.categorical);
  EXPECT_EQ(volume->info.extra.at("labels"), "west\neast");
}

TEST(FieldSolver, DominantModelBelongsToDominantEmitter) {
  auto scenario = emptyScenario(FrameKind::altitude, 0, 0, {20e3, 20e3, 2000}, {20, 20, 4});
  addEmitter(*scenario, {0, -0.05, 500}, plainEmitter("west", 0));
  addEmitter(*scenario, {0, 0.05, 500}, plainEmitter("east", 0));
  scenario->emitters[1].propagation.model = propagation::PropagationModel::diffraction;
  scenario->output.quantities = {"dominant_model"};
  const auto volume = solve(scenario);
  const std::vector<std::string> labels = volume::labelsOf(volume->info);
  const auto nameAt = [&](int i) {
    return labels.at(static_cast<std::size_t>(std::lround(valueAt(*volume, i, 9, 1))));
  };
  EXPECT_EQ(nameAt(3), "free_space");
  EXPECT_EQ(nameAt(16), "diffraction");
  EXPECT_TRUE(volume->info.categorical);
  std::vector<std::string> possible;
  for (const int index : categoriesOf(*scenario, scenario::Quantity::dominant_model))
    possible.push_back(labels.at(static_cast<std::size_t>(index)));
  EXPECT_THAT(possible, ::testing::ElementsAre("diffraction", "free_space"));
}

TEST(FieldSolver, ReceivedPowerDependsOnPolarizationAndBandwidth) {
  auto scenario = emptyScenario(FrameKind::altitude, 0, 0, {20e3, 20e3, 2000}, {20, 20, 4});
  scenario::Emitter emitter = plainEmitter("radio", 0);
  emitter.bandwidth_hz = 4e6;
  addEmitter(*scenario, {0, 0, 500}, emitter);
  scenario->output.quantities = {"received_power_dbm"};
  scenario->receivers = {scenario::ReceiverProfile{}};
  const float matched = valueAt(*solve(scenario), 3, 3, 1);
  scenario->receivers[0].bandwidth_hz = 1e6;
  EXPECT_NEAR(valueAt(*solve(scenario), 3, 3, 1) - matched, -10 * std::log10(4.0), 1e-4);
  scenario->receivers[0] = {};
  scenario->receivers[0].gain_dbi = 3;
  scenario->receivers[0].losses_db = 1;
  scenario->receivers[0].polarization = propagation::Polarization::slant_45;
  EXPECT_NEAR(valueAt(*solve(scenario), 3, 3, 1) - matched, 2 - 10 * std::log10(2.0), 1e-4);
  scenario->receivers[0] = {};
  scenario->receivers[0].polarization = propagation::Polarization::horizontal;
  EXPECT_NEAR(valueAt(*solve(scenario), 3, 3, 1) - matched, -scenario::kCrossPolarIsolation_db, 1e-4);
  scenario->receivers[0].polarization.reset();
  scenario->receivers[0].center_frequency_hz = 2e9;
  scenario->receivers[0].bandwidth_hz = 1e6;
  EXPECT_EQ(valueAt(*solve(scenario), 3, 3, 1), scenario->output.floor) << "another frequency";
}

TEST(FieldSolver, LaunchAnglesAreOfRefractedRays) {
  // A beam as narrow as the bending: at 200 km a level target is seen 200 km / 2 a (1 - 1/k) above the
  // straight line.
  auto scenario = emptyScenario(FrameKind::enu, 0, 0, {402e3, 6e3, 2000}, {201, 3, 2});
  const volume::Grid grid = gridOf(scenario->region);
  const GeodeticPosition site = GeoFrame(grid.frame).toGeodetic(grid.center_m(100, 1, 0));
  scenario::Emitter emitter = plainEmitter("radar", 0);
  emitter.antenna = scenario::makeGaussian(30, 2, 2, -80);
  emitter.scan.azimuth_deg = 90;
  addEmitter(*scenario, site, emitter);
  const double distance_m = 200e3;
  const double boresight_db = 60 - 10 * std::log10(4 * kPi * distance_m * distance_m);
  const double raised_deg = radToDeg(distance_m / (2 * 6356.75e3) * 0.25);
  const double loss_db = 4 * 10 * std::log10(2.0) * raised_deg * raised_deg / 4;
  EXPECT_NEAR(valueAt(*solve(scenario), 200, 1, 0), boresight_db - loss_db, 0.005);
  scenario->atmosphere.k_factor = 1;
  EXPECT_NEAR(valueAt(*solve(scenario), 200, 1, 0), boresight_db, 1e-4);
}

TEST(FieldSolver, CountsAndMarksTheNearField) {
  auto scenario = emptyScenario(FrameKind::altitude, 0, 0, {2e3, 2e3, 1000}, {20, 20, 10});
  scenario::Emitter emitter = plainEmitter("dish", 0);
  emitter.frequency_hz = 1e10;
  emitter.antenna = scenario::makeSinc(45, 0.8, 0.8, -60);
  addEmitter(*scenario, {0, 0, 500}, emitter);
  SolvedField solver(scenario);
  EXPECT_THAT(solver.warnings(), ElementsAre(HasSubstr("'dish': voxels closer than the far-field distance")));
  EXPECT_THAT(solver.volumes().front().host()->info.extra.at("near_field"), HasSubstr("dish: "));
}

TEST(FieldSolver, ComputesQuantitiesThatTheScenarioSchemaKnows) {
  const std::string schema = scenario::scenarioJsonSchema();
  for (const scenario::QuantityInfo& entry : scenario::quantityTable()) {
    EXPECT_THAT(schema, HasSubstr("\"" + std::string(entry.name) + "\""));
  }
}

TEST(FieldSolver, RefusesAFieldThatDoesNotFitIntoMemoryBeforeItComputes) {
  const auto scenario = battlefield();
  scenario->region.dims = {128, 128, 1024};
  scenario->output.combine = scenario::CombineMode::per_emitter;
  for (int n = 0; n < 2000; ++n) {  // half a TiB of volumes
    scenario->emitters.push_back(scenario->emitters.front());
    scenario->emitters.back().name += std::to_string(n);
  }
  const std::string error = test::errorOf([&] { FieldSolver solver(scenario, nullptr, {}); });
  EXPECT_THAT(error, HasSubstr("128 x 128 x 1024 voxels"));
  EXPECT_THAT(error, HasSubstr("MiB of the host's memory, of which"));
}

TEST(FieldSolver, RefusesInvalidRequests) {
  const auto scenario = battlefield();
  const auto messageOf = [&](const FieldOptions& options) {
    return test::errorOf([&] { FieldSolver solver(scenario, nullptr, options); });
  };
  FieldOptions options;
  options.quantities = {"power"};
  EXPECT_THAT(messageOf(options), HasSubstr("unknown quantity 'power'; one of power_density_dbwm2, "));
  options.quantities = {"received_power_dbm"};
  EXPECT_THAT(messageOf(options), HasSubstr("needs an entry under 'receivers'"));
  scenario->emitters[1].propagation.model = propagation::PropagationModel::itm;
  scenario->emitters[1].frequency_hz = 40e9;
  EXPECT_THAT(messageOf({}), HasSubstr("emitter 'jammer': 'itm': frequency 40000 MHz is outside"));
}

}  // namespace
}  // namespace emscape::emfield
