#include "emscape/playback/frames/inputs.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "base/files/file_reading.h"
#include "base/files/inputs.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/volume/format/file.h"
#include "playback/frames/volume_input.h"
#include "recording/read_recording.h"
#include "scenario/file/file_kind.h"
#include "scenario/terrain/file_names.h"

namespace emscape::playback {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{16} << 20;

bool sameBox(const scenario::GeoBox& a, const scenario::GeoBox& b) {
  return a.south_deg == b.south_deg && a.north_deg == b.north_deg && a.west_deg == b.west_deg &&
         a.east_deg == b.east_deg;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

InputKind inputKindOf(const std::string& file) {
  if (!inputExists(file)) throw Error(ErrorCode::bad_input, {file, 0, 0}, "no such file or folder");
  if (holdsMeshes(file)) return InputKind::mesh;
  if (fs::is_directory(file)) return InputKind::volume;
  const std::string ending = lowerCase(fs::path(file).extension().string());
  static const std::set<std::string> kAntennas{".msi",     ".pln", ".adf", ".ant",
                                               ".pattern", ".az",  ".el",  ".csv"};
  const std::vector<std::string>& recordings = interop::recordingEndings();
  if (ending == ".yaml" || ending == ".yml" || ending == ".json") return InputKind::scenario;
  if (ending == ".pvd" || volume::isVolumeFile(file)) return InputKind::volume;
  if (scenario::isElevationName(file)) return InputKind::elevation;
  if (kAntennas.count(ending) != 0) return InputKind::antenna;
  if (std::find(recordings.begin(), recordings.end(), ending) != recordings.end())
    return InputKind::recording;
  throw Error(
      ErrorCode::bad_input, {file, 0, 0},
      "ending '" + ending +
          "' is not known; scenarios: .yaml .yml .json; volumes: .vdb .nvdb .vti .vtu .pvd .raw .dat; "
          "elevation: .tif .hgt .dt0 .dt1 .dt2 .vrt .asc .bil .flt .dem .img .nc .xyz .gpkg, also in .zip "
          "and .gz; antennas: .msi .pln .adf .ant .pattern .az .el .csv (a table of theta, phi and gain, as "
          "field solvers write it as text, is read as .csv with the columns theta_deg,phi_deg,gain_dbi); "
          "recordings: " +
          interop::recordingEndingsText());
}

JsonContent jsonContentOf(const std::string& file) {
  const fs::path name = lowerCase(fs::path(file).filename().string());
  std::error_code ignored;
  if (name.extension() != ".json" || !fs::is_regular_file(file, ignored)) return JsonContent::other;
  if (name.stem().extension() == ".view") return JsonContent::view;
  if (volume::isVolumeFile(name.stem())) return JsonContent::header;
  if (fs::file_size(file, ignored) > kMaxJsonBytes) return JsonContent::other;
  const auto json = nlohmann::json::parse(readWholeText(file, kMaxJsonBytes), nullptr, false);
  switch (scenario::documentKindOf(json)) {
    case scenario::DocumentKind::transfer:
      return JsonContent::transfer;
    case scenario::DocumentKind::series:
      return JsonContent::series;
    case scenario::DocumentKind::view:
      return JsonContent::view;
    default:
      return JsonContent::other;
  }
}

void requireScenarioFile(const std::string& file) {
  using scenario::DocumentKind;
  const auto refuse = [&file](const std::string& text) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, text);
  };
  switch (jsonContentOf(file)) {
    case JsonContent::other:
      return;
    case JsonContent::view:
      return refuse(scenario::otherDocumentText(DocumentKind::view, DocumentKind::scenario));
    case JsonContent::transfer:
      return refuse(scenario::otherDocumentText(DocumentKind::transfer, DocumentKind::scenario));
    case JsonContent::header:
      return refuse("the header of a volume: open " + fs::path(file).stem().string() + " beside it");
    case JsonContent::series:
      return refuse(scenario::otherDocumentText(DocumentKind::series, DocumentKind::scenario));
  }
}

LoadedScenario loadScenarioWithTerrain(const std::string& file, const std::vector<scenario::Edit>& edits) {
  constexpr double kScenarioPart = 0.2;
  requireScenarioFile(file);
  LoadedScenario loaded;
  {
    const WorkPart part("reading the scenario", 0, kScenarioPart);
    loaded.scenario = scenario::loadScenario(file, edits);
  }
  const WorkPart part("reading the terrain", kScenarioPart, 1);
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
