#include "scenario/terrain/raster_blocks.h"

#include <cpl_string.h>
#include <fmt/format.h>

namespace emscape::scenario {
namespace {

constexpr double kMebibyte = 1 << 20;
constexpr double kMaxBlockBytes = 256 * kMebibyte;

/// @param interleaved_bands  number of bands that one block holds
std::string faultOfBlock(GDALRasterBandH band, int interleaved_bands) {
  int columns = 0, rows = 0;
  GDALGetBlockSize(band, &columns, &rows);
  const double bytes =
      1.0 * GDALGetDataTypeSizeBytes(GDALGetRasterDataType(band)) * columns * rows * interleaved_bands;
  if (bytes <= kMaxBlockBytes) return "";
  return fmt::format(
      "its blocks of {} x {} values{} take {:.0f} MiB each, more than the allowed {:.0f} MiB; "
      "gdal_translate -b 1 -co TILED=YES writes smaller ones",
      columns, rows, interleaved_bands > 1 ? fmt::format(" in {} bands", interleaved_bands) : "",
      bytes / kMebibyte, kMaxBlockBytes / kMebibyte);
}

}  // namespace

std::string faultOfBlocks(GDALDatasetH dataset) {
  GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
  if (band == nullptr) return "";
  const char* interleave = GDALGetMetadataItem(dataset, "INTERLEAVE", "IMAGE_STRUCTURE");
  const bool by_pixel = interleave != nullptr && EQUAL(interleave, "PIXEL");
  const std::string fault = faultOfBlock(band, by_pixel ? GDALGetRasterCount(dataset) : 1);
  return fault.empty() ? faultOfBlock(GDALGetMaskBand(band), 1) : fault;
}

}  // namespace emscape::scenario
