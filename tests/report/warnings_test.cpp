// Warnings of many emitters as one line each kind.
#include "report/warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/files.h"

namespace emscape::report {
namespace {

using ::testing::ElementsAre;

TEST(JoinedWarnings, EmittersWithTheSameWarningAreNamedTogether) {
  EXPECT_THAT(
      joinedWarnings({"emitter 'a': far field from 120 m", "a warning of none",
                      "emitter 'b': far field from 80 m", "emitter 'a': off"}),
      ElementsAre("emitters 'a', 'b': far field from 120, 80 m", "a warning of none", "emitter 'a': off"));
}

TEST(JoinedWarnings, ThoseOfAReferenceAreJoinedOnTheirOwn) {
  EXPECT_THAT(joinedWarnings({"emitter 'a': far field from 120 m",
                              "the original scenario: emitter 'a': far field from 90 m",
                              "the original scenario: emitter 'b': far field from 80 m"}),
              ElementsAre("emitter 'a': far field from 120 m",
                          "the original scenario: emitters 'a', 'b': far field from 90, 80 m"));
}

TEST(JoinedWarnings, MoreThanFiveEmittersAreCounted) {
  std::vector<std::string> warnings;
  for (int i = 1; i <= 7; ++i)
    warnings.push_back("emitter 'e" + std::to_string(i) + "': reaches " + std::to_string(10 * i) + " km");
  EXPECT_THAT(joinedWarnings(warnings),
              ElementsAre("emitters 'e1', 'e2', 'e3', 'e4', 'e5' and 2 others: reaches 10 to 70 km"));
}

TEST(JoinedWarnings, TakesNamesAndTextsOfAnyLength) {
  const std::string name(200000, 'n'), text(200000, '5');
  const std::string warning = "emitter '" + name + "': " + text + " m";
  EXPECT_THAT(joinedWarnings({warning, warning}), ElementsAre(warning));
}

TEST(JoinedWarnings, OfMoreThanThreeThatDifferOnlyInNumbersTheFirstStands) {
  const auto warning = [](const std::string& gain) {
    return "gain_dbi=" + gain + ": the gain of " + gain + " dBi is low";
  };
  EXPECT_THAT(joinedWarnings({warning("-33"), warning("-32.5"), warning("1e-3")}),
              ElementsAre(warning("-33"), warning("-32.5"), warning("1e-3")));
  EXPECT_THAT(
      joinedWarnings({warning("-33"), warning("-32.5"), "another", warning("1e-3"), warning("2.5e+06")}),
      ElementsAre(warning("-33") + " (3 more with other numbers)", "another"));
}

TEST(WarningsOfResults, AreLoggedWithoutThoseOfTheCheckWhichWereLoggedWhenTheScenarioWasRead) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("quick.yaml"),
                                               {{"emitters.radar.antenna.gain_dbi", "-32"}});
  ASSERT_FALSE(warningsOf(*scenario).empty());
  const std::string warning = warningsOf(*scenario).front();
  EXPECT_THAT(withoutChecks({warning, "A and B: " + warning, "far field"}, {scenario}),
              ElementsAre("far field"));
}

}  // namespace
}  // namespace emscape::report
