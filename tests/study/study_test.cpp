// Studies: the file, the order of the variants, and the measures of each.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "emscape/scenario/file/scenario_file.h"
#include "study/sweep/results/study_folder.h"
#include "study/sweep/results/study_report.h"
#include "study/sweep/study_runner.h"
#include "tests/scenario/dem_file.h"
#include "tests/study/converted_vectors.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/unfinished_files.h"

namespace emscape::study {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const char* const kMeasures = R"(
measures:
  - {name: covered, height: "agl:300"}
  - {name: mean, product: value, height: "msl:900", statistic: mean}
)";

/// A study of jacksboro.yaml with large pixels.
class Study {
 public:
  explicit Study(const std::string& text, const std::string& measures = kMeasures,
                 const std::string& scenario = test::shippedScenario("jacksboro.yaml"))
      : file_(folder_.write(
            "study.yaml", "schema_version: 1\nscenario: " + scenario + "\ncell_m: 1000\n" + text + measures)),
        spec_(loadStudy(file_, {}, "test")),
        terrain_(loadTerrain(*spec_.base, spec_.area)),
        plan_(planStudy(spec_, terrain_)) {}

  /// The measures of variants, computed in the order given.
  std::vector<std::vector<double>> run(const std::vector<std::size_t>& variants) const {
    std::vector<std::vector<double>> values(spec_.variants.count());
    StudyRunner(spec_, plan_, terrain_, {}).run(variants, [&](const VariantResult& result) {
      values[result.variant] = result.values;
    });
    return values;
  }
  std::vector<std::size_t> order() const { return {plan_.order.begin(), plan_.order.end()}; }

  const StudySpec& spec() const { return spec_; }
  const StudyPlan& plan() const { return plan_; }
  const scenario::TerrainPtr& terrain() const { return terrain_; }

 private:
  test::TemporaryFolder folder_;
  std::string file_;
  StudySpec spec_;
  scenario::TerrainPtr terrain_;
  StudyPlan plan_;
};

void computePart(const Study& study, const StudyFolder& files, int part) {
  const auto journal = files.journal(part);
  StudyRunner(study.spec(), study.plan(), study.terrain(), {})
      .run(journal->unfinished(), [&](VariantResult result) { journal->add(std::move(result), {}, "cpu"); });
  files.writePart(part, *journal);
}

std::string errorOf(const std::string& text) {
  return test::errorOf([&] { Study study(text); });
}

TEST(Study, VariantsCombineListSweepAndSamples) {
  const Study study(R"(
variants: [{name: as it is}, {name: no jammer, set: {emitters.jammer.power_w: 1.0e-6}}]
sweep:
  atmosphere.k_factor: {linear: {from: 1, to: 1.4, count: 3}}
  emitters.search radar.power_w: {log: {from: 10, to: 1000, count: 3}}
samples:
  count: 4
  parameters: {emitters.search radar.receiver.target_rcs_m2: {lognormal: {median: 2, deviation_db: 3}}}
)");
  const VariantSet& variants = study.spec().variants;
  ASSERT_EQ(variants.count(), 2u * 3 * 3 * 4);
  EXPECT_EQ(variants.name(0), "as it is");
  EXPECT_EQ(variants.name(71), "no jammer");
  EXPECT_THAT(variants.paths(),
              ElementsAre("emitters.jammer.power_w", "atmosphere.k_factor", "emitters.search radar.power_w",
                          "emitters.search radar.receiver.target_rcs_m2"));
  EXPECT_EQ(variants.value(0, 0), "");
  EXPECT_EQ(variants.value(36, 0), "1.0e-6");
  EXPECT_EQ(variants.value(13, 1), "1.2");
  EXPECT_EQ(variants.value(4, 2), "100");
  EXPECT_EQ(variants.edits(0).size(), 3u);
}

TEST(Study, AnotherLandCoverOrSurfaceModelIsAnotherStudy) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, double value) {
    test::geographicDem(4.75, 52.25, 0.002, 250, 250, [&](double, double) {
      return value;
    }).write(folder / name);
  };
  const auto writeCover = [&](double code) {
    write("codes.tif", code);
    test::wholeNumbers(folder / "codes.tif", folder / "cover.tif");
  };
  write("dem.tif", 20);
  write("surface.tif", 25);
  writeCover(10);
  std::string text = test::readFile(test::shippedScenario("quick.yaml"));
  text.replace(text.find("platforms:"), 0,
               "terrain: {files: [dem.tif], surface_files: [surface.tif], land_cover: {files: [cover.tif], "
               "classes: worldcover}}\n");
  const std::string scenario = folder.write("quick.yaml", text);
  const auto hash = [&] { return Study("variants: [{name: as it is}]\n", kMeasures, scenario).spec().hash; };
  const std::string first = hash();
  EXPECT_EQ(hash(), first);
  writeCover(80);
  const std::string second = hash();
  EXPECT_NE(second, first);
  write("surface.tif", 26);
  EXPECT_NE(hash(), second);
}

