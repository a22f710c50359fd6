// Quantities of a receiver at every voxel against links to a receiver at that voxel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "emscape/emfield/link/link.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/errors.h"
#include "tests/support/on_backends.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;
using scenario::Scenario;
using ::testing::HasSubstr;

constexpr double kGainOfReceiver_dbi = 4;

/// A wanted mast, a neighbour half in the receiver's band, a jammer over all of the band, and a radio outside
/// it.
std::shared_ptr<Scenario> jammedMast(PropagationModel model) {
  auto scenario = emptyScenario(FrameKind::altitude, 44.3, -71.4, {20e3, 20e3, 2000}, {9, 8, 4});
  const auto add = [&](const char* name, double frequency_hz, double bandwidth_hz, double power_w,
                       double east_m, double north_m, scenario::AntennaPtr antenna) {
    scenario::Emitter emitter = plainEmitter(name, 0);
    emitter.frequency_hz = frequency_hz;
    emitter.bandwidth_hz = bandwidth_hz;
    emitter.power_w = power_w;
    emitter.antenna = std::move(antenna);
    emitter.propagation.model = model;
    emitter.scan.azimuth_deg = 35;
    addEmitter(*scenario, pointAt(*scenario, east_m, north_m), emitter);
  };
  add("neighbour", 450.02e6, 25e3, 5, -4e3, 3e3, scenario::makeGaussian(10, 40, 40, -25));
  add("mast", 450e6, 25e3, 20, 2e3, 1e3, scenario::makeIsotropic(2));
  add("jammer", 450e6, 1e6, 10, 3e3, -5e3, scenario::makeGaussian(8, 60, 60, -20));
  add("beside", 451e6, 25e3, 1000, 1e3, -1e3, scenario::makeIsotropic(0));
  scenario->emitters[2].kind = scenario::EmitterKind::jammer;
  scenario->emitters[2].polarization = propagation::Polarization::horizontal;
  scenario::ReceiverProfile receiver;
  receiver.name = "handset";
  receiver.gain_dbi = kGainOfReceiver_dbi;
  receiver.losses_db = 1;
  receiver.noise_figure_db = 7;
  receiver.bandwidth_hz = 30e3;
  receiver.polarization = propagation::Polarization::vertical;
  receiver.sensitivity_dbm = -105;
  scenario->receivers = {scenario::ReceiverProfile{}, receiver};
  scenario->output.receiver = 1;
  scenario->output.wanted_emitter = 1;
  scenario->output.quantities = {"sinr_db", "intercept_margin_db"};
  return scenario;
}

/// The scenario with its receiver on a platform at a voxel.
std::shared_ptr<Scenario> withReceiverAt(const Scenario& scenario, int i, int j, int k) {
  auto placed = std::make_shared<Scenario>(scenario);
  const volume::Grid grid = gridOf(scenario.region);
  const GeoFrame frame(grid.frame);
  const Vec3d center = grid.center_m(i, j, k);
  placed->platforms.push_back(fixedPlatform(frame.toGeodetic(center)));
  scenario::TrackPoint& point = placed->platforms.back().track.front();
  point.position.height_ellipsoid_m.reset();
  point.position.height_msl_m = frame.heightMsl_m(center);
  scenario::PlacedReceiver receiver;
  static_cast<scenario::ReceiverProfile&>(receiver) = scenario.receivers[scenario.output.receiver];
  receiver.platform = static_cast<int>(placed->platforms.size()) - 1;
  receiver.antenna = scenario::makeIsotropic(receiver.gain_dbi);
  placed->placed_receivers = {receiver};
  return placed;
}

class ReceiverQuantities : public test::OnBackends {
 protected:
  std::unique_ptr<FieldSolver> solve(const std::shared_ptr<Scenario>& scenario, double t_s = 0) {
    FieldOptions options;
    options.backend = GetParam();
    auto solver = std::make_unique<FieldSolver>(scenario, nullptr, options);
    solver->update(scenario::snapshotAt(scenario, nullptr, t_s));
    return solver;
  }
};

TEST_P(ReceiverQuantities, EqualLinkToTheVoxel) {
  for (const PropagationModel model : {PropagationModel::free_space, PropagationModel::two_ray}) {
    SCOPED_TRACE(toString(model));
    const auto scenario = jammedMast(model);
    const auto solver = solve(scenario);
    const auto sinr = solver->volumes()[0].host(), margin = solver->volumes()[1].host();
    double lowest_db = HUGE_VAL, highest_db = -HUGE_VAL;
    for (int j = 0; j < scenario->region.dims.y; j += 3) {
      for (int i = 0; i < scenario->region.dims.x; i += 2) {
        for (const int k : {0, 3}) {
          LinkOptions options;
          options.times_s = {0};
          options.emitters = {0, 1, 2, 3};
          options.receivers = {0};
          const LinkReport report = computeLinks(withReceiverAt(*scenario, i, j, k), nullptr, options);
          double largest_dbm = -HUGE_VAL;
          for (const Link& link : report.links) {
            largest_dbm = std::max(largest_dbm, link.rows[0].received_power_dbm);
            if (link.emitter != scenario->output.wanted_emitter) continue;
            EXPECT_NEAR(static_cast<double>(valueAt(*sinr, i, j, k)), link.rows[0].sinr_db, 0.02)
                << i << ", " << j << ", " << k;
            lowest_db = std::min(lowest_db, link.rows[0].sinr_db);
            highest_db = std::max(highest_db, link.rows[0].sinr_db);
          }
          EXPECT_NEAR(static_cast<double>(valueAt(*margin, i, j, k)), largest_dbm + 105, 0.02);
        }
      }
    }
    EXPECT_GT(highest_db - lowest_db, 10) << "the receivers must differ";
  }
}

