#include "emscape/study/geotiff.h"

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "base/whole_file.h"
#include "emscape/base/error.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::study {
namespace {

constexpr int kNoIndex = 255;
constexpr int kMostIndices = 255;

[[noreturn]] void fail(const scenario::GdalMessages& messages, const std::filesystem::path& file) {
  throw Error(ErrorCode::other, file.string() + ": " + messages.explain("cannot be written"));
}

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

GDALDriver* driverOf(const char* name) {
  static std::once_flag once;
  std::call_once(once, [] { GDALAllRegister(); });
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) throw Error(ErrorCode::other, fmt::format("GDAL has no driver '{}'", name));
  return driver;
}

/// Colours of counts and indices: none for 0, then hues that differ.
GDALColorTable coloursOf(Product product, int count) {
  // Okabe and Ito's colours for colour-blind readers.
  static constexpr GDALColorEntry kColours[] = {{230, 159, 0, 255},  {86, 180, 233, 255}, {0, 158, 115, 255},
                                                {240, 228, 66, 255}, {0, 114, 178, 255},  {213, 94, 0, 255},
                                                {204, 121, 167, 255}};
  GDALColorTable table;
  const GDALColorEntry none{0, 0, 0, 0};
  for (int i = 0; i < count; ++i) {
    const bool is_none = product != Product::best && i == 0;
    const int hue = product == Product::best ? i : i - 1;
    table.SetColorEntry(i, is_none ? &none : &kColours[hue % 7]);
  }
  table.SetColorEntry(kNoIndex, &none);
  return table;
}

}  // namespace

void writeGeoTiff(const std::filesystem::path& file, const MapGrid& grid, const CoverageMap& map,
                  const std::vector<std::string>& labels,
                  const std::vector<std::pair<std::string, std::string>>& metadata) {
  const bool is_index = info(map.product).categorical;
  GDALDriver* const memory = driverOf("MEM");
  GDALDriver* const cog = driverOf("COG");
  const scenario::GdalMessages messages;
  const Dataset dataset(
      memory->Create("", grid.width, grid.height, 1, is_index ? GDT_Byte : GDT_Float32, nullptr));
  if (dataset == nullptr) fail(messages, file);
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  dataset->SetGeoTransform(transform);
  dataset->SetProjection(grid.wkt.c_str());
  dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  for (const auto& [name, value] : metadata) dataset->SetMetadataItem(name.c_str(), value.c_str());
  std::vector<std::string> names = labels;
  if (names.empty()) names.assign(info(map.product).classes.begin(), info(map.product).classes.end());
  for (std::size_t n = 0; is_index && n < names.size(); ++n) {
    dataset->SetMetadataItem(fmt::format("EMSCAPE_LABEL_{}", n).c_str(), names[n].c_str());
  }
  GDALRasterBand* const band = dataset->GetRasterBand(1);
  band->SetDescription(map.description.c_str());
  band->SetUnitType(map.unit.c_str());
  CPLErr written = CE_None;
  if (is_index) {
    std::vector<std::uint8_t> bytes;
    int largest = 1;
    for (const float value : map.values) {
      const bool is_none = std::isnan(value) || value < 0 || value >= kMostIndices;
      bytes.push_back(static_cast<std::uint8_t>(is_none ? static_cast<float>(kNoIndex) : value));
      if (!is_none) largest = std::max(largest, static_cast<int>(value));
    }
    band->SetNoDataValue(kNoIndex);
    GDALColorTable colours = coloursOf(map.product, largest + 1);
    band->SetColorTable(&colours);
    written = band->RasterIO(GF_Write, 0, 0, grid.width, grid.height, bytes.data(), grid.width, grid.height,
                             GDT_Byte, 0, 0, nullptr);
  } else {
    band->SetNoDataValue(NAN);
    written = band->RasterIO(GF_Write, 0, 0, grid.width, grid.height, const_cast<float*>(map.values.data()),
                             grid.width, grid.height, GDT_Float32, 0, 0, nullptr);
  }
  if (written != CE_None) fail(messages, file);

  const std::filesystem::path temporary = temporaryFor(file);
  // COG makes its overviews beside the output.
  const char* const options[] = {
      "COMPRESS=DEFLATE", is_index ? "PREDICTOR=NO" : "PREDICTOR=YES", "OVERVIEWS=AUTO",
      is_index ? "OVERVIEW_RESAMPLING=NEAREST" : "OVERVIEW_RESAMPLING=AVERAGE", nullptr};
  bool is_complete = false;
  {
    const Dataset copy(cog->CreateCopy(temporary.c_str(), dataset.get(), TRUE, const_cast<char**>(options),
                                       nullptr, nullptr));
    is_complete = copy != nullptr;
  }
  if (!is_complete || messages.hasFailure()) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    fail(messages, file);
  }
  publish(temporary, file);
}

}  // namespace emscape::study