TEST(Study, SolverNamesStagesThatAParameterInvalidates) {
  const Study study(R"(
sweep:
  emitters.search radar.power_w: {values: [100, 200]}
  emitters.search radar.antenna.side_lobe_db: {values: [-40, -30]}
  platforms.ridge site.position.height_agl_m: {values: [10, 30]}
  atmosphere.k_factor: {values: [1, 1.2]}
  output.count_threshold_dbwm2: {values: [-80, -70]}
)");
  using C = ChangeClass;
  EXPECT_THAT(study.plan().classes, ElementsAre(C::power, C::beam, C::geometry, C::geometry, C::product));
  // 4 geometries, with 2 antennas each, 2 powers of each, 2 thresholds of each.
  EXPECT_THAT(study.plan().changes, ElementsAre(4u, 4u, 8u, 16u));
}

TEST(Study, SLOW_ResultsDoNotDependOnEarlierRuns) {
  const Study study(R"(
times: "60:90:15"
sweep:
  emitters.jammer.power_w: {values: [1, 20, 1500]}
  platforms.ridge site.position.height_agl_m: {values: [10, 30]}
  emitters.search radar.antenna.beamwidth_el_deg: {values: [3, 6]}
)",
                    R"(
measures:
  - {name: covered, height: "agl:300"}
  - {name: gap, product: longest_gap, height: "agl:300"}
  - {name: lost, product: jam_loss, height: "msl:900", unit: percent}
  - {name: low, product: value, height: "agl:300", statistic: min, threshold: 0.9}
  - {name: surely covered, height: "agl:100", threshold: 0.9}
  - {name: how low, product: min_height, statistic: mean}
)");
  const std::vector<std::vector<double>> in_order = study.run(study.order());
  std::vector<std::size_t> backwards(study.spec().variants.count());
  for (std::size_t v = 0; v < backwards.size(); ++v) backwards[v] = backwards.size() - 1 - v;
  EXPECT_EQ(study.run(backwards), in_order);
  for (const std::size_t v : {0u, 3u, 6u}) EXPECT_EQ(study.run({v})[v], in_order[v]) << v;
  EXPECT_NE(in_order[0], in_order[4]) << "the jammer takes coverage away";

  // Equal to maps of the edited scenario computed separately.
  const auto edited = scenario::editScenario(*study.spec().base, study.spec().variants.edits(5)).scenario;
  const MapGrid grid = makeMapGrid(study.spec().area, 1000, "utm");
  emfield::FieldOptions options;
  options.move_tolerance_m = 0;
  double covered_km2 = 0;
  computeCoverage(edited, study.terrain(), grid,
                  {{{emfield::HeightReference::ground, 300}},
                   {Product::covered},
                   scenario::Quantity::detection_probability,
                   0.5,
                   study.spec().times_s},
                  options, [&](const CoverageMap& map) { covered_km2 += map.class_area_m2 / 1e6 / 3; });
  EXPECT_NEAR(in_order[5][0], covered_km2, 1e-9 * covered_km2);
}

/// Elevations of 0.4 by 0.4 degrees around 46 N, 10 E: a plain at 100 m with a ridge 2 km north of its
/// middle.
std::string elevations(const test::TemporaryFolder& folder, const std::string& name, int ridge_m) {
  std::string text = "ncols 20\nnrows 20\nxllcorner 9.8\nyllcorner 45.8\ncellsize 0.02\n";
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) text += row == 8 ? std::to_string(ridge_m) + " " : "100 ";
    text += "\n";
  }
  folder.write(name + ".prj", R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                              R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
  return folder.write(name + ".asc", text);
}

