/// GDAL's datasets, for the writers of this module.
#pragma once

#include <filesystem>
#include <string>

#include "base/geodesy/gdal.h"
#include "emscape/study/maps/map_grid.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::study {

/// @throws Error (other) if GDAL was built without it
GDALDriverH driverOf(const char* name);

/// @throws Error (other) that names the file, GDAL's reason and, where it is known, the system's; Stopped
[[noreturn]] void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file);

/// For long calls of GDAL: they end as failed once the work is stopped, and failWriting() throws Stopped.
int goesOn(double done, const char* message, void* data);

/// Ending of the file in which GDAL stores what a format does not support.
constexpr const char* kAuxiliary = ".aux.xml";
/// For files that GDAL and SQLite read with a raster or a database, as if they were its own: statistics and
/// labels, overviews, masks and journals.
/// @throws Error (usage) that names one that emscape did not write
void requireOwnBeside(const std::filesystem::path& file);

/// A raster of one band in memory, with a grid's pixels and georeference.
/// @throws Error (other) naming the destination file
gdal::Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file);

/// As WKT2:2019.
std::string wkt2Of(OGRSpatialReferenceH reference);
/// x to the east, y to the north, whatever the authority's order.
gdal::SpatialReference referenceOf(const MapGrid& grid);

}  // namespace emscape::study
