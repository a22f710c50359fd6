// emscape compare: files, JSON keys on which other programs rely, and errors. The figures are tested in
// tests/study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

Arguments compare(const std::string& folder, const Arguments& more) {
  return joined({"compare", shippedScenario("jacksboro.yaml"), "-o", folder, "--cell", "500", "--times", "80",
                 "--heights", "agl:100"},
                more);
}

TEST(Compare, WritesMapsAReportAndAVolume) {
  const TemporaryFolder folder;
  const json report =
      json::parse(runWell(compare(folder / "out", {"--set-b", "emitters.jammer.power_w=1", "--set",
                                                   "region.dims=[20, 20, 10]", "--volume",
                                                   folder / "difference.vti", "--json", "--quiet"}))
                      .out);
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

TEST(Compare, SLOW_TwoRunsWriteTheSameBytes) {
  const TemporaryFolder first, second;
  for (const TemporaryFolder* folder : {&first, &second}) {
    const ProgramResult result =
        runWell(compare(*folder / "out", {"--set-b", "emitters.jammer.power_w=1", "--format", "png"}));
    EXPECT_THAT(result.out, StartsWith("B (A with emitters.jammer.power_w=1) against A (jacksboro): "));
  }
  ASSERT_EQ(first.files(), second.files());
  for (const std::string& file : first.files())
    EXPECT_EQ(readFile(first / file), readFile(second / file)) << file;
}

TEST(Compare, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const Arguments& more, int status) {
    return errorOfRun(compare(folder / "out", more), status);
  };
  EXPECT_THAT(errorOf({}, 2), HasSubstr("give a second scenario, or --set-b"));
  EXPECT_THAT(errorOf({"--set-b", "power"}, 2), HasSubstr("--set-b"));
  EXPECT_THAT(errorOf({"--set-b", "emitters.nobody.power_w=1"}, 3), HasSubstr("nobody"));
  EXPECT_THAT(errorOf({folder / "none.yaml"}, 3), HasSubstr("none.yaml"));
  EXPECT_THAT(errorOf({"--set-b", "emitters.jammer.power_w=1", "--products", "best"}, 2),
              HasSubstr("'best'"));
  EXPECT_THAT(errorOf({"--set-b", "emitters.jammer.power_w=1", "--products", "fraction"}, 2),
              HasSubstr("two times or more"));
  EXPECT_TRUE(folder.files().empty()) << "nothing is left behind";
}

/// `emscape coverage` into a folder.
/// @param more  options; they override those set here
void cover(const std::string& folder, const Arguments& more) {
  Arguments arguments{"coverage", shippedScenario("jacksboro.yaml"), "-o", folder, "--quiet"};
  const Arguments usual{"--cell",    "1000",    "--times",  "80", "--products", "covered,value,best",
                        "--heights", "agl:100", "--format", "cog"};
  for (std::size_t n = 0; n < usual.size(); n += 2) {
    if (std::find(more.begin(), more.end(), usual[n]) != more.end()) continue;
    arguments.insert(arguments.end(), {usual[n], usual[n + 1]});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  runWell(arguments);
}

TEST(Compare, SLOW_FoldersOfMapsHaveTheDifferencesOfTheirScenarios) {
  const TemporaryFolder folder;
  const Arguments same{"--cell", "500", "--products", "covered,value,best,min_height"};
  cover(folder / "a", same);
  Arguments changed = same;
  changed.insert(changed.end(), {"--set", "emitters.jammer.power_w=1"});
  cover(folder / "b", changed);
  const ProgramResult of_folders = runWell({"compare", folder / "a", folder / "b", "-o", folder / "out",
                                            "--json", "--quiet", "--format", "cog,gpkg,nc"});
  const ProgramResult of_scenarios =
      runWell(compare(folder / "solved", {"--set-b", "emitters.jammer.power_w=1", "--json", "--quiet",
                                          "--products", "covered,value,min_height", "--format", "cog"}));
  const json found = json::parse(of_folders.out), expected = json::parse(of_scenarios.out);
  EXPECT_EQ(found["comparison"], expected["comparison"]);
  EXPECT_EQ(found["changed_areas"], expected["changed_areas"]) << "explained by the scenarios";
  EXPECT_EQ(found["a"], expected["a"]);
  EXPECT_EQ(found["b"], expected["b"]);
  for (const char* map :
       {"covered_change_agl100m_t80s", "value_difference_agl100m_t80s", "min_height_difference_t80s"})
    EXPECT_TRUE(readFile(folder / ("out/maps/" + std::string(map) + ".tif")) ==
                readFile(folder / ("solved/maps/" + std::string(map) + ".tif")))
        << map;
  EXPECT_FALSE(readFile(folder / "out/maps/compare.gpkg").empty());

  const ProgramResult one = runWell({"compare", folder / "a", folder / "b", "-o", folder / "one", "--json",
                                     "--quiet", "--products", "value"});
  EXPECT_EQ(json::parse(one.out)["comparison"].size(), 1u);
}

TEST(Compare, SLOW_FoldersWithoutTheirScenariosAreComparedButNotExplained) {
  const TemporaryFolder folder;
  const std::string scenario = folder.write("own.yaml", readFile(shippedScenario("quick.yaml")));
  for (const char* power : {"10", "1000"}) {
    const ProgramResult result =
        runWell({"coverage", scenario, "-o", folder / power, "--cell", "1000", "--quantity",
                 "power_density_dbwm2", "--threshold", "-60", "--format", "cog", "--quiet", "--set",
                 "emitters.transmitter.power_w=" + std::string(power)});
  }
  std::filesystem::remove(scenario);
  json study = json::parse(readFile(folder / "10/study.json"));
  study["scenarios"][0]["path"] = std::string(300, 'a');  // longer than a file's name can be
  writeFile(folder / "10/study.json", study.dump());
  const ProgramResult result =
      runWell({"compare", folder / "10", folder / "1000", "-o", folder / "out", "--quiet"});
  EXPECT_THAT(result.err, HasSubstr("own.yaml or one of its files is not there or has changed"));
  EXPECT_THAT(result.out, testing::AllOf(HasSubstr("Gained: "), testing::Not(HasSubstr("No emitter"))));
  EXPECT_THAT(readFile(folder / "out/report.html"), HasSubstr("Largest areas that changed"));
}

TEST(Compare, SLOW_FoldersWhoseTimesDifferByARoundingErrorMatch) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) cover(folder / name, {"--times", "0:0.3:0.1", "--products", "value"});
  EXPECT_THAT(folder.files(), testing::Contains("a/maps/value_agl100m_t0.3s.tif"));
  std::string report = readFile(folder / "b/report.json");
  const std::string time = "\"time_s\": 0.3,";
  ASSERT_NE(report.find(time), std::string::npos);
  report.replace(report.find(time), time.size(), "\"time_s\": 0.30000000000000004,");
  writeFile(folder / "b/report.json", report);
  for (const Arguments& order : {Arguments{"a", "b"}, {"b", "a"}}) {
    const ProgramResult result = runWell({"compare", folder / order[0], folder / order[1], "-o",
                                          folder / "out", "--times", "0.3", "--quiet", "--json"});
    EXPECT_EQ(json::parse(result.out)["comparison"].size(), 1u);
  }
}

