// Studies, files read back from their folders and from folders of maps, and texts of map options.
#include <fmt/format.h>
#include <zlib.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/files/file_digest.h"
#include "base/files/json_writing.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/coverage.h"
#include "emscape/study/maps/map_grid.h"
#include "emscape/study/maps/products.h"
#include "report/maps/areps_table.h"
#include "study/report/coverage_folder.h"
#include "study/report/map_folder.h"
#include "study/sweep/definition/candidate_sites.h"
#include "study/sweep/definition/polygon_mask.h"
#include "study/sweep/results/part_journal.h"
#include "study/sweep/results/study_folder.h"
#include "study/sweep/study_runner.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

/// A journal of two variants with one measure.
std::vector<std::string> journals() {
  const TemporaryFolder folder;
  {
    study::PartJournal journal(folder / "a", {0, 1}, 1);
    study::VariantResult result;
    result.variant = 0;
    result.values = {12.5};
    journal.add(result, {"a warning"}, "cpu");
  }
  return {readFile(folder / "a")};
}

/// Checksum and content, as a line of a journal: a checksum of arbitrary bytes is hardly ever right.
void readPartRecord(const fs::path& file, const std::string& bytes) {
  const std::string content = bytes.substr(0, bytes.find('\n'));
  const auto* const data = reinterpret_cast<const Bytef*>(content.data());
  const std::uint32_t checksum = crc32_z(0, data, content.size());
  writeFile(file, fmt::format("{:08x} {}\n", checksum, content));
  study::PartJournal(file, {0, 1}, 1);
}

/// Writes the output of `emscape coverage` for a small map into FOLDER/map.
void writeMaps(const fs::path& folder) {
  const auto scenario = scenario::loadScenario(shippedScenario("quick.yaml"));
  study::CoverageRequest request;
  request.heights = study::parseHeights("agl:150");
  request.products = {study::Product::covered, study::Product::value};
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -60;
  request.times_s = {0};
  const auto grid = std::make_shared<const study::MapGrid>(
      study::makeMapGrid(study::areaOf(scenario->region), 5000, "utm"));
  study::MapFolder maps(folder / "map",
                        {"coverage",
                         "Coverage of " + scenario->name,
                         {scenario},
                         nullptr,
                         grid,
                         request.quantity,
                         request.threshold,
                         request.times_s,
                         request.heights,
                         {}},
                        {"cog"});
  maps.finish(study::computeCoverage(scenario, nullptr, *grid, request, {},
                                     [&](const study::CoverageMap& map) { maps.add(map); }));
}

void readMaps(const fs::path& file, const std::string&) {
  fs::path folder = file.parent_path();
  if (folder.filename() == "maps") folder = folder.parent_path();
  const study::CoverageFolder maps = study::openCoverageFolder(folder);
  for (std::size_t map = 0; map < maps.maps.size(); ++map) study::readMap(maps, map);
}

std::vector<std::string> mapSeed(const std::string& file) {
  const TemporaryFolder folder;
  writeMaps(folder.path());
  return {readFile(folder / ("map/" + file))};
}

/// A search for sites of a folder, in one part.
class SmallStudy {
 public:
  /// @param folder  with study.yaml; the results are in FOLDER/out
  explicit SmallStudy(const fs::path& folder)
      : spec_(study::loadStudy(folder / "study.yaml", {}, "test", false)),
        plan_(study::planStudy(spec_, nullptr)),
        folder_(folder / "out") {}

  void compute() const {
    study::StudyFolder files(folder_, spec_, plan_, "test");
    files.begin(1);
    const auto journal = files.journal(1);
    study::StudyRunner(spec_, plan_, nullptr, {})
        .run(journal->unfinished(),
             [&](study::VariantResult result) { journal->add(std::move(result), {}, "cpu"); });
    files.writePart(1, *journal);
  }

  /// Reads the folder as a process that continues the study.
  void read() const {
    study::StudyFolder files(folder_, spec_, plan_, "test");
    files.begin(files.partsOfManifest().value_or(1));
    files.missingParts();
    files.read();
  }

 private:
  study::StudySpec spec_;
  study::StudyPlan plan_;
  fs::path folder_;
};

void writeStudy(const fs::path& folder) {
  writeFile(folder / "study.yaml", "schema_version: 1\nscenario: " + shippedScenario("quick.yaml") + R"(
times: 0
cell_m: 5000
sites: {platform: mast, grid_m: 10000, choose: 1}
measures: [{name: lit, quantity: power_density_dbwm2, threshold: -60, height: "agl:100"}]
)");
  SmallStudy(folder).compute();
}

/// Sets the checksums in a part's record: those of arbitrary bytes are hardly ever right.
void sealPart(const fs::path& parts) {
  const fs::path file = parts / "part_00001.json";
  auto record = nlohmann::ordered_json::parse(readFile(file), nullptr, false);
  if (!record.is_object()) return;
  for (const char* const ending : {"csv", "bits"}) {
    const FileDigest digest = digestOf(parts / ("part_00001." + std::string(ending)));
    record[ending] = {{"bytes", digest.bytes}, {"crc32", digest.crc32}};
  }
  record.erase("crc32");
  FileDigest digest;
  addToDigest(dumpJson(record), digest);
  record["crc32"] = digest.crc32;
  writeFile(file, dumpJson(record));
}

