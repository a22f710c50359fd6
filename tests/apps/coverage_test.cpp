// emscape coverage: files, JSON keys on which other programs rely, and errors. The figures are tested in
// tests/study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

Arguments coverage(const TemporaryFolder& folder, const Arguments& more) {
  return joined({"coverage", shippedScenario("jacksboro.yaml"), "-o", folder / "out", "--cell", "500"}, more);
}

TEST(Coverage, WritesMapsPicturesAndAReport) {
  const TemporaryFolder folder;
  const json report =
      json::parse(runWell(coverage(folder, {"--heights", "agl:50;msl:1200.5", "--products", "covered,best",
                                            "--times", "80", "--json", "--quiet"}))
                      .out);
  EXPECT_EQ(report, json::parse(readFile(folder / "out/report.json")));
  for (const char* key : {"emscape", "scenario", "scenario_hash", "quantity", "threshold", "crs", "cell_m",
                          "pixels", "emitters", "warnings"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  ASSERT_EQ(report["maps"].size(), 4u);
  for (const json& map : report["maps"]) {
    for (const char* key :
         {"product", "files", "description", "unit", "time_s", "min", "max", "known_area_km2"}) {
      EXPECT_TRUE(map.contains(key)) << key;
    }
    EXPECT_EQ(map.contains("area_km2"), map["product"] == "covered");
    EXPECT_NEAR(map["known_area_km2"], 842, 40);
  }
  EXPECT_EQ(report["maps"][2]["height_msl_m"], 1200.5);
  EXPECT_THAT(
      folder.files(),
      ElementsAre("out/maps/best_agl50m_t80s.png", "out/maps/best_agl50m_t80s.tif",
                  "out/maps/best_agl50m_t80s.tif.aux.xml", "out/maps/best_msl1200.5m_t80s.png",
                  "out/maps/best_msl1200.5m_t80s.tif", "out/maps/best_msl1200.5m_t80s.tif.aux.xml",
                  "out/maps/covered_agl50m_t80s.png", "out/maps/covered_agl50m_t80s.tif",
                  "out/maps/covered_agl50m_t80s.tif.aux.xml", "out/maps/covered_msl1200.5m_t80s.png",
                  "out/maps/covered_msl1200.5m_t80s.tif", "out/maps/covered_msl1200.5m_t80s.tif.aux.xml",
                  "out/report.html", "out/report.json", "out/study.json"));
  const std::string html = readFile(folder / "out/report.html");
  for (const char* text : {"Coverage of jacksboro", "1200.5 m above mean sea level", "data:image/png;base64",
                           "FieldAtPosts", "emscape profile "}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
  const json study = json::parse(readFile(folder / "out/study.json"));
  EXPECT_EQ(study["scenarios"][0]["hash"], report["scenario_hash"]);
  EXPECT_EQ(study["outputs"].size(), 12u);
}

TEST(Coverage, PrintsTheAreasOfTheCausesAndNotThatOfWhatIsCovered) {
  const TemporaryFolder folder;
  const std::string out = runWell({"coverage", quick(), "-o", folder / "out", "--cell", "2000", "--quantity",
                                   "detection_probability", "--heights", "agl:150", "--products",
                                   "covered,cause", "--format", "cog"})
                              .out;
  EXPECT_THAT(out, HasSubstr(" 24.0 of 400.1 km2 known, 6.0 %"));
  EXPECT_THAT(out, HasSubstr(" pointing 280.1, noise 96.0 of 400.1 km2 known "));
}

TEST(Coverage, SLOW_TwoRunsWriteTheSameBytes) {
  const TemporaryFolder first, second;
  for (const TemporaryFolder* folder : {&first, &second}) {
    runWell(coverage(*folder, {"--products", "value,fraction", "--times", "70:80:10"}));
  }
  ASSERT_EQ(first.files(), second.files());
  for (const std::string& file : first.files())
    EXPECT_EQ(readFile(first / file), readFile(second / file)) << file;
}

TEST(Coverage, SLOW_RemovesTheOutputsOfAnEarlierRun) {
  const TemporaryFolder folder;
  const auto runWith = [&](const Arguments& more) { runWell(coverage(folder, more)); };
  runWith({"--products", "value,count,best", "--quantity", "detection_probability", "--times", "80",
           "--format", "cog,png,gpkg"});
  const std::string kept = folder / "out/maps/count_agl150m_t80s.png";
  folder.write("out/maps/count_agl150m_t80s.png", "changed by the user");
  folder.write("out/maps/notes.txt", "of the user");
  runWith({"--products", "value", "--quantity", "dominant_emitter", "--times", "80", "--format", "cog"});
  EXPECT_THAT(folder.files(),
              ElementsAre("out/maps/count_agl150m_t80s.png", "out/maps/notes.txt",
                          "out/maps/value_agl150m_t80s.tif", "out/maps/value_agl150m_t80s.tif.aux.xml",
                          "out/report.html", "out/report.json", "out/study.json"));
  EXPECT_EQ(readFile(kept), "changed by the user");
  runWith({"--products", "value", "--times", "80", "--format", "cog"});
  EXPECT_THAT(folder.files(), testing::Not(testing::Contains(HasSubstr(".aux.xml"))))
      << "names of emitters beside values of another quantity";
}

TEST(Coverage, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const Arguments& more, int status) {
    return errorOfRun(coverage(folder, more), status);
  };
  EXPECT_THAT(errorOf({"--products", "holes"}, 2), HasSubstr("unknown product 'holes'"));
  EXPECT_THAT(errorOf({"--heights", "100"}, 2), HasSubstr("'100' must be one of agl:"));
  EXPECT_THAT(errorOf({"--area", "36,-84"}, 2), HasSubstr("2 numbers"));
  EXPECT_THAT(errorOf({"--area", "bbox:1,2,x,4"}, 2), HasSubstr("'x' is not a number"));
  EXPECT_THAT(errorOf({"--quantity", "power_density_dbwm2"}, 2), HasSubstr("--threshold"));
  EXPECT_THAT(errorOf({"--threshold", "nan"}, 2), HasSubstr("--threshold: 'nan' is not a number"));
  EXPECT_THAT(errorOf({"--products", "value,covered,value"}, 2), HasSubstr("'value' is given twice"));
  EXPECT_THAT(errorOf({"--quantity", "loudness"}, 2), HasSubstr("unknown quantity 'loudness'"));
  EXPECT_THAT(errorOf({"--products", "fraction"}, 2), HasSubstr("two times"));
  EXPECT_THAT(errorOf({"--format", "shp"}, 2), HasSubstr("shp"));
  EXPECT_THAT(errorOf({"--crs", "EPSG:4326"}, 2), HasSubstr("not a projection in metres"));
  EXPECT_THAT(errorOf({"--area", "10,10,5000"}, 3), HasSubstr("terrain is missing"));
  EXPECT_TRUE(folder.files().empty()) << "nothing is left behind";
}

TEST(Coverage, ReportsMissingDatabaseOfCoordinateSystems) {
  const TemporaryFolder folder;
  const ProgramResult result = run(coverage(folder, {}), "PROJ_DATA=/nonexistent PROJ_LIB=/nonexistent");
  EXPECT_EQ(result.status, 1) << result.out;
  EXPECT_THAT(result.err, testing::StartsWith("emscape: error: PROJ does not know EPSG:4326"));
  EXPECT_THAT(result.err, HasSubstr("Cannot find proj.db"));
}

}  // namespace
}  // namespace emscape::test
