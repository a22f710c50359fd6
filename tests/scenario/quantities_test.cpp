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

}  // namespace
}  // namespace emscape::scenario
