/// What to do with files that are not read as they are. Each remedy is run by a test on its case.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "base/geodesy/gdal.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {

/// A file that none of the allowed formats fits. @param is_picture  its colours are said to encode heights
std::string faultOfUnreadable(const ElevationSource& source, bool is_picture);
/// A file without a raster of its own, such as a netCDF file of several variables.
std::string remedyForContainer(GDALDatasetH dataset, const ElevationSource& source);
std::string remedyForPicture(int band, const std::string& colour, int bands);
/// @param is_tile  its colours encode heights, as those of web maps' tiles do
std::string remedyForNoGeoreference(const ElevationSource& source, bool is_tile);
/// @param has_classes  the file is of land cover, whose items have no keys
/// @param is_plane  the coordinates are too large for degrees
std::string remedyForNoSystem(const ElevationSource& source, bool has_classes, bool is_plane);
std::string remedyForTileWithoutPosition();

/// Describes a beginning of a file that is something else than its name says: a web page, a pointer of Git
/// LFS, a PDF; empty: none of these.
std::string foreignContent(std::string_view beginning);
std::string foreignContentOf(const std::string& file);

/// The fault of an ASCII grid with more values than its header says; empty: none.
/// @param text  of the file. Read as far as its first line, or whole if that has not one row
std::string faultOfGridLines(std::istream& text, long long columns, long long rows);
/// The unit of heights that the .prj of ArcInfo beside a raster states ("Zunits FEET"): "ft" or "m"; empty:
/// none.
std::string heightUnitBeside(const std::string& file);

/// The transform of a tile of a web map in EPSG:3857, by its path ZOOM/COLUMN/ROW.png or its name
/// ZOOM-COLUMN-ROW.png, with rows from the north; false: it has none.
bool webTileTransform(const std::string& file, int columns, int rows, double (&transform)[6]);

/// The number in EPSG:number.
std::optional<int> epsgCodeIn(const std::string& text);

}  // namespace emscape::scenario