TEST(Study, VariantsOnOtherTerrainAreComputedOnTheirOwn) {
  const test::TemporaryFolder folder;
  const std::string flat = elevations(folder, "flat", 100), ridge = elevations(folder, "ridge", 500);
  const std::string scenario = folder.write("scenario.yaml", R"(schema_version: 1
name: plain
duration_s: 10
step_s: 1
region:
  origin: {latitude_deg: 46, longitude_deg: 10, height_msl_m: 0}
  size_m: [10000, 10000, 2000]
  dims: [10, 10, 10]
terrain: {files: [flat.asc]}
platforms:
  - {name: p, position: {latitude_deg: 46, longitude_deg: 10, height_agl_m: 20}}
emitters:
  - name: radar
    platform: p
    kind: radar
    frequency_hz: 3.0e9
    power_w: 2000
    antenna: {pattern: isotropic, gain_dbi: 20}
    propagation: horizon
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
)");
  const Study study(R"(
times: "0:1:1"
variants:
  - {name: a}
  - {name: ridge, set: {terrain.files: [ridge.asc]}}
  - {name: far, set: {platforms.p.position.latitude_deg: 45.85}}
  - {name: less, set: {emitters.radar.losses_db: 1}}
  - {name: least, set: {emitters.radar.losses_db: 2}}
)",
                    "\nmeasures: [{name: covered, height: \"agl:20\"}]\n", scenario);
  EXPECT_THAT(study.plan().classes,
              ElementsAre(ChangeClass::geometry, ChangeClass::geometry, ChangeClass::power));
  std::vector<std::vector<double>> alone;
  for (std::size_t v = 0; v < 5; ++v) {
    const auto edited = scenario::editScenario(*study.spec().base, study.spec().variants.edits(v)).scenario;
    double covered_km2 = 0;
    computeCoverage(edited, loadTerrain(*edited, study.spec().area), mapGridOf(study.spec()),
                    {{{emfield::HeightReference::ground, 20}},
                     {Product::covered},
                     scenario::Quantity::detection_probability,
                     0.5,
                     study.spec().times_s},
                    {}, [&](const CoverageMap& map) { covered_km2 += map.class_area_m2 / 1e6 / 2; });
    alone.push_back({covered_km2});
  }
  EXPECT_LT(alone[1][0], 0.95 * alone[0][0]);
  EXPECT_EQ(study.run(study.order()), alone);
  for (std::size_t v = 0; v < 5; ++v) EXPECT_EQ(study.run({v})[v], alone[v]) << v;

  // Whatever the plan expects of the changes.
  StudyPlan plan = study.plan();
  plan.classes.assign(plan.classes.size(), ChangeClass::product);
  std::vector<std::vector<double>> values(5);
  StudyRunner(study.spec(), plan, study.terrain(), {}).run({0, 1, 2, 3, 4}, [&](const VariantResult& result) {
    values[result.variant] = result.values;
  });
  EXPECT_EQ(values, alone);
}

TEST(Study, WarningsAreOfTheLastRun) {
  const Study study(R"(
variants:
  - {name: a}
  - {name: silent, set: {emitters.search radar.active_s: [[50, 60]], emitters.tracking radar.active_s: [[50, 60]]}}
)");
  StudyRunner runner(study.spec(), study.plan(), study.terrain(), {});
  const auto warningsOf = [&](std::size_t variant) {
    runner.run({variant}, [](const VariantResult&) {});
    return runner.warnings();
  };
  const std::set<std::string> without = warningsOf(0);
  EXPECT_GT(warningsOf(1).size(), without.size());
  EXPECT_EQ(warningsOf(0), without);
}

const char* const kWest =
    R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type":
"Polygon", "coordinates": [[[-85, 36], [-84.246, 36], [-84.246, 37], [-85, 37], [-85, 36]]]}}]})";

TEST(Study, TheHashIsOfAllFilesThatDetermineTheResults) {
  const test::TemporaryFolder folder;
  const std::string shapes = folder / "west.shp";
  test::convertVectors(folder.write("west.geojson", kWest), "ESRI Shapefile", shapes);
  const std::string track = folder.write("track.csv",
                                         "t_s,latitude_deg,longitude_deg,height_msl_m\n0,36.3,-84.3,1500\n"
                                         "100,36.3,-84.2,1500\n");
  const std::string text =
      "variants: [{name: a}, {name: other, set: {platforms.helicopter.track.file: " + track +
      ", emitters.jammer.power_w: 1}}]\n";
  const std::string measures = "measures: [{name: west, height: \"agl:300\", over: " + shapes + "}]\n";
  const Study study(text, measures);
  EXPECT_THAT(study.spec().files, ::testing::IsSupersetOf({shapes, folder / "west.dbf", folder / "west.prj",
                                                           folder / "west.shx", track}));
  EXPECT_EQ(study.spec().files.size(), 5u);
  const std::string& hash = study.spec().hash;
  const auto hashOf = [&] { return Study(text, measures).spec().hash; };
  std::set<std::string> hashes{hashOf()};
  test::writeFile(track, test::readFile(track) + "101,36.3,-84.2,1600\n");
  hashes.insert(hashOf());
  std::filesystem::remove(folder / "west.prj");
  hashes.insert(hashOf());
  EXPECT_EQ(hashes.size(), 3u) << hash;
}

