#include <gtest/gtest.h>

#include <algorithm>

#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

TEST(Quantities, JammingScenarioShowsShadowOfRidge) {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jamming.yaml")));
  scenario->region.dims = {40, 40, 16};
  const auto terrain = scenario::loadTerrain(*scenario);
  FieldSolver solver(scenario, terrain, {});
  const auto covered = [&](double t_s) {
    solver.update(scenario::snapshotAt(scenario, terrain.get(), t_s));
    const UnsetVector<float> values = solver.volumes()[0].host()->values;
    return std::count_if(values.begin(), values.end(), [](float pd) { return pd > 0.5f; });
  };
  const auto unjammed = [&] {
    return solver.volumes()[1].host()->info.range_max == solver.volumes()[1].host()->info.floor;
  };
  const auto hidden = covered(0);
  EXPECT_TRUE(unjammed()) << "the ridge hides the jammer";
  const auto risen = covered(40);
  EXPECT_FALSE(unjammed());
  EXPECT_GT(hidden, 1000);
  EXPECT_LT(risen, hidden / 5);
  EXPECT_GT(risen, 0);
  EXPECT_EQ(covered(0), hidden);
}

/// A radar of 100 kW, 1 % of the time, at 3 GHz, and a transmitter of 1 kW at 100 MHz, both isotropic.
std::shared_ptr<scenario::Scenario> twoThatExpose() {
  auto scenario = testing::lineOfVoxels(2000, 100);
  scenario::Emitter radar = testing::plainEmitter("radar", 0), mast = testing::plainEmitter("mast", 0);
  radar.kind = scenario::EmitterKind::radar;
  radar.frequency_hz = 3e9;
  radar.power_w = 100e3;
  radar.waveform = scenario::Waveform{1000, 10e-6, std::nullopt};
  mast.frequency_hz = 100e6;
  testing::addEmitter(*scenario, testing::middleOf(*scenario), radar);
  testing::addEmitter(*scenario, testing::middleOf(*scenario), mast);
  scenario->output.quantities = {"exposure_ratio"};
  return scenario;
}

TEST(ExposureRatio, IsTheSumOfMeanDensitiesOverTheirReferenceLevels) {
  const auto scenario = twoThatExpose();
  const double area_m2 = 4 * kPi * 500 * 500;
  const auto at500m = [&] { return double(testing::valueEast(*testing::solve(scenario), 500)); };
  const double general_public = 1000 / area_m2 / 10 + 1000 / area_m2 / 2;
  EXPECT_NEAR(at500m(), general_public, 1e-4 * general_public);
  scenario->output.exposure_group = scenario::ExposureGroup::occupational;
  EXPECT_NEAR(at500m(), general_public / 5, 1e-4 * general_public / 5);
  scenario->output.exposure_group = scenario::ExposureGroup::general_public;
  scenario->output.combine = scenario::CombineMode::max;
  EXPECT_NEAR(at500m(), 1000 / area_m2 / 2, 1e-4 * general_public);
}

TEST(ExposureRatio, OfAnIntervalIsThatOfTheMeanPowerDensity) {
  const auto scenario = twoThatExpose();
  scenario->emitters.pop_back();
  scenario->emitters[0].antenna = scenario::makeGaussian(30, 2, 5, -30);
  scenario->emitters[0].scan.kind = scenario::ScanKind::rotate;
  scenario->emitters[0].scan.rate_rpm = 10;
  scenario->output.interval = {scenario::IntervalKind::mean, {}, 1.0};
  const double ratio = double(testing::valueEast(*testing::solve(scenario), 500));
  scenario->output.quantities = {"mean_power_density_dbwm2"};
  const double density_wm2 = dbToRatio(double(testing::valueEast(*testing::solve(scenario), 500)));
  EXPECT_NEAR(ratio, density_wm2 / 10, 1e-4 * ratio);
}

TEST(ExposureRatio, EqualsTheBudgetOfAPath) {
  const auto scenario = twoThatExpose();
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const volume::Grid grid = gridOf(scenario->region);
  const Vec3d center_m = grid.center_m(grid.dims.x / 2 + 5, grid.dims.y / 2, 0);
  const GeoFrame frame(grid.frame);
  const PathEnd end{frame.toGeodetic(center_m), frame.heightMsl_m(center_m)};
  const float found = testing::valueEast(*testing::solve(scenario), 500);
  double of_paths = 0;
  for (const int e : {0, 1})
    of_paths += pathBudget(snapshot, e, end,
                           scenario->emitters[static_cast<std::size_t>(e)].propagation.model, nullptr)
                    .find("exposure_ratio")
                    ->value;
  EXPECT_NEAR(double(found), of_paths, 1e-4 * of_paths);
}

TEST(ExposureRatio, IsRefusedWhereThereIsNoReferenceLevel) {
  const auto scenario = twoThatExpose();
  scenario->emitters[1].frequency_hz = 50e3;
  const std::string message = test::errorOf([&] { testing::solve(scenario); });
  EXPECT_NE(
      message.find("reference levels from 100 kHz to 300 GHz, not at the 50000 Hz of the emitter 'mast'"),
      std::string::npos)
      << message;
}

}  // namespace
}  // namespace emscape::emfield