void readStudy(const fs::path& file, const std::string&) {
  static std::map<fs::path, SmallStudy> studies;
  fs::path folder = file.parent_path().parent_path();
  if (folder.filename() == "out") {
    sealPart(file.parent_path());
    folder = folder.parent_path();
  }
  studies.try_emplace(folder, folder).first->second.read();
}

std::vector<std::string> studySeed(const std::string& file) {
  const TemporaryFolder folder;
  writeStudy(folder.path());
  return {readFile(folder / ("out/" + file))};
}

const FuzzTargetsAdded added({
    {"areps", "input.txt",
     [](const fs::path& file, const std::string&) {
       const report::ArepsTable table = report::readAreps(file.string());
       table.at_db(table.max_range_m, table.max_height_m);
       table.at_db(0.7 * table.max_range_m, 0.5 * (table.min_height_m + table.max_height_m));
     },
     [] {
       return std::vector<std::string>{
           "Bearing angle = 30\nHmin = 0\nHmax = 100\nNzout = 2\nRmax = 3000\nNrout = 3\n[Apm Loss Data]\n"
           "GroundValue = -32766\n-32766 1010 1020\n1100 1110 1120\n1200 1210 1220\n"};
     }},
    {"study", "study/input.yaml",
     [](const fs::path& file, const std::string&) { study::loadStudy(file, {}, "0", false); },
     [] {
       return std::vector<std::string>{readFile(sourceFile("scenarios/study/jammer_power.yaml")),
                                       readFile(sourceFile("scenarios/study/radar_sites.yaml"))};
     },
     copyScenarios},
    {"part_journal", "part.journal",
     [](const fs::path& file, const std::string&) {
       study::PartJournal(file, {0, 1}, 1);
     },
     journals},
    {"part_record", "part.journal", readPartRecord,
     [] {
       std::vector<std::string> records;
       for (const std::string& journal : journals()) records.push_back(journal.substr(journal.find('{')));
       records.push_back(R"({"row":"1,3.5","machine":"cpu","warnings":[],"pixels":11,"bits":"ff07"})");
       return records;
     }},
    {"map_report", "map/report.json", readMaps, [] { return mapSeed("report.json"); }, writeMaps},
    {"map_record", "map/study.json", readMaps, [] { return mapSeed("study.json"); }, writeMaps},
    {"map_tif", "map/maps/covered_agl150m_t0s.tif", readMaps,
     [] { return mapSeed("maps/covered_agl150m_t0s.tif"); }, writeMaps},
    {"study_manifest", "out/manifest.json", readStudy, [] { return studySeed("manifest.json"); }, writeStudy},
    {"study_part_json", "out/parts/part_00001.json", readStudy,
     [] { return studySeed("parts/part_00001.json"); }, writeStudy},
    {"study_part_csv", "out/parts/part_00001.csv", readStudy,
     [] { return studySeed("parts/part_00001.csv"); }, writeStudy},
    {"candidates", "input.geojson",
     [](const fs::path& file, const std::string&) { study::readCandidates(file); },
     [] {
       return std::vector<std::string>{
           R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "hill"},
"geometry": {"type": "Point", "coordinates": [5.1, 52.1]}}, {"type": "Feature", "properties": {},
"geometry": {"type": "Point", "coordinates": [5.2, 52.2]}}]})"};
     }},
    {"polygons", "input.geojson",
     [](const fs::path& file, const std::string&) {
       static const study::MapGrid grid = study::makeMapGrid(study::parseArea("52,5,10000"), 500, "utm");
       study::pixelsWithin(file, grid);
     },
     [] {
       return std::vector<std::string>{
           R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {},
"geometry": {"type": "Polygon", "coordinates": [[[5, 52], [5.05, 52], [5.02, 52.04], [5, 52]]]}},
{"type": "Feature", "properties": {}, "geometry": {"type": "MultiPolygon", "coordinates":
[[[[4.9, 51.9], [5.1, 51.9], [5, 52.1], [4.9, 51.9]], [[4.95, 51.95], [5, 51.95], [5, 52], [4.95, 51.95]]]]}}]})",
           R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:32631"}},
"features": [{"type": "Feature", "geometry": {"type": "Polygon", "coordinates":
[[[635000, 5760000], [640000, 5760000], [640000, 5765000], [635000, 5760000]]]}}]})"};
     }},
    {"map_area", "", [](const fs::path&, const std::string& text) { study::parseArea(text); },
     [] {
       return std::vector<std::string>{"36.3,-84.2,8000", "bbox:-84.3,36.2,-84.1,36.4",
                                       "bbox:179,10,-179,11"};
     }},
    {"map_heights", "", [](const fs::path&, const std::string& text) { study::parseHeights(text); },
     [] {
       return std::vector<std::string>{"agl:300", "agl:100,msl:1500", "agl:50:300:50"};
     }},
});

}  // namespace
}  // namespace emscape::test
