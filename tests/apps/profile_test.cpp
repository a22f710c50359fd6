// emscape profile: JSON keys on which other programs rely, pictures, and errors. The figures are tested in
// tests/emfield.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string& jacksboro() {
  static const std::string file = shippedScenario("jacksboro.yaml");
  return file;
}

/// The point is behind the ridge as seen from the jammer at 40 s.
Arguments blockedPath(const Arguments& more = {}) {
  return joined(
      {"profile", jacksboro(), "--emitter", "jammer", "--time", "40", "--to", "36.27,-84.24167,15", "--agl"},
      more);
}

TEST(Profile, JsonHasContractKeys) {
  const json report = json::parse(runWell(blockedPath({"--json", "--model", "diffraction,free_space"})).out);
  for (const char* key : {"scenario", "emitter", "time_s", "time_utc", "active", "frequency_hz", "from", "to",
                          "geometry", "obstacles", "model", "model_why", "excess_db", "excess_parts_db",
                          "budget", "compared", "warnings", "verdict", "profile"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report["emitter"], "jammer");
  EXPECT_EQ(report["time_s"], 40);
  EXPECT_NEAR(report["to"]["height_agl_m"].get<double>(), 15, 0.1);
  EXPECT_NEAR(report["geometry"]["range_m"].get<double>(), 6515, 20);
  ASSERT_FALSE(report["obstacles"].empty());
  int deciding = 0;
  for (const json& obstacle : report["obstacles"]) deciding += obstacle["decides"].get<bool>() ? 1 : 0;
  EXPECT_EQ(deciding, 1);
  EXPECT_LT(report["obstacles"][0]["clearance_m"], 0);
  EXPECT_TRUE(report["budget"].contains("power_density_dbwm2"));
  EXPECT_TRUE(report["budget"].contains("received_power_dbm"));
  ASSERT_EQ(report["compared"].size(), 2u);
  EXPECT_GT(report["compared"][0]["excess_db"], 20);
  EXPECT_EQ(report["compared"][1]["excess_db"], 0);
  EXPECT_THAT(report["verdict"].get<std::string>(), HasSubstr("Blocked: the terrain at "));
  EXPECT_EQ(report["profile"]["range_m"].size(), report["profile"]["ground_msl_m"].size());
}

TEST(Profile, ATableEndsWithTheVerdict) {
  const ProgramResult result = runWell(blockedPath());
  for (const char* part :
       {"Geometry", "Obstacles", "Budget by '", "EIRP along the ray", "decides", "Blocked: "})
    EXPECT_THAT(result.out, HasSubstr(part));
  EXPECT_EQ(result.out.find('\n', result.out.find("\nBlocked: ") + 1), result.out.size() - 1);
}

TEST(Profile, WithoutAnEpochATimeIsInSecondsAlone) {
  const TemporaryFolder folder;
  const std::string epoch = "epoch: 2026-06-01T06:00:00Z\n";
  std::string text = readFile(quick());
  const auto firstLine = [&](const std::string& scenario) {
    const ProgramResult result =
        run({"profile", folder.write("a.yaml", scenario), "--emitter", "radar", "--to", "52.05,5,500"});
    return result.out.substr(0, result.out.find('\n'));
  };
  EXPECT_EQ(firstLine(text), "Path from 'radar' at t = 0 s (2026-06-01T06:00:00.000Z), 3 GHz");
  EXPECT_EQ(firstLine(text.erase(text.find(epoch), epoch.size())), "Path from 'radar' at t = 0 s, 3 GHz");
}

TEST(Profile, RadarReportsDetection) {
  const json budget = json::parse(
      runWell({"profile", jacksboro(), "--emitter", "search radar", "--to", "36.35,-84.25,900", "--json"})
          .out)["budget"];
  for (const char* key : {"snr_db", "required_snr_db", "detection_probability"})
    EXPECT_TRUE(budget.contains(key)) << key;
}

TEST(Profile, DrawsPicturesOfEitherKind) {
  const TemporaryFolder folder;
  const ProgramResult png = runWell(blockedPath({"--plot", folder / "path.png", "--size", "700x400"}));
  EXPECT_EQ(readFile(folder / "path.png").substr(1, 3), "PNG");
  const ProgramResult svg = runWell(blockedPath({"--plot", folder / "path.svg"}));
  EXPECT_THAT(readFile(folder / "path.svg"), testing::AllOf(HasSubstr("<svg"), HasSubstr("</svg>")));
  EXPECT_EQ(folder.files().size(), 2u);
}

TEST(Profile, RefusesInvalidPathsWithOneError) {
  struct Case {
    const char* emitter;
    const char* to;
    int status;
    const char* message;
  };
  const Case cases[] = {
      {"nobody", "36.35,-84.25,900", 2, "--emitter: no emitter 'nobody' in "},
      {"nobody", "36.35,-84.25,900", 2,
       "it has 'search radar', 'tracking radar', 'communications mast', 'jammer'"},
      {"jammer", "36.35,-84.25", 2, "--to '36.35,-84.25' is not LAT,LON,HEIGHT"},
      {"jammer", "36.35,x,900", 2, "--to '36.35,x,900' is not LAT,LON,HEIGHT"},
      {"jammer", "96,-84.25,900", 2, "latitude -90..90 deg"},
      {"jammer", "36.35,-84.25,900,1", 2, "is not LAT,LON,HEIGHT"},
      {"jammer", "36.35,-84.25,10", 3, "m below the ground there"},
      {"jammer", "38.35,-84.25,9000", 3, "terrain is missing on the path, "},
  };
  for (const Case& c : cases) {
    const ProgramResult result = run({"profile", jacksboro(), "--emitter", c.emitter, "--to", c.to});
    EXPECT_EQ(result.status, c.status) << c.to;
    EXPECT_THAT(result.err, HasSubstr(c.message));
    EXPECT_EQ(result.out, "");
  }
}

TEST(Profile, RefusesPlotsOfOtherKindsAndUnknownModels) {
  EXPECT_THAT(errorOfRun(blockedPath({"--plot", "path.gif"}), 2),
              HasSubstr("plots are written as .png or .svg"));
  EXPECT_EQ(run(blockedPath({"--model", "magic"})).status, 2);
}

TEST(BenchModels, SLOW_JsonHasContractKeys) {
  const json report = json::parse(runWell({"bench", "models", "--repeats", "1", "--json"}).out);
  std::vector<std::string> models;
  for (const json& timing : report["models"]) {
    models.push_back(timing["model"]);
    EXPECT_GT(timing["evaluations_per_s"], 0) << timing["what"];
  }
  for (const char* model : {"diffraction", "itm", "two_ray", "p528", "p1812", "p452", "gases", "rain"})
    EXPECT_THAT(models, testing::Contains(model));
  ASSERT_FALSE(report["diffraction_columns"].empty());
  for (const json& timing : report["diffraction_columns"]) {
    EXPECT_EQ(timing["columns"], 200);
    EXPECT_EQ(timing["heights"], 100);
    EXPECT_LT(timing["max_difference_db"], 1e-3);
    EXPECT_GT(timing["ratio"], 1);
  }
}

}  // namespace
}  // namespace emscape::test
