/// GDAL's datasets, for the writers of this module.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "emscape/study/map_grid.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::study {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// @throws Error (other) if GDAL was built without it
GDALDriver* driverOf(const char* name);

/// @throws Error (other) that names the file and GDAL's reason
[[noreturn]] void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file);

/// A raster of one band in memory, of a grid's pixels and in its place.
/// @throws Error (other) naming the file for which it is made
Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file);

/// x to the east, y to the north, whatever the authority's order.
OGRSpatialReference referenceOf(const MapGrid& grid);
/// WGS84: longitude, latitude.
OGRSpatialReference wgs84Reference();

}  // namespace emscape::study