TEST(Study, MeasuresOverPolygonsCountTheirPixelsAlone) {
  const test::TemporaryFolder folder;
  const std::string west = folder.write("west.geojson", kWest);
  const Study study("variants: [{name: as it is}]", R"(
measures:
  - {name: all, height: "agl:300"}
  - {name: west, height: "agl:300", over: )" + west + R"(}
  - {name: share, height: "agl:300", unit: percent, over: )" +
                                                        west + "}\n");
  const std::vector<double> values = study.run({0})[0];
  EXPECT_GT(values[1], 0);
  EXPECT_LT(values[1], 0.8 * values[0]);
  EXPECT_NEAR(values[1] / values[2] * 100, 421, 25) << "half of 842 km2";
}

std::vector<std::string> arraysOf(const std::filesystem::path& file) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(file.c_str(), GDAL_OF_MULTIDIM_RASTER));
  return dataset != nullptr ? dataset->GetRootGroup()->GetMDArrayNames() : std::vector<std::string>{};
}

TEST(Study, PartsOfAnyNumberJoinToTheSameResults) {
  const Study study(R"(
sweep:
  emitters.jammer.power_w: {log: {from: 1, to: 1000, count: 5}}
  emitters.search radar.propagation: {values: [horizon, free_space]}
)");
  std::vector<std::string> csv, html;
  std::vector<std::string> netcdf;
  for (const int parts : {1, 3, 10}) {
    const test::TemporaryFolder folder;
    StudyFolder files(folder.path(), study.spec(), study.plan(), "test");
    files.begin(parts);
    EXPECT_EQ(files.missingParts().size(), static_cast<std::size_t>(parts));
    for (int part = parts; part >= 1; --part) {
      computePart(study, files, part);
      EXPECT_TRUE(files.hasPart(part));
    }
    const StudyResults results = files.read();
    files.writeResults(results);
    writeStudyReport(folder.path() / "report.html", study.spec(), study.plan(), results);
    csv.push_back(test::readFile(folder.path() / "results.csv"));
    netcdf.push_back(test::readFile(folder.path() / "results.nc"));
    EXPECT_THAT(arraysOf(folder.path() / "results.nc"),
                ::testing::UnorderedElementsAre("emitters_jammer_power_w",
                                                "emitters_search_radar_propagation", "covered", "mean"));
    html.push_back(test::readFile(folder.path() / "report.html"));
  }
  EXPECT_THAT(csv[0], HasSubstr("variant,name,emitters.jammer.power_w,emitters.search radar.propagation,"
                                "covered (km2),mean\n0,,1,horizon,"));
  EXPECT_EQ(std::count(csv[0].begin(), csv[0].end(), '\n'), 11);
  EXPECT_FALSE(netcdf[0].empty());
  for (int i : {1, 2}) {
    EXPECT_EQ(csv[i], csv[0]);
    EXPECT_TRUE(netcdf[i] == netcdf[0]);
    EXPECT_TRUE(html[i] == html[0]);
  }
}

TEST(Study, MeasuresAreNoCoordinates) {
  const Study study(
      "variants: [{name: a}, {name: b}]",
      "\nmeasures: [{name: variant, height: \"agl:300\"}, {name: name, height: \"agl:600\"}]\n");
  const test::TemporaryFolder folder;
  StudyFolder files(folder.path(), study.spec(), study.plan(), "test");
  files.begin(1);
  computePart(study, files, 1);
  files.writeResults(files.read());
  EXPECT_THAT(arraysOf(folder.path() / "results.nc"),
              ::testing::UnorderedElementsAre("name", "variant_", "name_"));
}