TEST(Compare, SLOW_RefusesIncompatibleFolders) {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& name, const Arguments& more) { cover(folder / name, more); };
  with("a", {});
  const auto errorOf = [&](const std::string& b, const Arguments& more, int status) {
    return errorOfRun(joined({"compare", folder / "a", folder / b, "-o", folder / "out", "--quiet"}, more),
                      status);
  };
  with("cell", {"--cell", "2000"});
  EXPECT_THAT(errorOf("cell", {}, 3), testing::AllOf(HasSubstr("/cell: the grid of pixels differs from "),
                                                     HasSubstr("of 2000 m in EPSG:32616"),
                                                     HasSubstr("same --area, --cell and --crs")));
  with("threshold", {"--threshold", "0.8"});
  EXPECT_THAT(errorOf("threshold", {}, 3),
              HasSubstr("the threshold of covered at 100 m above ground, t = 80 s differs from"));
  EXPECT_EQ(errorOf("threshold", {"--products", "value"}, 0), "") << "it has no threshold";
  with("quantity", {"--quantity", "snr_db", "--threshold", "13"});
  EXPECT_THAT(errorOf("quantity", {}, 3), HasSubstr("the quantity differs from"));
  with("heights", {"--heights", "agl:50"});
  EXPECT_THAT(errorOf("heights", {}, 3),
              HasSubstr("has no map of covered at 100 m above ground, t = 80 s, which"));
  with("pictures", {"--format", "png"});
  EXPECT_THAT(errorOf("pictures", {}, 3), HasSubstr("has no GeoTIFFs"));
  EXPECT_THAT(errorOf("none", {}, 3), HasSubstr("none: there is no such file or folder"));
  folder.write("file", "");
  EXPECT_THAT(errorOf("file", {}, 2), HasSubstr("is a folder and"));
  const std::string report = readFile(folder / "a/report.json");
  EXPECT_THAT(errorOfRun({"compare", folder / "a", folder / "a", "-o", folder / "a/."}, 2),
              HasSubstr("is one of the folders to compare"));
  EXPECT_EQ(readFile(folder / "a/report.json"), report);
  EXPECT_THAT(errorOf("a", {"--products", "best"}, 2), HasSubstr("'best'"));
  EXPECT_THAT(errorOf("a", {"--products", "count"}, 2),
              HasSubstr("/a has no map of count; it has covered, value"));
  EXPECT_THAT(errorOf("a", {"--heights", "agl:77"}, 2),
              HasSubstr("/a has no map at 77 m above ground; it has 100 m above ground"));
  EXPECT_THAT(errorOf("a", {"--times", "3"}, 2), HasSubstr("/a has no map at these times; it has 80 s"));
  for (const Arguments& option : {Arguments{"--cell", "200"}, {"--set-b", "a=1"}, {"--quantity", "snr_db"}})
    EXPECT_THAT(errorOf("a", option, 2), HasSubstr(option[0] + ": does not go with folders of maps"));
  std::filesystem::remove_all(folder / "out");
  std::filesystem::create_directories(folder / "empty");
  EXPECT_THAT(errorOf("empty", {}, 3), HasSubstr("report.json: there is no such file"));
  writeFile(folder / "heights/report.json", "{}");
  EXPECT_THAT(errorOf("heights", {}, 3),
              HasSubstr("report.json: key 'quantity' not found: not a report of emscape coverage"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace emscape::test
