#include "apps/emscape/inputs.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.h"
#include "scenario/scenario_yaml.h"

namespace emscape::app {
namespace {

/// The first bytes of a file. @throws Error (bad_input) if it cannot be read
std::string beginningOf(const std::string& file) {
  constexpr std::streamsize kBytes = 4096;
  std::ifstream in(file, std::ios::binary);
  std::string text(kBytes, '\0');
  if (!in.read(text.data(), kBytes) && !in.eof())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace

InputKind inputKindOf(const std::string& file) {
  namespace fs = std::filesystem;
  if (!fs::exists(file)) throw Error(ErrorCode::bad_input, {file, 0, 0}, "no such file or folder");
  if (fs::is_directory(file)) return InputKind::volume;
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  static const std::set<std::string> kVolumes{".vdb", ".nvdb", ".vti", ".pvd", ".raw", ".dat"};
  static const std::set<std::string> kElevations{".tif", ".tiff", ".hgt", ".dt0", ".dt1",
                                                 ".dt2", ".vrt",  ".asc", ".dem", ".bil"};
  static const std::set<std::string> kAntennas{".msi", ".pln", ".csv"};
  if (ending == ".yaml" || ending == ".yml") return InputKind::scenario;
  if (kVolumes.count(ending) != 0) return InputKind::volume;
  if (kElevations.count(ending) != 0) return InputKind::elevation;
  if (kAntennas.count(ending) != 0) return InputKind::antenna;
  if (ending == ".json") {
    // The header of a raw file, beside it, or a scenario.
    return beginningOf(file).find("\"dims\"") != std::string::npos &&
                   fs::exists(fs::path(file).replace_extension())
               ? InputKind::volume
               : InputKind::scenario;
  }
  throw Error(ErrorCode::bad_input, {file, 0, 0},
              "ending '" + ending +
                  "' is not known; scenarios: .yaml .yml .json; volumes: .vdb .nvdb .vti .pvd .raw .dat; "
                  "elevation: .tif .hgt .dt0 .dt1 .dt2 .vrt; antennas: .msi .pln .csv");
}

LoadedScenario loadScenarioWithTerrain(const std::string& file) {
  LoadedScenario loaded;
  loaded.scenario = scenario::loadScenario(file);
  if (loaded.scenario->terrain) {
    loaded.terrain =
        scenario::Terrain::load(*loaded.scenario->terrain, scenario::terrainBox(*loaded.scenario));
  }
  return loaded;
}

}  // namespace emscape::app
