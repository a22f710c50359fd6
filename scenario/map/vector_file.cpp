#include "scenario/map/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"

namespace emscape::scenario {
namespace {

gdal::Dataset openVectors(const GdalMessages& messages, MemoryFiles& unpacked, const std::string& file) {
  static const char* const kDrivers[] = {
      "GPKG", "GeoJSON", "ESRI Shapefile", "FlatGeobuf", "KML", "LIBKML", "GML", "GPX", "CSV", nullptr};
  // GML: no NAME.gfs beside the file. The @ is for the other drivers, which do not have the option.
  static const char* const kOptions[] = {"@WRITE_GFS=NO", nullptr};
  if (const std::string fault = gdal::faultOfName(file); !fault.empty()) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, fault);
  }
  const ElevationSource source = vectorSourceIn(file);
  gdal::Dataset dataset;
  if (source.member.empty()) {
    dataset = gdal::openFile(file, GDAL_OF_VECTOR, kDrivers, kOptions);
  } else {
    try {
      const std::string name = unpacked.unpack(source);
      dataset = gdal::openInMemory(name, GDAL_OF_VECTOR, kDrivers, unpacked.siblings().data(), kOptions);
    } catch (const Error& error) {
      throw Error(error.code(), {source.name(), 0, 0}, error.message());
    }
  }
  if (dataset == nullptr) {
    throw Error(ErrorCode::bad_input, {source.name(), 0, 0},
                messages.explain("not a file of points or polygons that can be read"));
  }
  return dataset;
}

bool isVectorName(const std::string& name) {
  static const std::set<std::string> kEndings{".gpkg", ".geojson", ".json", ".shp", ".fgb",
                                              ".kml",  ".gml",     ".gpx",  ".csv", ".tsv"};
  return kEndings.count(lowerEnding(name)) != 0;
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

ElevationSource vectorSourceIn(const std::string& file) {
  if (lowerEnding(file) != ".zip") return {file};
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, problem);
  };
  const GdalMessages messages;
  const std::vector<std::string> members = membersOfZip(file);
  std::vector<std::string> vectors;
  std::copy_if(members.begin(), members.end(), std::back_inserter(vectors), isVectorName);
  if (members.empty()) fail(messages.explain("cannot be read as a ZIP archive"));
  if (vectors.empty())
    fail(fmt::format("none of its {} members is a file of points or polygons by its ending, such as {}",
                     members.size(), members.front()));
  if (vectors.size() > 1)
    fail(fmt::format("has {} files of points or polygons; unpack it and name one, such as {}", vectors.size(),
                     vectors.front()));
  return {file, vectors.front()};
}

VectorFile::VectorFile(const std::string& file)
    : file_(file), dataset_(openVectors(messages_, unpacked_, file)) {
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
  const bool is_gpx = std::string(GDALGetDriverShortName(GDALGetDatasetDriver(dataset_.get()))) == "GPX";
  for (int n = 0; n < GDALDatasetGetLayerCount(dataset_.get()); ++n) {
    const OGRLayerH layer = GDALDatasetGetLayer(dataset_.get(), n);
    const std::string name = OGR_L_GetName(layer);
    const bool repeats = is_gpx && (name == "track_points" || name == "route_points");
    if (!repeats) layers.push_back(layer);
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
