// emscape check: tables, exit status, skipped datasets. The models' figures are tested in tests/emfield.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kGoodGeoid = "lat_deg,lon_deg_east,N_m\n38.6281550,269.7791550,-31.628\n";
constexpr const char* kWrongGeoid = "lat_deg,lon_deg_east,N_m\n38.6281550,269.7791550,-32.628\n";

void put(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::filesystem::create_directories((folder.path() / name).parent_path());
  writeFile(folder.path() / name, text);
}

TEST(Check, PassesAFolderWhoseFiguresAreMet) {
  const TemporaryFolder folder;
  put(folder, "geoid/check_points.csv", kGoodGeoid);
  put(folder, "pe/ntia_lfmf_check.csv", "");
  put(folder, "notes/todo.txt", "");
  const json report = json::parse(runWell({"check", folder.path().string(), "--json"}).out);
  EXPECT_EQ(report["pass"], true);
  ASSERT_EQ(report["datasets"].size(), 1u);
  const json& geoid = report["datasets"][0];
  EXPECT_EQ(geoid["name"], "geoid");
  EXPECT_EQ(geoid["cases"], 1);
  EXPECT_LT(geoid["max_abs_error"], 0.02);
  EXPECT_EQ(geoid["tolerance"], 0.02);
  EXPECT_EQ(geoid["unit"], "m");
  EXPECT_EQ(geoid["pass"], true);
  EXPECT_EQ(report["not_checked"], json({"pe/ntia_lfmf_check.csv"}));
  EXPECT_EQ(report["unknown"], json({"notes"}));
  EXPECT_THAT(report["absent"], testing::Contains("itm_p2p"));
}

TEST(Check, FailsWithStatus5AndTheLineOfTheWorstCase) {
  const TemporaryFolder folder;
  put(folder, "geoid/check_points.csv", kWrongGeoid);
  const ProgramResult result = run({"check", folder.path().string()});
  EXPECT_EQ(result.status, 5);
  EXPECT_THAT(result.out, HasSubstr("MISS (line 2)"));
  EXPECT_THAT(result.out, HasSubstr("not checked: absent"));
  const json report = json::parse(run({"check", folder.path().string(), "--json"}).out);
  EXPECT_EQ(report["pass"], false);
  EXPECT_EQ(report["datasets"][0]["pass"], false);
}

TEST(Check, FailsWithoutAnyCheck) {
  const TemporaryFolder folder;
  put(folder, "pe/ntia_lfmf_check.csv", "");
  const ProgramResult result = run({"check", folder.path().string()});
  EXPECT_EQ(result.status, 5);
  EXPECT_THAT(result.out, HasSubstr("not checked: no model answers to it"));
}

TEST(Check, NamesFileAndLineOfMalformedTable) {
  const TemporaryFolder folder;
  put(folder, "geoid/check_points.csv", "lat_deg,lon_deg_east,N_m\n38,269,-31.6\n39,x,-30\n");
  const ProgramResult result = run({"check", folder.path().string(), "--json"});
  EXPECT_EQ(result.status, 3);
  const json unreadable = json::parse(result.out)["unreadable"];
  ASSERT_EQ(unreadable.size(), 1u);
  EXPECT_EQ(unreadable[0]["name"], "geoid");
  EXPECT_THAT(unreadable[0]["fault"],
              HasSubstr("check_points.csv:3: lon_deg_east: 'x' is not a finite number"));
}

TEST(Check, GoesOnAfterADatasetThatCannotBeRead) {
  const TemporaryFolder folder;
  put(folder, "geoid/check_points.csv", kGoodGeoid);
  put(folder, "pe/knife_edge.csv", "no,such,columns\n1,2,3\n");
  const ProgramResult result = run({"check", folder.path().string()});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, testing::ContainsRegex("geoid .* pass"));
  EXPECT_THAT(result.out, testing::ContainsRegex("pe/knife_edge.csv *cannot be read: "));
}

TEST(Check, TakesTheFolderOfOneFamily) {
  const TemporaryFolder folder;
  put(folder, "pe/roughness.csv",
      "frequency_hz,sigma_h_m,grazing_deg,ament,miller_brown\n3e9,0.031875,0.5,0.999388,0.999389\n");
  put(folder, "pe/README.md", "");
  put(folder, "pe/more.csv", "");
  const json report = json::parse(runWell({"check", (folder.path() / "pe").string() + "/", "--json"}).out);
  ASSERT_EQ(report["datasets"].size(), 1u);
  EXPECT_EQ(report["datasets"][0]["name"], "pe/roughness.csv");
  EXPECT_EQ(report["unknown"], json({"pe/more.csv"}));
  EXPECT_THAT(report["absent"], testing::Not(testing::Contains("geoid")));
}

TEST(Check, ComparesATableOfMeasuredPaths) {
  const TemporaryFolder folder;
  put(folder, "losses.csv", "lat;lon;pl;site\n36.30;-84.25;130;a\n36.31;-84.25;125;a\n36.32;-84.25;125;b\n");
  const std::string table = (folder.path() / "losses.csv").string();
  const std::vector<std::string> arguments{
      "check",
      table,
      "--scenario",
      sourceFile("scenarios/jacksboro.yaml"),
      "--columns",
      "transmitter_latitude_deg=36.27,transmitter_longitude_deg=-84.24167,transmitter_height_agl_m=20",
      "--columns",
      "receiver_latitude_deg=lat,receiver_longitude_deg=lon,receiver_height_agl_m=2,frequency_mhz=868,loss_"
      "db=pl",
      "--where",
      "site=a"};
  const auto with = [&](const Arguments& more) { return run(joined(arguments, more)); };
  const ProgramResult text = with({});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("losses.csv: 2 of 3 rows, 2 paths of 3.4"));
  EXPECT_THAT(text.out, HasSubstr("ground cover: none"));
  EXPECT_THAT(text.out, testing::ContainsRegex("diffraction +2 +[-+][0-9.]+ +[0-9.]+ +[0-9.]+"));
  const ProgramResult result = with({"--json", "--model", "free_space,itm"});
  const json report = json::parse(result.out);
  EXPECT_EQ(report["rows_selected"], 2);
  ASSERT_EQ(report["models"].size(), 2u);
  EXPECT_EQ(report["models"][1]["model"], "itm");
  EXPECT_EQ(report["models"][1]["all"]["paths"], 2);
  EXPECT_EQ(report["paths"][0]["measured_db"], 130);
  EXPECT_EQ(report["paths"][1]["line"], 3);
  EXPECT_EQ(with({"--where", "lat>80"}).status, 3);
  EXPECT_THAT(errorOfRun({"check", folder.path().string(), "--model", "itm"}, 2),
              HasSubstr("options of measured paths are given"));
}

TEST(Check, RefusesAFolderWithoutDatasets) {
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"check", folder.path().string()}, 3), HasSubstr("has no known dataset"));
}

}  // namespace
}  // namespace emscape::test
