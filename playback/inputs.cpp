#include "emscape/playback/inputs.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "emscape/base/error.h"
#include "emscape/playback/volume_input.h"
#include "emscape/scenario/scenario_file.h"
#include "emscape/volume/file.h"

namespace emscape::playback {
namespace {

bool sameBox(const scenario::GeoBox& a, const scenario::GeoBox& b) {
  return a.south_deg == b.south_deg && a.north_deg == b.north_deg && a.west_deg == b.west_deg &&
         a.east_deg == b.east_deg;
}

}  // namespace

InputKind inputKindOf(const std::string& file) {
  namespace fs = std::filesystem;
  if (!fs::exists(file)) throw Error(ErrorCode::bad_input, {file, 0, 0}, "no such file or folder");
  if (holdsMeshes(file)) return InputKind::mesh;
  if (fs::is_directory(file)) return InputKind::volume;
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  static const std::set<std::string> kElevations{".tif", ".tiff", ".hgt", ".dt0", ".dt1",
                                                 ".dt2", ".vrt",  ".asc", ".dem", ".bil"};
  static const std::set<std::string> kAntennas{".msi", ".pln", ".csv"};
  if (ending == ".yaml" || ending == ".yml" || ending == ".json") return InputKind::scenario;
  if (ending == ".pvd" || volume::isVolumeFile(file)) return InputKind::volume;
  if (kElevations.count(ending) != 0) return InputKind::elevation;
  if (kAntennas.count(ending) != 0) return InputKind::antenna;
  throw Error(
      ErrorCode::bad_input, {file, 0, 0},
      "ending '" + ending +
          "' is not known; scenarios: .yaml .yml .json; volumes: .vdb .nvdb .vti .vtu .pvd .raw .dat; "
          "elevation: .tif .hgt .dt0 .dt1 .dt2 .vrt; antennas: .msi .pln .csv");
}

LoadedScenario loadScenarioWithTerrain(const std::string& file, const std::vector<scenario::Edit>& edits) {
  LoadedScenario loaded;
  loaded.scenario = scenario::loadScenario(file, edits);
  loaded.terrain = scenario::loadTerrain(*loaded.scenario);
  return loaded;
}

LoadedScenario withScenario(const LoadedScenario& loaded, std::shared_ptr<const scenario::Scenario> edited) {
  const bool same_files = loaded.scenario->terrain == edited->terrain;
  const bool same_box =
      loaded.terrain && sameBox(scenario::terrainBox(*loaded.scenario), scenario::terrainBox(*edited));
  LoadedScenario result{std::move(edited), loaded.terrain};
  if (!same_files || (loaded.terrain && !same_box)) result.terrain = scenario::loadTerrain(*result.scenario);
  return result;
}

}  // namespace emscape::playback
