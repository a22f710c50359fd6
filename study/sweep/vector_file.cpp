#include "study/sweep/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "emscape/base/error.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

/// Longest text (bytes) that a message repeats.
constexpr std::size_t kMaxShown = 80;

[[noreturn]] void failIncomplete(const std::string& file, const scenario::GdalMessages& messages) {
  throw Error(ErrorCode::bad_input, {file, 0, 0}, messages.explain("cannot be read completely"));
}

}  // namespace

VectorFile::VectorFile(const std::string& file) : file_(file), dataset_(openVectors(messages_, file)) {
  if (messages_.hasFailure()) failIncomplete(file_, messages_);
}

std::vector<std::string> VectorFile::files() const {
  std::vector<std::string> files{file_};
  char** const names = GDALGetFileList(dataset_.get());
  for (char** name = names; name != nullptr && *name != nullptr; ++name) {
    std::error_code ignored;
    if (*name != file_ && std::filesystem::is_regular_file(*name, ignored)) files.emplace_back(*name);
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
  const scenario::GdalMessages messages;
  gdal::Feature feature(OGR_L_GetNextFeature(layer));
  if (messages.hasFailure()) failIncomplete(file_, messages);
  if (feature != nullptr) requireGeometry(layer, feature.get());
  return feature;
}

void VectorFile::requireGeometry(OGRLayerH layer, OGRFeatureH feature) const {
  if (OGR_F_GetGeometryRef(feature) != nullptr) return;
  // GDAL reports no failure for such a cell.
  const std::string driver = GDALGetDriverShortName(GDALGetDatasetDriver(dataset_.get()));
  const int wkt = driver == "CSV" ? OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), "WKT") : -1;
  const std::string text = wkt < 0 ? "" : OGR_F_GetFieldAsString(feature, wkt);
  if (text.empty()) return;
  throw Error(ErrorCode::bad_input, {file_, 0, 0},
              fmt::format("the WKT of row {} after the header is not a geometry{}", OGR_F_GetFID(feature),
                          text.size() > kMaxShown ? "" : ": '" + text + "'"));
}

}  // namespace emscape::study
