#include "study/files/geotiff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/files/unfinished_file.h"
#include "study/maps/gdal_support.h"
#include "study/picture/map_colors.h"

namespace emscape::study {
namespace {

constexpr int kNoIndex = 255;
constexpr float kMaxIndex = 254;  ///< for counts also larger values

/// Colours of counts and indices 0 .. count - 1 as in pictures; white for the class 0, since colour tables of
/// GeoTIFF have no transparency except for the value that means none.
gdal::ColorTable colorsOf(const Map& map, int count) {
  gdal::ColorTable table(GDALCreateColorTable(GPI_RGB));
  const render::Legend legend = legendOf(map);
  const GDALColorEntry none{255, 255, 255, 0};
  const auto byteOf = [](float part) { return static_cast<short>(std::lround(255 * part)); };
  for (int i = 0; i < count; ++i) {
    const std::optional<render::Rgb> color = colorOf(map, legend, static_cast<float>(i));
    const GDALColorEntry entry =
        color ? GDALColorEntry{byteOf(color->r), byteOf(color->g), byteOf(color->b), 255} : none;
    GDALSetColorEntry(table.get(), i, &entry);
  }
  GDALSetColorEntry(table.get(), kNoIndex, &none);
  return table;
}

/// The labels of a band's values, in the forms that programs read: names of categories and an attribute
/// table.
CPLErr setLabels(GDALRasterBandH band, const std::vector<std::string>& labels) {
  const gdal::AttributeTable table(GDALCreateRasterAttributeTable());
  CPLErr failed = GDALRATCreateColumn(table.get(), "VALUE", GFT_Integer, GFU_MinMax);
  failed = std::max(failed, GDALRATCreateColumn(table.get(), "LABEL", GFT_String, GFU_Name));
  std::vector<char*> names;
  for (int n = 0; n < static_cast<int>(labels.size()); ++n) {
    const std::string& label = labels[static_cast<std::size_t>(n)];
    GDALRATSetValueAsInt(table.get(), n, 0, n);
    GDALRATSetValueAsString(table.get(), n, 1, label.c_str());
    names.push_back(const_cast<char*>(label.c_str()));
  }
  names.push_back(nullptr);
  failed = std::max(failed, GDALSetDefaultRAT(band, table.get()));
  return std::max(failed, GDALSetRasterCategoryNames(band, names.data()));
}

/// EPSG code of a raster's coordinate system; empty: none.
std::string codeOf(GDALDatasetH raster) {
  const OGRSpatialReferenceH reference = GDALGetSpatialRef(raster);
  const char* const code = reference == nullptr ? nullptr : OSRGetAuthorityCode(reference, nullptr);
  return code == nullptr ? "" : code;
}

/// True if the coordinate system was written: the driver leaves it out if the database of PROJ cannot be
/// read.
bool hasCodeOf(GDALDatasetH raster, const std::filesystem::path& file) {
  static const char* const kDrivers[] = {"GTiff", nullptr};
  const gdal::Dataset written(
      GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_INTERNAL, kDrivers, nullptr, nullptr));
  return written != nullptr && codeOf(written.get()) == codeOf(raster);
}

}  // namespace

void writeGeoTiff(const std::filesystem::path& file, const MapGrid& grid, const Map& map,
                  const std::vector<std::pair<std::string, std::string>>& metadata, Replaces replaces) {
  const bool is_index = isWhole(map.kind);
  GDALDriverH cog = driverOf("COG");
  const scenario::GdalMessages messages;
  const gdal::Dataset dataset = memoryRaster(grid, is_index ? GDT_Byte : GDT_Float32, file);
  const auto require = [&](CPLErr result) {
    if (result != CE_None) failWriting(messages, file);
  };
  const auto setItem = [&](const std::string& name, const std::string& value) {
    require(GDALSetMetadataItem(dataset.get(), name.c_str(), value.c_str(), nullptr));
  };
  setItem("AREA_OR_POINT", "Point");
  for (const auto& [name, value] : metadata) setItem(name, value);
  for (std::size_t n = 0; is_index && n < map.labels.size(); ++n)
    setItem(fmt::format("EMSCAPE_LABEL_{}", n), map.labels[n]);
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  GDALSetDescription(band, map.description.c_str());
  require(GDALSetRasterUnitType(band, map.unit.c_str()));
  if (is_index) {
    std::vector<std::uint8_t> bytes;
    int largest = 1;
    for (const float value : map.values) {
      const bool is_none = std::isnan(value) || value < 0;
      const int index = is_none ? kNoIndex : static_cast<int>(std::min(value, kMaxIndex));
      bytes.push_back(static_cast<std::uint8_t>(index));
      if (!is_none) largest = std::max(largest, index);
    }
    require(GDALSetRasterNoDataValue(band, kNoIndex));
    const int colors = std::max(largest + 1, static_cast<int>(map.labels.size()));
    require(GDALSetRasterColorTable(band, colorsOf(map, colors).get()));
    if (!map.labels.empty()) require(setLabels(band, map.labels));
    require(GDALRasterIO(band, GF_Write, 0, 0, grid.width, grid.height, bytes.data(), grid.width, grid.height,
                         GDT_Byte, 0, 0));
  } else {
    require(GDALSetRasterNoDataValue(band, NAN));
    require(GDALRasterIO(band, GF_Write, 0, 0, grid.width, grid.height, const_cast<float*>(map.values.data()),
                         grid.width, grid.height, GDT_Float32, 0, 0));
  }

  requireOwnBeside(file);
  UnfinishedFile unfinished(file, replaces);
  // The COG driver writes overviews next to the output.
  const char* const options[] = {
      "COMPRESS=DEFLATE", is_index ? "PREDICTOR=NO" : "PREDICTOR=YES", "OVERVIEWS=AUTO",
      is_index ? "OVERVIEW_RESAMPLING=NEAREST" : "OVERVIEW_RESAMPLING=AVERAGE", nullptr};
  bool is_complete = false;
  {
    const gdal::Dataset copy(
        GDALCreateCopy(cog, unfinished.temporary().c_str(), dataset.get(), TRUE, options, goesOn, nullptr));
    is_complete = copy != nullptr;
  }
  if (!is_complete || messages.hasFailure()) failWriting(messages, file);
  if (!hasCodeOf(dataset.get(), unfinished.temporary()))
    throw Error(ErrorCode::other, file.string() + ": its coordinate system cannot be written");
  unfinished.publish(kAuxiliary);
}

}  // namespace emscape::study
