// Studies, and texts of the options of maps.
#include "emscape/study/area.h"
#include "emscape/study/part_journal.h"
#include "emscape/study/products.h"
#include "emscape/study/study_file.h"
#include "study/sweep/candidate_sites.h"
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

const FuzzTargetsAdded added({
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
    {"candidates", "input.geojson",
     [](const fs::path& file, const std::string&) { study::readCandidates(file); },
     [] {
       return std::vector<std::string>{
           R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "hill"},
"geometry": {"type": "Point", "coordinates": [5.1, 52.1]}}, {"type": "Feature", "properties": {},
"geometry": {"type": "Point", "coordinates": [5.2, 52.2]}}]})"};
     }},
    {"map_area", "input.txt", [](const fs::path&, const std::string& text) { study::parseArea(text); },
     [] {
       return std::vector<std::string>{"36.3,-84.2,8000", "bbox:-84.3,36.2,-84.1,36.4",
                                       "bbox:179,10,-179,11"};
     }},
    {"map_heights", "input.txt", [](const fs::path&, const std::string& text) { study::parseHeights(text); },
     [] {
       return std::vector<std::string>{"agl:300", "agl:100,msl:1500", "agl:50:300:50"};
     }},
});

}  // namespace
}  // namespace emscape::test
