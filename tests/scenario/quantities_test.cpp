#include "emscape/scenario/model/quantities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scenario/file/schema.h"
#include "tests/support/errors.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

TEST(Quantities, EqualQuantitiesOfScenarioSchema) {
  std::set<std::string> computed, asked;
  for (const QuantityInfo& entry : quantityTable()) computed.insert(entry.name);
  const ObjectSpec& output = *scenarioSpec().find("output", nullptr)->value.object;
  for (const std::string& name : output.find("quantities", nullptr)->value.item->choices) asked.insert(name);
  EXPECT_EQ(computed, asked);
}

TEST(Quantities, FollowOrderOfEnumeration) {
  for (std::size_t i = 0; i < quantityTable().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(quantityTable()[i].quantity), i);
    EXPECT_EQ(quantityFromName(quantityTable()[i].name), quantityTable()[i].quantity);
  }
}

TEST(Quantities, RefusesOthersWithTheNamesOfAll) {
  const std::string message = test::errorOf([] { quantityFromName("snr"); });
  EXPECT_THAT(message, HasSubstr("unknown quantity 'snr'; one of power_density_dbwm2, "));
  EXPECT_THAT(message, HasSubstr("burn_through_margin_db"));
}

// ICNIRP 2020, table 5.
TEST(ExposureLimits, EqualThePublishedTable) {
  const auto level = [](ExposureGroup group, double frequency_hz) {
    return referenceLevel_wm2(group, frequency_hz).value_or(-1);
  };
  struct Row {
    double frequency_hz, general_public_wm2, occupational_wm2;
  };
  for (const Row& row : {Row{100e6, 2, 10}, Row{400e6, 2, 10}, Row{900e6, 4.5, 22.5}, Row{2e9, 10, 50},
                         Row{3e9, 10, 50}, Row{300e9, 10, 50}, Row{99e3, -1, -1}, Row{301e9, -1, -1}}) {
    EXPECT_DOUBLE_EQ(level(ExposureGroup::general_public, row.frequency_hz), row.general_public_wm2);
    EXPECT_DOUBLE_EQ(level(ExposureGroup::occupational, row.frequency_hz), row.occupational_wm2);
  }
  // A plane wave with the electric field of 300 V/m or 660 V/m over (f / MHz)^0.7.
  EXPECT_NEAR(level(ExposureGroup::general_public, 1e6), 300 * 300 / 376.73, 1e-2);
  EXPECT_NEAR(level(ExposureGroup::occupational, 1e6), 660 * 660 / 376.73, 1e-2);
  EXPECT_NEAR(level(ExposureGroup::general_public, 30e6), 2, 0.04);
}

}  // namespace
}  // namespace emscape::scenario
