#include "scenario/map/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"

namespace emscape::scenario {
namespace {

gdal::Dataset openVectors(const GdalMessages& messages, const std::string& file) {
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

/// Longest text (bytes) that a message repeats.
constexpr std::size_t kMaxShown = 80;

[[noreturn]] void failIncomplete(const std::string& file, const GdalMessages& messages) {
  throw Error(ErrorCode::bad_input, {file, 0, 0}, messages.explain("cannot be read completely"));
}

/// Index of the column from which GDAL's CSV driver makes a layer's geometry; -1: none.
int geometryColumn(OGRFeatureDefnH layer) {
  if (OGR_FD_GetGeomFieldCount(layer) == 0) return -1;
  // The driver names the geometry of a column WKT "", that of a column _WKT... "geom_" and the column's name,
  // and that of a column with the type WKT in the .csvt file beside it as the column.
  const std::string geometry = OGR_GFld_GetNameRef(OGR_FD_GetGeomFieldDefn(layer, 0)), prefix = "geom_";
  const int column = OGR_FD_GetFieldIndex(layer, geometry.empty() ? "WKT" : geometry.c_str());
  if (column >= 0 || geometry.compare(0, prefix.size(), prefix) != 0) return column;
  return OGR_FD_GetFieldIndex(layer, geometry.substr(prefix.size()).c_str());
}

}  // namespace

VectorFile::VectorFile(const std::string& file) : file_(file), dataset_(openVectors(messages_, file)) {
  if (messages_.hasFailure()) failIncomplete(file_, messages_);
}

std::vector<std::string> VectorFile::files() const {
  std::vector<std::string> files{file_};
  const std::filesystem::path own = gdal::localName(file_);
  char** const names = GDALGetFileList(dataset_.get());
  for (char** name = names; name != nullptr && *name != nullptr; ++name) {
    std::error_code ignored;
    if (*name == own || !std::filesystem::is_regular_file(*name, ignored)) continue;
    // GDAL gives absolute names; the others are beside the file.
    files.push_back(std::filesystem::path(file_).replace_filename(std::filesystem::path(*name).filename()));
  }
  CSLDestroy(names);
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<OGRLayerH> VectorFile::layers() const {
  std::vector<OGRLayerH> layers;
  for (int n = 0; n < GDALDatasetGetLayerCount(dataset_.get()); ++n) {
    layers.push_back(GDALDatasetGetLayer(dataset_.get(), n));
  }
  return layers;
}

gdal::Feature VectorFile::next(OGRLayerH layer) const {
  const GdalMessages messages;
  gdal::Feature feature(OGR_L_GetNextFeature(layer));
  if (messages.hasFailure()) failIncomplete(file_, messages);
  if (feature != nullptr) requireGeometry(layer, feature.get());
  return feature;
}

void VectorFile::requireGeometry(OGRLayerH layer, OGRFeatureH feature) const {
  if (OGR_F_GetGeometryRef(feature) != nullptr) return;
  // GDAL reports no failure for such a cell.
  const std::string driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset_.get()));
  const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
  const int column = driver == "CSV" ? geometryColumn(definition) : -1;
  const std::string text = column < 0 ? "" : OGR_F_GetFieldAsString(feature, column);
  if (text.empty()) return;
  const std::string name = OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, column));
  throw Error(ErrorCode::bad_input, {file_, 0, 0},
              fmt::format("the {} of row {} after the header is not a geometry{}",
                          name.size() > kMaxShown ? "WKT" : name, OGR_F_GetFID(feature),
                          text.size() > kMaxShown ? "" : ": '" + text + "'"));
}

}  // namespace emscape::scenario
