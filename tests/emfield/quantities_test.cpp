#include "emscape/emfield/quantities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "emscape/emfield/field_solver.h"
#include "emscape/scenario/scenario_file.h"
#include "scenario/schema.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using ::testing::HasSubstr;

TEST(Quantities, AreThoseThatAScenarioMayAskFor) {
  std::set<std::string> computed, asked;
  for (const QuantityInfo& entry : quantityTable()) computed.insert(entry.name);
  const scenario::ObjectSpec& output = *scenario::scenarioSpec().find("output", nullptr)->value.object;
  for (const std::string& name : output.find("quantities", nullptr)->value.item->choices) asked.insert(name);
  EXPECT_EQ(computed, asked);
}

TEST(Quantities, StandInTheOrderOfTheEnumeration) {
  for (std::size_t i = 0; i < quantityTable().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(quantityTable()[i].quantity), i);
    EXPECT_EQ(quantityFromName(quantityTable()[i].name), quantityTable()[i].quantity);
  }
}

TEST(Quantities, RefusesOthersWithTheNamesOfAll) {
  const std::string error = test::errorOf([] { quantityFromName("snr"); });
  EXPECT_THAT(error, HasSubstr("unknown quantity 'snr'; one of power_density_dbwm2, "));
  EXPECT_THAT(error, HasSubstr("burn_through_margin_db"));
}

TEST(Quantities, OfTheJammingScenarioShowWhatTheRidgeHides) {
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jamming.yaml")));
  scenario->region.dims = {40, 40, 16};
  const auto terrain = scenario::loadTerrain(*scenario);
  FieldSolver solver(scenario, terrain, {});
  const auto covered = [&](double t_s) {
    solver.update(scenario::snapshotAt(scenario, terrain.get(), t_s));
    const std::vector<float>& values = solver.volumes()[0].host()->values;
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
