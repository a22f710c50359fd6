// emscape terrain, and the treatment of missing terrain, assumed datums and land below sea level by the
// subcommands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

class TerrainProgram : public testing::Test {
 protected:
  /// A scenario at the eastern edge of the shipped tile: the ship and a part of the region are beyond it.
  std::string scenario(const std::string& terrain, double longitude_deg = -84.09,
                       const std::string& elevation = sourceFile("scenarios/data/jacksboro.tif")) const {
    const std::string longitude = std::to_string(longitude_deg),
                      beyond = std::to_string(longitude_deg + 0.03);
    const std::string text = R"(schema_version: 1
name: edge
epoch: 2026-06-01T06:00:00Z
duration_s: 0
step_s: 1
region: {origin: {latitude_deg: 36.3, longitude_deg: )" +
                             longitude + R"(, height_msl_m: 0}, size_m: [6000, 4000, 2000], dims: [12, 8, 10]}
terrain: {files: [)" + elevation +
                             "]" + terrain + R"(}
platforms:
  - {name: shore, position: {latitude_deg: 36.3, longitude_deg: )" +
                             longitude + R"(, height_msl_m: 1200}}
  - {name: ship, position: {latitude_deg: 36.3, longitude_deg: )" +
                             beyond + R"(, height_msl_m: 1100}}
emitters:
  - {name: tx, platform: shore, kind: transmitter, frequency_hz: 1.0e9, power_w: 100, antenna: {pattern: isotropic}}
receivers:
  - {name: rx, platform: ship, gain_dbi: 0, noise_figure_db: 5, center_frequency_hz: 1.0e9, bandwidth_hz: 1.0e6}
)";
    return folder_.write("edge.yaml", text);
  }
  /// A grid of one height over the place of the shipped tile, without a datum and a unit.
  std::string plainGrid() const {
    folder_.write(
        "plain.prj",
        "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
        "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
    return folder_.write(
        "plain.asc",
        "ncols 3\nnrows 3\nxllcenter -84.4\nyllcenter 36.1\ncellsize 0.16\n500 501 502\n503 504 "
        "505\n506 507 508\n");
  }
  /// Status of each subcommand on a scenario.
  std::vector<int> statuses(const std::string& file) {
    std::vector<int> all;
    for (const Arguments& arguments :
         {Arguments{"simulate", file, "-o", folder_ / "out", "--force"},
          Arguments{"coverage", file, "-o", folder_ / "maps", "--heights", "msl:1500", "--cell", "500",
                    "--quantity", "power_density_dbwm2", "--threshold", "-60"},
          Arguments{"exposure", file, "--platform", "ship", "--quantity", "power_density_dbwm2",
                    "--threshold", "-60", "-o", folder_ / "e.csv"},
          Arguments{"link", file},
          Arguments{"profile", file, "--emitter", "tx", "--to", "36.3,-84.06,1100"}}) {
      const ProgramResult result = run(arguments);
      if (result.status != 0) {
        EXPECT_THAT(result.err, AnyOf(HasSubstr("missing: sea"), HasSubstr("ground is needed at")))
            << arguments.front();
      }
      all.push_back(result.status);
      last_[arguments.front()] = result;
    }
    return all;
  }

  TemporaryFolder folder_;
  std::map<std::string, ProgramResult> last_;
};

TEST_F(TerrainProgram, DescribesAndDrawsFilesAndScenarios) {
  const std::string tile = sourceFile("scenarios/data/jacksboro.tif");
  const ProgramResult result = runWell({"terrain", tile, "--json", "-o", folder_ / "a.png"});
  EXPECT_EQ(readFile(folder_ / "a.png").substr(1, 3), "PNG");
  const json report = json::parse(result.out);
  const json& file = report.at("files").at(0);
  for (const char* key : {"file", "format", "columns", "rows", "post_spacing_lat_deg", "spacing_m", "crs",
                          "box", "used", "height_unit", "lowest_m", "highest_m", "notes"})
    EXPECT_TRUE(file.contains(key)) << key;
  EXPECT_EQ(file.at("vertical_datum"), "EGM96 (stated by the file: EGM96 height)");
  EXPECT_EQ(file.at("void_posts"), 0);
  EXPECT_TRUE(file.at("warnings").empty());
  EXPECT_EQ(report.at("uncovered_percent"), 0);

  const json assumed = json::parse(run({"terrain", plainGrid(), "--json"}).out);
  EXPECT_EQ(assumed.at("files").at(0).at("vertical_datum"), "EGM96 (assumed)");
  EXPECT_THAT(assumed.at("files").at(0).at("warnings").at(0),
              HasSubstr("if they are above the ellipsoid, the ground is 3"));
  EXPECT_EQ(assumed.at("warnings").size(), 1);
  EXPECT_THAT(
      run({"terrain", tile}).out,
      AllOf(HasSubstr("datum    EGM96 (stated by the file: EGM96 height); unit m"), HasSubstr("Ground: ")));
  EXPECT_EQ(run({"terrain", tile, "-o", folder_ / "a.jpg"}).status, 2);
  EXPECT_EQ(run({"terrain", folder_ / "none.tif"}).status, 3);
}

// PROJ reports that a grid is missing when the name of the coordinate system is asked for.
TEST_F(TerrainProgram, LibrariesPrintNothingBesideTheMessage) {
  plainGrid();
  const std::string file = folder_.write(
      "a.vrt",
      "<VRTDataset rasterXSize=\"3\" rasterYSize=\"3\"><SRS>+proj=longlat +ellps=bessel "
      "+nadgrids=none.gsb</SRS>"
      "<GeoTransform>-84.4, 0.16, 0, 36.58, 0, -0.16</GeoTransform><VRTRasterBand dataType=\"Float32\" "
      "band=\"1\">"
      "<SimpleSource><SourceFilename relativeToVRT=\"1\">plain.asc</SourceFilename><SourceBand>1</SourceBand>"
      "</SimpleSource></VRTRasterBand></VRTDataset>");
  EXPECT_EQ(errorOfRun({"terrain", file}, 3),
            "emscape: error: elevation file " + file + ": its posts are not on the earth\n");
}

TEST_F(TerrainProgram, WhatIsAssumedIsAWarningOfEveryResult) {
  const std::string file = scenario(", missing: sea", -84.09, plainGrid());
  const auto hasWarning = [](const json& warnings) {
    return std::count_if(warnings.begin(), warnings.end(), [](const json& warning) {
      const std::string text =
          warning.is_string() ? warning.get<std::string>() : warning.value("message", "");
      return text.find("states no vertical datum") != std::string::npos;
    });
  };
  EXPECT_EQ(hasWarning(json::parse(run({"validate", file, "--json"}).out).at("problems")), 1);
  EXPECT_EQ(hasWarning(json::parse(run({"link", file, "--json"}).out).at("warnings")), 1);
  EXPECT_EQ(hasWarning(json::parse(
                           run({"profile", file, "--emitter", "tx", "--to", "36.3,-84.1,1100", "--json"}).out)
                           .at("warnings")),
            1);
  const ProgramResult maps =
      run({"coverage", file, "-o", folder_ / "maps", "--heights", "msl:1500", "--cell", "500", "--quantity",
           "power_density_dbwm2", "--threshold", "-60", "--json"});
  EXPECT_EQ(hasWarning(json::parse(maps.out).at("warnings")), 1);
  const ProgramResult series = run({"simulate", file, "-o", folder_ / "out"});
  EXPECT_EQ(series.err.find("states no vertical datum"), series.err.rfind("states no vertical datum"))
      << "once";
  EXPECT_NE(series.err.find("states no vertical datum"), std::string::npos) << series.err;
}

TEST_F(TerrainProgram, MissingTerrainIsTreatedAlikeBySubcommands) {
  EXPECT_EQ(statuses(scenario(", missing: error")), (std::vector<int>{3, 3, 3, 3, 3}));
  EXPECT_EQ(statuses(scenario(", missing: sea")), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_THAT(last_["link"].out, Not(HasSubstr("Unknown")));
  EXPECT_EQ(statuses(scenario(", missing: mask")), (std::vector<int>{0, 0, 3, 0, 3}));
  EXPECT_THAT(last_["link"].out, HasSubstr("Unknown: terrain is missing on the path."));
  EXPECT_THAT(last_["coverage"].out, AllOf(HasSubstr(" km2 known, "), HasSubstr(" km2 unknown")));
  EXPECT_EQ(statuses(scenario("")), (std::vector<int>{3, 0, 3, 3, 3}));
}

TEST_F(TerrainProgram, AMapOfNothingKnownIsAnErrorThatOffersTheOtherSign) {
  const std::string file = scenario("", 84.2);
  EXPECT_THAT(errorOfRun({"coverage", file, "-o", folder_ / "maps", "--heights", "msl:1500", "--quantity",
                          "power_density_dbwm2", "--threshold", "-60"},
                         3),
              HasSubstr("perhaps longitude has the other sign"));
  EXPECT_THAT(run({"validate", file}).out, HasSubstr("perhaps longitude has the other sign"));
  EXPECT_THAT(run({"simulate", file, "-o", folder_ / "out"}).err,
              HasSubstr("perhaps longitude has the other sign"));
}

TEST_F(TerrainProgram, LandBelowSeaLevelIsWarnedOfWhereAModelTakesItForSea) {
  std::string grid = "ncols 60\nnrows 60\nxllcorner 10\nyllcorner 50\ncellsize 0.002\n";
  for (int post = 0; post < 3600; ++post) grid += "-25 ";
  folder_.write("low.asc", grid);
  const auto warningsOf = [&](const std::string& propagation) {
    const std::string file = folder_.write("low.yaml", R"(schema_version: 1
name: low
epoch: 2026-06-01T06:00:00Z
duration_s: 0
step_s: 1
region: {origin: {latitude_deg: 50.06, longitude_deg: 10.06, height_msl_m: 0}, size_m: [2000, 2000, 2000], dims: [4, 4, 4]}
terrain: {files: [{file: low.asc, crs: "EPSG:4326", vertical_datum: egm96}]}
platforms: [{name: site, position: {latitude_deg: 50.06, longitude_deg: 10.06, height_agl_m: 20}}]
emitters:
  - {name: tx, platform: site, kind: transmitter, frequency_hz: 1.0e9, power_w: 100, antenna: {pattern: isotropic})" +
                                                           propagation + "}\n");
    return run({"validate", file}).out +
           run({"profile", file, "--emitter", "tx", "--to", "50.07,10.07,10"}).out;
  };
  EXPECT_THAT(
      warningsOf(", propagation: p452"),
      AllOf(HasSubstr("ground lies down to -25 m, and 'p452' takes"), HasSubstr("'p452: {zone: inland}'")));
  EXPECT_THAT(warningsOf(", propagation: p1812"), HasSubstr("'p1812: {zone: inland}'"));
  EXPECT_THAT(warningsOf(", propagation: p452, p452: {zone: inland}"), Not(HasSubstr("for sea")));
  EXPECT_THAT(warningsOf(""), Not(HasSubstr("for sea")));
}

}  // namespace
}  // namespace emscape::test
