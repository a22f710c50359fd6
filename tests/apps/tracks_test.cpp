// emscape vertical and exposure: files, JSON keys on which other programs rely, and errors. The figures are
// tested in tests/study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

Arguments vertical(const Arguments& more) {
  return joined({"vertical", shippedScenario("jacksboro.yaml"), "--azimuth", "30,150", "--grid", "60,40"},
                more);
}

Arguments exposure(const Arguments& more) {
  return joined({"exposure", shippedScenario("links.yaml"), "--times", "0:60:10"}, more);
}

/// Runs twice, into two folders; the four files must be the same.
void expectSameTwice(const TemporaryFolder& folder, const std::function<Arguments(const std::string&)>& of) {
  for (const char* run_name : {"one", "two"}) {
    std::filesystem::create_directories(folder / run_name);
    runWell(of(folder / run_name));
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "one")) {
    const std::string name = entry.path().filename();
    EXPECT_EQ(readFile(entry.path()), readFile(folder / ("two/" + name))) << name;
    ++files;
  }
  EXPECT_EQ(files, 4);
}

TEST(Vertical, WritesFilesOfEachKindAndTheSameOnesAgain) {
  const TemporaryFolder folder;
  expectSameTwice(folder, [](const std::string& out) {
    return vertical({"--emitter", "search radar", "--quiet", "-o", out + "/a.png", "-o", out + "/a.svg", "-o",
                     out + "/a.csv", "-o", out + "/a.json"});
  });
  EXPECT_THAT(
      readFile(folder / "one/a.csv"),
      StartsWith("kind,azimuth_deg,line,range_m,slant_range_m,elevation_deg,height_msl_m,height_agl_m,"
                 "detection_probability\n"));
  EXPECT_THAT(readFile(folder / "one/a.csv"), HasSubstr("\ncontour,30,0,"));
  const json diagram = json::parse(readFile(folder / "one/a.json"));
  for (const char* key : {"scenario", "emitter", "quantity", "threshold", "station_msl_m", "k_factor",
                          "range_m", "height_msl_m", "azimuths", "warnings"})
    EXPECT_TRUE(diagram.contains(key)) << key;
  ASSERT_EQ(diagram["azimuths"].size(), 2u);
  EXPECT_EQ(diagram["azimuths"][1]["values"].size(), 60u * 40u);
  EXPECT_GT(diagram["azimuths"][0]["contours"].size(), 0u);
}

TEST(Vertical, ABlakeChartHasTheContourOfFreeSpace) {
  const TemporaryFolder folder;
  const json chart = json::parse(runWell(vertical({"--emitter", "search radar", "--blake", "--range",
                                                   "100000", "-o", folder / "b.svg", "--json", "--quiet"}))
                                     .out);
  EXPECT_TRUE(chart["smooth_earth"]);
  EXPECT_NEAR(chart["station_msl_m"], 15, 0.01) << "above the smooth surface";
  EXPECT_GT(chart["azimuths"][0]["free_space"].size(), 0u);
  EXPECT_THAT(readFile(folder / "b.svg"), HasSubstr("<svg"));
}

TEST(Vertical, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const Arguments& more, int status) { return errorOfRun(vertical(more), status); };
  const std::string file = folder / "a.png";
  EXPECT_THAT(errorOf({"--emitter", "radar", "-o", file}, 2), HasSubstr("no emitter 'radar'"));
  EXPECT_THAT(errorOf({"--emitter", "jammer", "-o", file}, 2), HasSubstr("--threshold"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", folder / "a.gif"}, 2), HasSubstr(".png, .svg"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", file, "--threshold", "1.5"}, 2),
              HasSubstr("between 0 and 1"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", file, "--range", "5"}, 2),
              HasSubstr("--range: '5' must be a number from 100 to 1990000\n"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", folder / "none/a.png"}, 1),
              HasSubstr("none/a.png"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", file, "--azimuth", "390"}, 2),
              HasSubstr("--azimuth"));
  EXPECT_THAT(errorOf({"--emitter", "search radar", "-o", file, "--azimuth", "-330"}, 2),
              HasSubstr("--azimuth: 30 and -330 are one direction; give each once"));
  EXPECT_THAT(
      errorOf({"--emitter", "search radar", "-o", folder / "none/a.png", "--areps", folder / "areps"}, 1),
      HasSubstr("none/a.png"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing is left behind, not even a folder";
}

TEST(Exposure, WritesFilesOfEachKindAndTheSameOnesAgain) {
  const TemporaryFolder folder;
  expectSameTwice(folder, [](const std::string& out) {
    return exposure({"--platform", "helicopter", "--quiet", "-o", out + "/a.png", "-o", out + "/a.svg", "-o",
                     out + "/a.csv", "-o", out + "/a.json"});
  });
  EXPECT_THAT(readFile(folder / "one/a.csv"),
              StartsWith("time_s,latitude_deg,longitude_deg,height_msl_m,height_agl_m,detection_probability,"
                         "search radar,best,cumulative_probability,state,decides\n0,"));
  const json report = json::parse(readFile(folder / "one/a.json"));
  for (const char* key : {"scenario", "platform", "quantity", "threshold", "radar_look", "cross_section",
                          "emitters", "together", "each", "rows", "warnings"})
    EXPECT_TRUE(report.contains(key)) << key;
  ASSERT_EQ(report["rows"].size(), 7u);
  for (const char* key : {"max", "max_time_s", "first_s", "fraction", "unknown_fraction", "longest_gap_s",
                          "cumulative_probability"})
    EXPECT_TRUE(report["together"].contains(key)) << key;
}

TEST(Exposure, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const Arguments& more, int status) {
    Arguments arguments = more;
    arguments.insert(arguments.end(), {"-o", folder / "a.json"});
    return errorOfRun(exposure(arguments), status);
  };
  EXPECT_THAT(errorOf({"--platform", "ship"}, 2), HasSubstr("no platform 'ship'"));
  EXPECT_THAT(errorOf({"--platform", "drone", "--rcs-target", "ship"}, 2), HasSubstr("no target 'ship'"));
  EXPECT_THAT(errorOf({"--platform", "drone", "--rcs-target", "helicopter"}, 2), HasSubstr("not on 'drone'"));
  EXPECT_THAT(errorOf({"--platform", "drone", "--quantity", "snr_db"}, 2), HasSubstr("--threshold"));
  EXPECT_THAT(errorOf({"--platform", "drone", "--look", "away"}, 2), HasSubstr("--look"));
  EXPECT_TRUE(folder.files().empty()) << "nothing is left behind";
}

}  // namespace
}  // namespace emscape::test
