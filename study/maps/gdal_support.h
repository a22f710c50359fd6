/// GDAL's datasets, for the writers of this module.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "emscape/study/maps/map_grid.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::study {

/// @throws Error (other) if GDAL was built without it
GDALDriverH driverOf(const char* name);

/// Opens a file of points or polygons: GeoPackage, GeoJSON, shapefile, FlatGeobuf, KML, GML or CSV. No other
/// format and none of GDAL's virtual file systems: they read further files, databases and network services.
/// @param messages  in whose scope the data set is also read: it prevents network access of GDAL
/// @throws Error (bad_input) that names the file and GDAL's reason
gdal::Dataset openVectors(const scenario::GdalMessages& messages, const std::string& file);

/// @throws Error (other) that names the file and GDAL's reason
[[noreturn]] void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file);

/// Ending of the file in which GDAL stores what a format does not support.
constexpr const char* kAuxiliary = ".aux.xml";

/// A raster of one band in memory, with a grid's pixels and georeference.
/// @throws Error (other) naming the destination file
gdal::Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file);

/// As WKT2:2019.
std::string wkt2Of(OGRSpatialReferenceH reference);
/// x to the east, y to the north, whatever the authority's order.
gdal::SpatialReference referenceOf(const MapGrid& grid);
/// WGS84: longitude, latitude. @throws Error (other) with PROJ's reason, as where its database is missing
gdal::SpatialReference wgs84Reference();
/// @throws Error (other) with PROJ's reason if there is no transformation
gdal::Transformation transformationBetween(const gdal::SpatialReference& from,
                                           const gdal::SpatialReference& to);

}  // namespace emscape::study
