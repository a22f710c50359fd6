/// Reads a folder that `emscape coverage` wrote.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/study/maps/coverage.h"

namespace emscape::study {

struct CoverageFolder {
  std::filesystem::path path;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  std::shared_ptr<const MapGrid> grid;  ///< of all maps
  std::vector<CoverageMap> maps;        ///< without values and areas, in the order of report.json
  std::vector<std::string> geotiffs;    ///< of each map, relative to the folder; empty: none
  /// Has name, file and hash; the rest only if has_inputs.
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;  ///< over the maps and all platforms, if has_inputs; null: none
  /// True if the scenario's files and its elevation files still exist with the same content.
  bool has_inputs = false;
};

/// Reads report.json, study.json and the head of the first GeoTIFF.
/// @throws Error (bad_input) naming the file, for a folder that `emscape coverage` did not write
CoverageFolder openCoverageFolder(const std::filesystem::path& folder);

/// Reads the values of a map.
/// @param map  index of CoverageFolder::maps
/// @throws Error (bad_input) naming the GeoTIFF: missing, not readable, or with other pixels than the first
CoverageMap readMap(const CoverageFolder& folder, std::size_t map);

/// "covered at 150 m above ground, t = 80 s".
std::string nameOf(const CoverageMap& map);

}  // namespace emscape::study
