// Texts and tables of the field's module.
#include "emfield/check/measured_paths.h"
#include "emfield/check/reference_table.h"
#include "emscape/emfield/columns/terrain_mesh.h"
#include "tests/fuzz/fuzz_target.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;

const FuzzTargetsAdded added({
    {"terrain_mesh", "",
     [](const fs::path&, const std::string& text) {
       emfield::layerHeights_m(emfield::parseTerrainMesh(text), 3000);
     },
     [] {
       return std::vector<std::string>{"terrain:32", "terrain:19,4", "terrain:12,5,1.25"};
     }},
    {"reference_table", "input.csv",
     [](const fs::path& file, const std::string&) {
       const emfield::ReferenceTable table(file, {"f_ghz"});
       for (int row = 0; row < table.rows(); ++row) table.number(row, "f_ghz");
       for (int row = 0; row < table.rows(); ++row) table.integer(row, "case");
     },
     [] { return std::vector<std::string>{"# gases\nf_ghz,case,loss_db\n1,1,0.5\n22.2,2,1e-3\n"}; }},
    {"measured_paths", "losses.csv",
     [](const fs::path& file, const std::string&) {
       emfield::MeasuredOptions options;
       options.columns = {{"transmitter_height_agl_m", "10"}, {"frequency_mhz", "868"}};
       options.conditions = {emfield::PathCondition::parse("distance_m<50000")};
       options.group_deg = 0.001;
       options.models = {propagation::PropagationModel::free_space};
       emfield::checkMeasuredPaths(file.string(), scenario::Scenario{}, scenario::Emitter{}, options);
     },
     [] {
       return std::vector<std::string>{
           "transmitter_latitude_deg;transmitter_longitude_deg;receiver_latitude_deg;receiver_longitude_deg;"
           "receiver_height_msl_m;loss_db\n45;5;45.1;5;2;120\n45;5;45.1;5.2;1e3;131\n"};
     }},
    {"reference_profiles", "profiles.csv",
     [](const fs::path& file, const std::string&) { emfield::readReferenceProfiles(file); },
     [] { return std::vector<std::string>{"3,90,1,2,3,4\n1,30.5,100,-2.5\n"}; }},
});

}  // namespace
}  // namespace emscape::test
