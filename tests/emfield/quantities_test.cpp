#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace emscape::emfield
