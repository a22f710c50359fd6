#include "emscape/study/geotiff.h"

#include <fmt/format.h>
#include <gdal_rat.h>

#include <algorithm>
#include <cmath>

#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

constexpr int kNoIndex = 255;
constexpr float kLargestIndex = 254;  ///< of counts it stands for more, too

/// Colours of counts and indices: none for 0, then hues that differ.
GDALColorTable coloursOf(MapKind kind, int count) {
  // Okabe and Ito's colours for colour-blind readers.
  static constexpr GDALColorEntry kColours[] = {{230, 159, 0, 255},  {86, 180, 233, 255}, {0, 158, 115, 255},
                                                {240, 228, 66, 255}, {0, 114, 178, 255},  {213, 94, 0, 255},
                                                {204, 121, 167, 255}};
  GDALColorTable table;
  const GDALColorEntry none{0, 0, 0, 0};
  for (int i = 0; i < count; ++i) {
    const bool is_none = kind != MapKind::category && i == 0;
    const int hue = kind == MapKind::category ? i : i - 1;
    table.SetColorEntry(i, is_none ? &none : &kColours[hue % 7]);
  }
  table.SetColorEntry(kNoIndex, &none);
  return table;
}

/// The labels of a band's values, as programs look for them: names of categories and a table of attributes.
void setLabels(GDALRasterBand& band, const std::vector<std::string>& labels) {
  GDALDefaultRasterAttributeTable table;
  table.CreateColumn("VALUE", GFT_Integer, GFU_MinMax);
  table.CreateColumn("LABEL", GFT_String, GFU_Name);
  CPLStringList names;
  for (int n = 0; n < static_cast<int>(labels.size()); ++n) {
    const std::string& label = labels[static_cast<std::size_t>(n)];
    table.SetValue(n, 0, n);
    table.SetValue(n, 1, label.c_str());
    names.AddString(label.c_str());
  }
  band.SetDefaultRAT(&table);
  band.SetCategoryNames(names.List());
}

}  // namespace

void writeGeoTiff(const std::filesystem::path& file, const MapGrid& grid, const Map& map,
                  const std::vector<std::pair<std::string, std::string>>& metadata) {
  const bool is_index = isWhole(map.kind);
  GDALDriver* const cog = driverOf("COG");
  const scenario::GdalMessages messages;
  const Dataset dataset = memoryRaster(grid, is_index ? GDT_Byte : GDT_Float32, file);
  dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  for (const auto& [name, value] : metadata) dataset->SetMetadataItem(name.c_str(), value.c_str());
  for (std::size_t n = 0; is_index && n < map.labels.size(); ++n) {
    dataset->SetMetadataItem(fmt::format("EMSCAPE_LABEL_{}", n).c_str(), map.labels[n].c_str());
  }
  GDALRasterBand* const band = dataset->GetRasterBand(1);
  band->SetDescription(map.description.c_str());
  band->SetUnitType(map.unit.c_str());
  CPLErr written = CE_None;
  if (is_index) {
    std::vector<std::uint8_t> bytes;
    int largest = 1;
    for (const float value : map.values) {
      const bool is_none = std::isnan(value) || value < 0;
      const int index = is_none ? kNoIndex : static_cast<int>(std::min(value, kLargestIndex));
      bytes.push_back(static_cast<std::uint8_t>(index));
      if (!is_none) largest = std::max(largest, index);
    }
    band->SetNoDataValue(kNoIndex);
    GDALColorTable colours = coloursOf(map.kind, std::max(largest + 1, static_cast<int>(map.labels.size())));
    band->SetColorTable(&colours);
    if (!map.labels.empty()) setLabels(*band, map.labels);
    written = band->RasterIO(GF_Write, 0, 0, grid.width, grid.height, bytes.data(), grid.width, grid.height,
                             GDT_Byte, 0, 0, nullptr);
  } else {
    band->SetNoDataValue(NAN);
    written = band->RasterIO(GF_Write, 0, 0, grid.width, grid.height, const_cast<float*>(map.values.data()),
                             grid.width, grid.height, GDT_Float32, 0, 0, nullptr);
  }
  if (written != CE_None) failWriting(messages, file);

  UnfinishedFile unfinished(file);
  // COG makes its overviews beside the output.
  const char* const options[] = {
      "COMPRESS=DEFLATE", is_index ? "PREDICTOR=NO" : "PREDICTOR=YES", "OVERVIEWS=AUTO",
      is_index ? "OVERVIEW_RESAMPLING=NEAREST" : "OVERVIEW_RESAMPLING=AVERAGE", nullptr};
  bool is_complete = false;
  {
    const Dataset copy(cog->CreateCopy(unfinished.temporary(), dataset.get(), TRUE,
                                       const_cast<char**>(options), nullptr, nullptr));
    is_complete = copy != nullptr;
  }
  if (!is_complete || messages.hasFailure()) failWriting(messages, file);
  unfinished.publish();
}

}  // namespace emscape::study
