#include "study/maps/gdal_support.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"

namespace emscape::study {
GDALDriverH driverOf(const char* name) {
  gdal::prepare();
  GDALDriverH driver = GDALGetDriverByName(name);
  if (driver == nullptr) throw Error(ErrorCode::other, fmt::format("GDAL has no driver '{}'", name));
  return driver;
}

void failWriting(const scenario::GdalMessages& messages, const std::filesystem::path& file) {
  const int cause = errno;
  checkpoint();
  std::string text = messages.explain("cannot be written");
  // GDAL does not always say why.
  const bool is_limit = cause == EMFILE || cause == ENFILE || cause == ENOSPC || cause == EDQUOT;
  if (!messages.hasFailure() && is_limit) text += ": " + std::generic_category().message(cause);
  throw Error(ErrorCode::other, file.string() + ": " + text);
}

int goesOn(double /*done*/, const char* /*message*/, void* /*data*/) {
  return currentWork() == nullptr || !currentWork()->isStopped() ? TRUE : FALSE;
}

gdal::Dataset memoryRaster(const MapGrid& grid, GDALDataType type, const std::filesystem::path& file) {
  const scenario::GdalMessages messages;
  gdal::Dataset dataset(GDALCreate(driverOf("MEM"), "", grid.width, grid.height, 1, type, nullptr));
  if (dataset == nullptr) failWriting(messages, file);
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  if (GDALSetGeoTransform(dataset.get(), transform) != CE_None ||
      GDALSetProjection(dataset.get(), grid.wkt.c_str()) != CE_None)
    failWriting(messages, file);
  return dataset;
}

std::string wkt2Of(OGRSpatialReferenceH reference) {
  static const char* const kOptions[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  const OGRErr failed = OSRExportToWktEx(reference, &text, kOptions);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  if (failed != OGRERR_NONE || wkt.empty())
    throw Error(ErrorCode::other, "PROJ gives no text of a coordinate system");
  return wkt;
}

gdal::SpatialReference referenceOf(const MapGrid& grid) {
  gdal::SpatialReference reference(OSRNewSpatialReference(grid.wkt.c_str()));
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

}  // namespace emscape::study