TEST(Study, AManifestOfAnotherProgramIsRefused) {
  const Study study("sweep: {emitters.jammer.power_w: {values: [1, 2]}}");
  for (const char* text : {"{\"name\": \"a page\"}", "[1]", "{\"hash\": 3}"}) {
    const test::TemporaryFolder folder;
    folder.write("manifest.json", text);
    EXPECT_THAT(
        test::errorOf([&] { StudyFolder(folder.path(), study.spec(), study.plan(), "test").begin(1); },
                      ErrorCode::bad_input),
        HasSubstr("manifest.json: is no manifest of a study of emscape; choose another folder"));
  }
  const test::TemporaryFolder folder;
  folder.write("manifest.json",
               R"({"schema_version": 2, "parts": 1, "hash": ")" + study.spec().hash + R"("})");
  EXPECT_THAT(test::errorOf([&] { StudyFolder(folder.path(), study.spec(), study.plan(), "test").begin(1); },
                            ErrorCode::bad_input),
              HasSubstr("manifest.json: 'schema_version' is 2; this program reads 1; choose another folder"));
}

TEST(Study, APartOfAnotherStudyIsRefused) {
  const Study first("sweep: {emitters.jammer.power_w: {values: [1, 2]}}"),
      second("sweep: {emitters.jammer.power_w: {values: [1, 3]}}");
  const test::TemporaryFolder folder;
  StudyFolder files(folder.path(), first.spec(), first.plan(), "test");
  files.begin(2);
  EXPECT_NE(first.spec().hash, second.spec().hash);
  EXPECT_THAT(
      test::errorOf([&] { StudyFolder(folder.path(), second.spec(), second.plan(), "test").begin(2); }),
      AllOf(HasSubstr("manifest.json"), HasSubstr("another study")));
  EXPECT_THAT(test::errorOf([&] { StudyFolder(folder.path(), first.spec(), first.plan(), "test").begin(1); }),
              HasSubstr("has 2 parts, not 1"));
}

/// The text with the first `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Study, APartThatWasChangedIsToldAndComputedAgainIfItIsMovedAway) {
  namespace fs = std::filesystem;
  const Study study("sweep: {emitters.jammer.power_w: {values: [1, 2, 3, 4]}}");
  const test::TemporaryFolder folder;
  StudyFolder files(folder.path(), study.spec(), study.plan(), "test");
  files.begin(2);
  for (const int part : {1, 2}) computePart(study, files, part);
  const fs::path csv = folder.path() / "parts/part_00001.csv",
                 record = folder.path() / "parts/part_00001.json";
  const std::string as_written = test::readFile(csv), record_as_written = test::readFile(record);
  const auto fault = [&] {
    return test::errorOf([&] { static_cast<void>(files.read()); }, ErrorCode::bad_input);
  };
  test::writeFile(csv, as_written + "#");
  EXPECT_THAT(fault(), AllOf(HasSubstr("part_00001.csv: was changed since it was written; put it back"),
                             HasSubstr("parts/part_00001.* away: --resume computes the part again")));
  EXPECT_THAT(test::errorOf([&] { files.missingParts(); }, ErrorCode::bad_input), HasSubstr("was changed"));
  fs::remove(csv);
  EXPECT_THAT(fault(), HasSubstr("part_00001.csv: is not there; put it back"));
  test::writeFile(csv, as_written);
  test::writeFile(record, replaced(record_as_written, "\"warnings\": []", "\"warnings\": [\"mine\"]"));
  EXPECT_THAT(fault(), HasSubstr("part_00001.json: was changed since it was written"));
  test::writeFile(record, replaced(record_as_written, "\"crc32\"", "\"more\""));
  EXPECT_THAT(fault(), HasSubstr("part_00001.json: "));
  test::writeFile(record, record_as_written);
  EXPECT_NO_THROW(static_cast<void>(files.read()));
  for (const fs::path& file : {csv, record}) fs::rename(file, folder.path() / file.filename());
  EXPECT_THAT(files.missingParts(), ElementsAre(1));
  computePart(study, files, 1);
  EXPECT_NO_THROW(static_cast<void>(files.read()));
  EXPECT_EQ(test::readFile(csv), as_written);
}

