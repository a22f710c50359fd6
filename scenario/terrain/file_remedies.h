/// What to do with files that are not read as they are. Each remedy is run by a test on its case.
#pragma once

#include <optional>
#include <string>

#include "base/geodesy/gdal.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {

/// A file that none of the allowed formats fits. @param is_picture  its colours are said to encode heights
std::string faultOfUnreadable(const ElevationSource& source, bool is_picture);
/// A file without a raster of its own, such as a netCDF file of several variables.
std::string remedyForContainer(GDALDatasetH dataset, const ElevationSource& source);
std::string remedyForPicture(int band, const std::string& colour, int bands);
std::string remedyForNoGeoreference(const ElevationSource& source);
/// @param is_plane  the coordinates are too large for degrees
std::string remedyForNoSystem(bool is_plane);
std::string remedyForTileWithoutPosition();

/// The transform of a tile of a web map, by its path ZOOM/COLUMN/ROW.png, in EPSG:3857; false: it has none.
bool webTileTransform(const std::string& file, int columns, int rows, double (&transform)[6]);

/// The number in EPSG:number.
std::optional<int> epsgCodeIn(const std::string& text);

}  // namespace emscape::scenario
