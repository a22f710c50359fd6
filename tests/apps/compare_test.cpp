// emscape compare: files, the keys that others rely on, and what is refused. The figures are study's tests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Arguments compare(const std::string& folder, const Arguments& more) {
  Arguments arguments{"compare",   shippedScenario("jacksboro.yaml"),
                      "-o",        folder,
                      "--cell",    "500",
                      "--times",   "80",
                      "--heights", "agl:100"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Compare, WritesMapsAReportAndAVolume) {
  const TemporaryFolder folder;
  const ProgramResult result = run(
      compare(folder / "out", {"--set-b", "emitters.jammer.power_w=1", "--set", "region.dims=[20, 20, 10]",
                               "--volume", folder / "difference.vti", "--json", "--quiet"}));
  ASSERT_EQ(result.status, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report, json::parse(readFile(folder / "out/report.json")));
  for (const char* key : {"a", "b", "comparison", "changed_areas", "maps", "warnings"})
    EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_EQ(report["b"]["set"].size(), 2u);
  ASSERT_EQ(report["comparison"].size(), 2u);
  EXPECT_GT(report["comparison"][0]["gained_km2"], 1.0);
  EXPECT_EQ(report["comparison"][0]["lost_km2"], 0.0);
  EXPECT_GE(report["comparison"][1]["min_difference"], 0.0);
  ASSERT_GT(report["changed_areas"].size(), 0u);
  EXPECT_EQ(report["changed_areas"][0]["change"], "gained");
  for (const char* file : {"maps/covered_change_agl100m_t80s.tif", "maps/value_difference_agl100m_t80s.png",
                           "report.html", "study.json"})
    EXPECT_FALSE(readFile(folder / ("out/" + std::string(file))).empty()) << file;
  EXPECT_THAT(readFile(folder / "out/report.html"), HasSubstr("Gained and lost"));
  EXPECT_FALSE(readFile(folder / "difference.vti").empty());
}

TEST(Compare, TwoRunsWriteTheSameBytes) {
  const TemporaryFolder first, second;
  for (const TemporaryFolder* folder : {&first, &second}) {
    const ProgramResult result =
        run(compare(*folder / "out", {"--set-b", "emitters.jammer.power_w=1", "--format", "png"}));
    ASSERT_EQ(result.status, 0) << result.err;
  }
  ASSERT_EQ(first.files(), second.files());
  for (const std::string& file : first.files())
    EXPECT_EQ(readFile(first / file), readFile(second / file)) << file;
}

TEST(Compare, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const Arguments& more, int status) {
    const ProgramResult result = run(compare(folder / "out", more));
    EXPECT_EQ(result.status, status) << result.err;
    return result.err;
  };
  EXPECT_THAT(errorOf({}, 2), HasSubstr("give a second scenario, or --set-b"));
  EXPECT_THAT(errorOf({"--set-b", "power"}, 2), HasSubstr("--set-b"));
  EXPECT_THAT(errorOf({"--set-b", "emitters.nobody.power_w=1"}, 3), HasSubstr("nobody"));
  EXPECT_THAT(errorOf({folder / "none.yaml"}, 3), HasSubstr("none.yaml"));
  EXPECT_TRUE(folder.files().empty()) << "nothing is left behind";
  EXPECT_THAT(errorOf({"--set-b", "emitters.jammer.power_w=1", "--products", "best"}, 2),
              HasSubstr("'best'"));
}

}  // namespace
}  // namespace emscape::test
