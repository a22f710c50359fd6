/// Maps as cloud-optimised GeoTIFF.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/files/own_file.h"
#include "emscape/study/maps/map.h"

namespace emscape::study {

/// Writes a map, atomically. Counts and indices are bytes (255: no value) with a colour table and labels in
/// the metadata (EMSCAPE_LABEL_0 ...) and, as names of categories and an attribute table, in FILE.aux.xml
/// beside it. Other values are Float32 with NaN for no value.
/// @param metadata  additional items, EMSCAPE_NAME and value
/// @throws Error (other) that names the file and GDAL's reason
void writeGeoTiff(const std::filesystem::path& file, const MapGrid& grid, const Map& map,
                  const std::vector<std::pair<std::string, std::string>>& metadata,
                  Replaces replaces = Replaces::own);

}  // namespace emscape::study
