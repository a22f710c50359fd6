#include "study/maps/gdal_support.h"

#include <fmt/format.h>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "scenario/terrain/transformation.h"

namespace emscape::study {
GDALDriverH driverOf(const char* name) {
  gdal::prepare();
  GDALDriverH driver = GDALGetDriverByName(name);
  if (driver == nullptr) throw Error(ErrorCode::other, fmt::format("GDAL has no driver '{}'", name));
  return driver;
}

gdal::Dataset openVectors(const scenario::GdalMessages& messages, const std::string& file) {
  static const char* const kDrivers[] = {"GPKG", "GeoJSON", "ESRI Shapefile", "FlatGeobuf", "KML", "LIBKML",
                                         "GML",  "CSV",     nullptr};
  // GML: no NAME.gfs beside the file. The @ is for the other drivers, which do not have the option.
  static const char* const kOptions[] = {"@WRITE_GFS=NO", nullptr};
  if (const std::string fault = gdal::faultOfName(file); !fault.empty()) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, fault);
  }
  gdal::Dataset dataset = gdal::openFile(file, GDAL_OF_VECTOR, kDrivers, kOptions);
  if (dataset == nullptr) {
    throw Error(ErrorCode::bad_input, {file, 0, 0},
                messages.explain("not a file of points or polygons that can be read"));
  }
  return dataset;
}

void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file) {
  throw Error(ErrorCode::other, file.string() + ": " + messages.explain("cannot be written"));
}

gdal::Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file) {
  const scenario::GdalMessages messages;
  gdal::Dataset dataset(GDALCreate(driverOf("MEM"), "", grid.width, grid.height, 1, type, nullptr));
  if (dataset == nullptr) failWriting(messages, file);
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  GDALSetGeoTransform(dataset.get(), transform);
  GDALSetProjection(dataset.get(), grid.wkt.c_str());
  return dataset;
}

std::string wkt2Of(OGRSpatialReferenceH reference) {
  static const char* const kOptions[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  OSRExportToWktEx(reference, &text, kOptions);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

gdal::SpatialReference referenceOf(const MapGrid& grid) {
  gdal::SpatialReference reference(OSRNewSpatialReference(grid.wkt.c_str()));
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

gdal::SpatialReference wgs84Reference() {
  const scenario::GdalMessages messages;
  gdal::SpatialReference reference(OSRNewSpatialReference(nullptr));
  if (OSRImportFromEPSG(reference.get(), 4326) != OGRERR_NONE)
    throw Error(ErrorCode::other, messages.explain("PROJ does not know EPSG:4326, longitude and latitude"));
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

gdal::Transformation transformationBetween(const gdal::SpatialReference& from,
                                           const gdal::SpatialReference& to) {
  const scenario::GdalMessages messages;
  gdal::Transformation transformation = scenario::newTransformation(from.get(), to.get());
  if (transformation == nullptr) {
    throw Error(ErrorCode::other, messages.explain("PROJ cannot transform between the coordinate systems"));
  }
  return transformation;
}

}  // namespace emscape::study