TEST(Study, KeepsTheMapsOfEachVariant) {
  const Study study(R"(
variants: [{name: "../as it is/ä"}, {name: no jammer, set: {emitters.jammer.power_w: 1.0e-6}}]
)");
  EXPECT_EQ(folderOfVariant(study.spec(), 0), "variants/0_.._as_it_is___");
  EXPECT_EQ(folderOfVariant(study.spec(), 1), "variants/1_no_jammer");
  const test::TemporaryFolder folder;
  StudyFolder files(folder.path(), study.spec(), study.plan(), "test");
  files.begin(1, KeptFiles::maps);
  VariantFiles kept(study.spec(), folder.path(), files.kept(), {});
  std::filesystem::create_directories(folder / "variants/1_no_jammer");
  test::leaveUnfinished(folder / "variants/1_no_jammer/covered.tif");
  std::size_t written = 0;
  StudyRunner(study.spec(), study.plan(), study.terrain(), {}, &kept)
      .run({0, 1}, [&](const VariantResult& result) {
        const auto own = folder.path() / folderOfVariant(study.spec(), result.variant);
        EXPECT_EQ(test::readFile(own / "covered_agl300m_t0s.tif").substr(0, 2), "II");
        written += test::readFile(own / "value_msl900m_t0s.tif").size();
      });
  EXPECT_GT(written, 1000u);
  EXPECT_THAT(folder.files(), ::testing::Not(::testing::Contains(HasSubstr(".part-"))))
      << "a killed process left it";
  EXPECT_THAT(test::errorOf([&] {
                StudyFolder(folder.path(), study.spec(), study.plan(), "test").begin(1, KeptFiles::volumes);
              }),
              HasSubstr("the folder keeps maps of each variant, not volumes"));
  StudyFolder again(folder.path(), study.spec(), study.plan(), "test");
  again.begin(1);
  EXPECT_EQ(again.kept(), KeptFiles::maps) << "as the manifest says";
}

TEST(Study, FoldersOfManyVariantsHaveTwoLevels) {
  const Study study("sweep: {emitters.jammer.power_w: {linear: {from: 1, to: 2001, count: 2001}}}");
  EXPECT_EQ(folderOfVariant(study.spec(), 7), "variants/0000/0007");
  EXPECT_EQ(folderOfVariant(study.spec(), 2000), "variants/2000/2000");
}

TEST(Study, SitesAreChosenFromCandidates) {
  const test::TemporaryFolder folder;
  const Study study("sites: {platform: ridge site, grid_m: 9000, choose: 2}",
                    "\nmeasures: [{name: covered, height: \"agl:100\", unit: percent}]\n");
  ASSERT_EQ(study.spec().variants.count(), 9u);
  StudyFolder files(folder.path(), study.spec(), study.plan(), "test");
  files.begin(2);
  for (const int part : {1, 2}) {
    computePart(study, files, part);
  }
  const StudySummary summary =
      writeStudyReport(folder.path() / "report.html", study.spec(), study.plan(), files.read());
  ASSERT_EQ(summary.sites.size(), 2u);
  EXPECT_GE(summary.sites_value, summary.measures[0].max);
  EXPECT_LE(summary.sites_value, 100);

  const std::filesystem::path record = folder.path() / "parts" / "part_00002.json";
  const std::string text = test::readFile(record);
  const std::size_t value = text.find(':', text.find("\"pixels\"")) + 1;
  test::writeFile(record, text.substr(0, value) + "1e30" + text.substr(text.find_first_of(",\n", value)));
  EXPECT_THAT(test::errorOf([&] { files.read(); }, ErrorCode::bad_input), HasSubstr("was changed"));
}

TEST(Study, HeightsOfSitesReplaceThatOfThePlatform) {
  const test::TemporaryFolder folder;
  const std::string table =
      folder.write("sites.csv", "name,lat,lon,height_msl_m\nhigh,36.3,-84.25,900\nown,36.32,-84.25,\n");
  const Study study("sites: {platform: ridge site, candidates: " + table + ", choose: 1}",
                    "\nmeasures: [{name: covered, height: \"agl:100\", unit: percent}]\n");
  ASSERT_EQ(study.spec().variants.count(), 2u);
  const auto heightOf = [&](std::size_t variant) {
    const auto edited = scenario::editScenario(*study.spec().base, study.spec().variants.edits(variant));
    for (const scenario::Platform& platform : edited.scenario->platforms) {
      if (platform.name == "ridge site") return platform.track[0].position;
    }
    return scenario::SitePosition{};
  };
  EXPECT_EQ(heightOf(0).height_msl_m, 900);
  EXPECT_FALSE(heightOf(0).height_agl_m);
  EXPECT_FALSE(heightOf(1).height_msl_m);
  EXPECT_TRUE(heightOf(1).height_agl_m);
}

TEST(Study, TheShippedStudiesHaveNoFault) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFile("scenarios/study"))) {
    const StudySpec spec = loadStudy(entry.path(), {}, "test");
    EXPECT_GT(spec.variants.count(), 10u) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 2);
}

