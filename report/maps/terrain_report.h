/// What was understood of elevation files: `emscape terrain`.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "report/json.h"

namespace emscape::report {

struct TerrainReport {
  std::vector<scenario::TerrainFileInfo> files;
  scenario::GeoBox needed;  ///< the area of the scenario, or of all files
  scenario::TerrainPtr terrain;
};

/// @throws Error (bad_input) naming the file; (usage) if the files' area is too large for a picture
TerrainReport terrainReport(const scenario::TerrainSpec& files);
/// @throws Error (bad_input) also if the scenario names no elevation files
TerrainReport terrainReport(const scenario::Scenario& scenario);

/// Parts of the area by class.
Json landCoverJson(const scenario::LandCover& cover);
Json toJson(const TerrainReport& report);
std::string terrainText(const TerrainReport& report);

}  // namespace emscape::report
