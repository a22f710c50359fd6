/// Memory for reading rasters through GDAL. Also used by the readers of maps.
#pragma once

#include <gdal.h>

#include <string>

namespace emscape::scenario {

/// Says that a decoded block of the first band or of its mask takes more than 256 MiB. GDAL holds all blocks
/// that a window touches, and a small file may have large ones: without values they take no room in it. Empty
/// if all are smaller.
std::string faultOfBlocks(GDALDatasetH dataset);

}  // namespace emscape::scenario