TEST(Study, RefusesErrorsWithTheirLocation) {
  EXPECT_THAT(errorOf(""), HasSubstr("none of 'variants', 'sweep', 'samples' and 'sites'"));
  EXPECT_THAT(errorOf("sweeps: {}"), HasSubstr("study.yaml:4:1: unknown key 'sweeps' of the study; did you"));
  EXPECT_THAT(
      errorOf("sweep:\n  emitters.jammer.power_w: {values: [1, -2]}"),
      AllOf(HasSubstr("study.yaml:5:3: emitters.jammer.power_w=-2"), HasSubstr("outside the allowed")));
  EXPECT_THAT(errorOf("sweep:\n  - {values: [1, 2]}"),
              HasSubstr("study.yaml:5:3: 'sweep' must be a map from the scenario's paths to their values"));
  EXPECT_THAT(errorOf("sweep:"), HasSubstr("'sweep' must be a map"));
  EXPECT_THAT(errorOf("samples: {count: 2, parameters: [{uniform: {from: 1, to: 2}}]}"),
              HasSubstr("study.yaml:4:33: 'parameters' must be a map from the scenario's paths to their"));
  EXPECT_THAT(errorOf("sweep: {emitters.jamer.power_w: {values: [1]}}"), HasSubstr("jamer"));
  EXPECT_THAT(errorOf("sweep: {emitters.jammer.power_w: {linear: {from: 1, to: 2}}}"),
              HasSubstr("missing key 'count'"));
  EXPECT_THAT(errorOf("sweep: {emitters.jammer.power_w: {log: {from: 0, to: 2, count: 3}}}"),
              HasSubstr("'from' is 0, outside the allowed range above 0"));
  EXPECT_THAT(errorOf("variants: [{name: a, set: {emitters.jammer.power_w: x}}]"),
              HasSubstr("study.yaml:4:28: emitters.jammer.power_w=x"));
  EXPECT_THAT(errorOf("variants: [{name: a}, {name: a}]"), HasSubstr("'a' twice"));
  EXPECT_THAT(errorOf("variants: [{name: a, set: {emitters.jammer.power_w: 1}}]\n"
                      "sweep: {emitters.jammer.power_w: {values: [1]}}"),
              HasSubstr("'emitters.jammer.power_w' is set twice"));
  EXPECT_THAT(
      errorOf("sweep: {emitters.jammer.power_w: {values: [1]}, emitters.\"jammer\".power_w: {values: [2]}}"),
      HasSubstr("study.yaml:4:8: 'emitters.jammer.power_w' and 'emitters.\"jammer\".power_w' set the same"));
  EXPECT_THAT(
      errorOf("variants: [{name: a, set: {emitters.search radar.receiver.noise_figure_db: 3}}]\n"
              "sweep: {emitters.search radar.receiver: {values: [{noise_figure_db: 4, bandwidth_hz: 1e6}]}}"),
      HasSubstr("and 'emitters.search radar.receiver' set the same value, or one a part of the other"));
  EXPECT_THAT(
      errorOf("variants: [{name: a, set: {emitters.search radar.receiver: {noise_figure_db: 4, bandwidth_hz: "
              "1e6}, emitters.search radar.receiver.noise_figure_db: 3}}]"),
      HasSubstr("variant 'a': 'emitters.search radar.receiver' and"));
  EXPECT_THAT(errorOf("variants: [{name: \"a\\nb\"}]"), HasSubstr("'name' has a line break"));
  EXPECT_THAT(
      errorOf("samples: {count: 3, parameters: {emitters.jammer.power_w: {normal: {mean: 1, deviation: "
              "1000}}}}"),
      HasSubstr("outside the allowed"));
  const auto ofMeasure = [](const std::string& measure) {
    return test::errorOf([&] { Study study("variants: [{name: a}]", "\nmeasures:\n  - " + measure + "\n"); });
  };
  EXPECT_THAT(ofMeasure("{name: a, product: gap}"), HasSubstr("'product' must be one of value, covered"));
  EXPECT_THAT(ofMeasure("{name: a, product: fraction}"), HasSubstr("is over time"));
  EXPECT_THAT(ofMeasure("{name: a, product: best}"), HasSubstr("product 'best' is an index"));
  EXPECT_THAT(ofMeasure("{name: a, product: value, quantity: dominant_emitter}"),
              HasSubstr("quantity 'dominant_emitter' is an index"));
  EXPECT_THAT(ofMeasure("{name: a, threshold: 2}"),
              HasSubstr("threshold 2 of detection_probability must be between 0 and 1"));
  EXPECT_THAT(ofMeasure("{name: \"a\\nb\"}"), HasSubstr("'name' has a line break"));
  EXPECT_THAT(ofMeasure("{name: a, product: min_height, unit: km2}"), HasSubstr("has no area"));
  EXPECT_THAT(ofMeasure("{name: a, product: value, height: \"agl:300\", unit: percent}"),
              HasSubstr("product 'value' has no area; its values"));
  EXPECT_THAT(ofMeasure("{name: a, height: 30}"), HasSubstr("study.yaml:6:"));
  EXPECT_THAT(ofMeasure("{name: a, product: min_height, height: agl:30}"),
              HasSubstr("product 'min_height' has no 'height'"));
  const test::TemporaryFolder folder;
  const std::string without =
      folder.write("study.yaml", std::string("schema_version: 1\nscenario: nowhere.yaml\n") + kMeasures);
  EXPECT_THAT(test::errorOf([&] { loadStudy(without, {}, "test"); }),
              AllOf(HasSubstr("study.yaml:2:"), HasSubstr("nowhere.yaml: no such file")));
  EXPECT_THAT(ofMeasure("{name: a, quantity: power_density_dbwm2}"), HasSubstr("needs a threshold"));
  EXPECT_THAT(ofMeasure("{name: a, over: nowhere.gpkg}"), HasSubstr("nowhere.gpkg: no such file"));
}

