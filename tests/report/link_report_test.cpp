// Links by the names of their ends.
#include "report/paths/link_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(LinkOptions, ReceiversAloneExcludeTheTargets) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("links.yaml"));
  const std::string receiver = scenario->placed_receivers.front().name;
  const emfield::LinkOptions all = linkOptions(*scenario, {}),
                             some = linkOptions(*scenario, {"", "", {}, {receiver}, {}, ""});
  EXPECT_THAT(all.targets, Not(IsEmpty()));
  EXPECT_EQ(some.receivers, std::vector<int>{0});
  EXPECT_THAT(some.targets, IsEmpty());
  EXPECT_EQ(some.emitters.size(), scenario->emitters.size());
}

TEST(LinkOptions, UnknownNameIsRefusedWithTheExistingOnes) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("links.yaml"));
  EXPECT_THAT(test::errorOf([&] {
                linkOptions(*scenario, {"--", "", {"nobody"}, {}, {}, ""});
              }),
              HasSubstr("--emitter: no emitter 'nobody' in " + scenario->file + "; it has '"));
}

TEST(Links, ScenarioWithoutThemIsRefused) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("quick.yaml"));
  EXPECT_THAT(test::errorOf([&] { computeLinks(scenario, linkOptions(*scenario, {}), {}); }),
              HasSubstr("there is no link"));
}

TEST(Links, TellOfLooksBetweenTwoTimesAndPrintAllLooksSinceTheLastPrintedRow) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("links.yaml"),
                                               {{"emitters.search radar.receiver.bandwidth_hz", "1"}});
  const auto textOf = [&](const std::string& times) {
    NamedLinks links{scenario->file, scenario, {}};
    const emfield::LinkOptions options =
        linkOptions(*scenario, {"--", times, {"search radar"}, {}, {scenario->targets.front().name}, ""});
    links.report = computeLinks(scenario, options, {});
    EXPECT_THAT(links.report.warnings, ::testing::Contains(HasSubstr("is 1 Hz wide"))) << "of the check";
    std::string text = linksText(links);
    for (const std::string& warning : links.report.warnings) text += warning + "\n";
    return text;
  };
  EXPECT_THAT(textOf("0:40:20"), HasSubstr(" looks, one every "));
  const std::string fine = textOf("0:60:0.5");
  EXPECT_THAT(fine, Not(HasSubstr(" looks, one every ")));
  EXPECT_THAT(fine, HasSubstr("0.5 from s"));
}

}  // namespace
}  // namespace emscape::report