TEST_P(ReceiverQuantities, OneTransmitterEqualsFriisOverNoise) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), plainEmitter("wanted", 0));
  scenario::ReceiverProfile receiver;
  receiver.noise_figure_db = 5;
  receiver.bandwidth_hz = 1e6;
  receiver.required_sinr_db = 12;
  scenario->receivers = {receiver};
  scenario->output.wanted_emitter = 0;
  scenario->output.quantities = {"sinr_db", "intercept_margin_db"};
  const auto solver = solve(scenario);
  const double noise_dbw = ratioToDb(kBoltzmann * 290 * 1e6) + 5;
  for (const double distance_m : {1e3, 7e3, 40e3}) {
    // ITU-R P.525-4, eq. (4)
    const double friis_dbw = 30 - 20 * std::log10(4 * kPi * distance_m / wavelength_m(1e9));
    const auto value = [&](std::size_t c) {
      return static_cast<double>(valueEast(*solver->volumes()[c].host(), distance_m));
    };
    EXPECT_NEAR(value(0), friis_dbw - noise_dbw, 1e-3);
    EXPECT_NEAR(value(1), friis_dbw - noise_dbw - 12, 1e-3);
  }
  EXPECT_EQ(solver->volumes()[0].info().extra.at(volume::kLegendNoteKey), "signal: wanted");
}

TEST_P(ReceiverQuantities, DoNotDependOnCombinationOfEmitters) {
  const auto scenario = jammedMast(PropagationModel::free_space);
  const auto of_sum = solve(scenario);
  for (const auto combine : {scenario::CombineMode::max, scenario::CombineMode::per_emitter}) {
    scenario->output.combine = combine;
    const auto solver = solve(scenario);
    EXPECT_EQ(solver->channels()[0].name, "sinr_db");
    EXPECT_EQ(solver->volumes()[0].host()->values, of_sum->volumes()[0].host()->values);
    if (combine == scenario::CombineMode::max) {
      EXPECT_EQ(solver->volumes()[1].host()->values, of_sum->volumes()[1].host()->values);
    } else {
      EXPECT_EQ(solver->channels()[3].name, "intercept_margin_db:jammer");
    }
  }
}

TEST_P(ReceiverQuantities, FollowBeamsAndSilentEmitters) {
  const auto scenario = jammedMast(PropagationModel::free_space);
  scenario->emitters[0].scan.kind = scenario::ScanKind::rotate;
  scenario->emitters[0].scan.rate_rpm = 5;
  scenario->emitters[2].active_s = {{2, 3}};
  const auto solver = solve(scenario);
  for (const double t_s : {1.0, 2.5, 4.0, 0.0}) {
    solver->update(scenario::snapshotAt(scenario, nullptr, t_s));
    const auto anew = solve(scenario, t_s);
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_EQ(solver->volumes()[c].host()->values, anew->volumes()[c].host()->values) << t_s;
  }
}

TEST_P(ReceiverQuantities, InterceptOverIntervalIsMaximum) {
  auto scenario = jammedMast(PropagationModel::free_space);
  scenario->output.quantities = {"intercept_margin_db"};
  scenario->emitters.resize(1);
  scenario->emitters[0].scan.kind = scenario::ScanKind::rotate;
  scenario->emitters[0].scan.rate_rpm = 5;
  std::vector<float> largest(static_cast<std::size_t>(gridOf(scenario->region).dims.count()), -HUGE_VALF);
  const auto solver = solve(scenario);
  for (int n = 0; n < 180; ++n) {  // a turn in steps of 2 degrees
    solver->update(scenario::snapshotAt(scenario, nullptr, 12.0 * n / 180));
    const UnsetVector<float> values = solver->volumes()[0].host()->values;
    for (std::size_t v = 0; v < values.size(); ++v) largest[v] = std::max(largest[v], values[v]);
  }
  scenario->output.interval = {scenario::IntervalKind::max_hold, {}, 1.0};
  const auto over = solve(scenario);
  const UnsetVector<float> found = over->volumes()[0].host()->values;
  for (std::size_t v = 0; v < found.size(); ++v) EXPECT_NEAR(found[v], largest[v], 0.1f);
}

EMSCAPE_ON_BACKENDS(ReceiverQuantities);

TEST(ReceiverQuantity, WithoutItsInputsIsRefused) {
  const auto scenario = jammedMast(PropagationModel::free_space);
  const auto messageOf = [&](const char* quantity) {
    FieldOptions options;
    options.quantities = {quantity};
    return test::errorOf([&] { FieldSolver solver(scenario, nullptr, options); });
  };
  scenario->output.wanted_emitter = -1;
  EXPECT_THAT(messageOf("sinr_db"), HasSubstr("sinr_db needs 'wanted_emitter' in the output"));
  scenario->output.wanted_emitter = 1;
  scenario->output.receiver = 0;
  EXPECT_THAT(messageOf("sinr_db"), HasSubstr("sinr_db needs the noise of the receiver ''"));
  EXPECT_THAT(messageOf("intercept_margin_db"), HasSubstr("needs a threshold"));
  scenario->output.receiver = 1;
  scenario->output.interval = {scenario::IntervalKind::mean, 1.0, {}};
  EXPECT_THAT(messageOf("sinr_db"), HasSubstr("no meaning over an interval"));
  EXPECT_THAT(messageOf("detection_age_s"), HasSubstr("needs an"));
  EXPECT_THAT(
      messageOf("emitter_count"),
      HasSubstr(
          "emitter_count has no meaning over an interval of kind mean; these have: power_density_dbwm2"));
}

}  // namespace
}  // namespace emscape::emfield