TEST(Study, WarningsOfTheScenarioAndOfItsVariantsAreWarningsOfTheStudy) {
  const Study study("sweep: {emitters.search radar.receiver.bandwidth_hz: {values: [1.0e6, 2]}}\n");
  StudyRunner runner(study.spec(), study.plan(), study.terrain(), {});
  std::set<std::string> all;
  runner.run({0, 1},
             [&](const VariantResult&) { all.insert(runner.warnings().begin(), runner.warnings().end()); });
  EXPECT_THAT(all, ::testing::Contains(AllOf(HasSubstr("emitters.search radar.receiver.bandwidth_hz=2: "),
                                             HasSubstr("is 2 Hz wide"))));
}

TEST(Study, PathsOfOneParameterGetTheSameValues) {
  const Study study(R"(
sweep:
  emitters.search radar.power_w: {values: [10, 20], also: [emitters.tracking radar.power_w]}
samples:
  count: 3
  parameters:
    emitters.search radar.receiver.target_rcs_m2:
      lognormal: {median: 2, deviation_db: 3}
      also: [emitters.tracking radar.receiver.target_rcs_m2]
    atmosphere.k_factor: {uniform: {from: 1.2, to: 1.4}}
)");
  const VariantSet& variants = study.spec().variants;
  EXPECT_EQ(variants.count(), 6U);
  EXPECT_THAT(variants.paths(),
              ElementsAre("emitters.search radar.power_w", "emitters.tracking radar.power_w",
                          "emitters.search radar.receiver.target_rcs_m2",
                          "emitters.tracking radar.receiver.target_rcs_m2", "atmosphere.k_factor"));
  for (std::size_t v = 0; v < variants.count(); ++v) {
    EXPECT_EQ(variants.value(v, 0), variants.value(v, 1));
    EXPECT_EQ(variants.value(v, 2), variants.value(v, 3));
    EXPECT_NE(variants.value(v, 2), variants.value(v, 4));
  }
  EXPECT_THAT(errorOf("sweep: {atmosphere.k_factor: {values: [1.2], also: [atmosphere.k_factor]}}\n"),
              HasSubstr("atmosphere.k_factor"));
  EXPECT_THAT(errorOf("sweep: {atmosphere.k_factor: {values: [1.2], also: [atmosphere.nothing]}}\n"),
              HasSubstr("nothing"));
}

TEST(Study, SitesOfAPlatformWithATrackAreRefusedInPlainWords) {
  EXPECT_THAT(errorOf("sites: {platform: helicopter, grid_m: 5000}\n"),
              HasSubstr("platform 'helicopter' has a track: sites are for a platform with a position"));
}

TEST(Study, AScenarioInItsPlaceIsNamed) {
  EXPECT_THAT(test::errorOf([] { loadStudy(test::shippedScenario("quick.yaml"), {}, "test"); }),
              HasSubstr("a scenario, not a study: a study names it with 'scenario: FILE'"));
}

}  // namespace
}  // namespace emscape::study
