/// The head of an elevation file: format, size, band and units.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/text/shell_word.h"
#include "scenario/terrain/file_impl.h"
#include "scenario/terrain/file_remedies.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxPostsPerAxis = 1 << 22;                ///< the whole earth in a third of an arc second
constexpr int kMinTilePosts = 2, kMaxTilePosts = 21601;  ///< of an HGT, per axis

/// Reports vertical systems of GeoTIFF 1.0, which GDAL otherwise leaves out.
class VerticalSystems {
 public:
  VerticalSystems() { CPLSetThreadLocalConfigOption(kKey, "YES"); }
  ~VerticalSystems() { CPLSetThreadLocalConfigOption(kKey, nullptr); }

 private:
  static constexpr const char* kKey = "GTIFF_REPORT_COMPD_CS";
};

/// True if GDAL reads an HGT of this name and size.
bool isStandardTile(const std::string& name, int posts) {
  const auto is = [&](std::size_t at, const char* letters) {
    return at < name.size() && std::strchr(letters, name[at]) != nullptr;
  };
  const auto digits = [&](std::size_t at, std::size_t count) {
    for (std::size_t k = at; k < at + count; ++k) {
      if (k >= name.size() || std::isdigit(static_cast<unsigned char>(name[k])) == 0) return false;
    }
    return true;
  };
  const bool is_named = is(0, "NSns") && digits(1, 2) && is(3, "EWew") && digits(4, 3) && is(7, ".");
  return (posts == 1201 || posts == 3601) && is_named && cornerInName(name).has_value();
}

}  // namespace

int tilePosts(std::uintmax_t bytes) {
  const auto posts = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes / 2))));
  const bool is_square =
      bytes == std::uintmax_t{2} * static_cast<unsigned>(posts) * static_cast<unsigned>(posts);
  return is_square && posts >= kMinTilePosts && posts <= kMaxTilePosts ? posts : 0;
}

void TerrainFile::Impl::readHead() {
  const GdalMessages quiet;  // constructed before the dataset, whose destructor may report errors
  const VerticalSystems vertical_systems;
  gdal::prepare();
  if (lowerEnding(source.ownName()) == ".hgt" && gdal::faultOfName(source.file).empty()) {
    std::error_code ignored;
    // The size of a packed tile is not known; by the name alone, GDAL's driver is tried where it may be
    // right.
    const int posts = source.member.empty() ? tilePosts(fs::file_size(source.file, ignored)) : 0;
    is_tile = !isStandardTile(fs::path(source.ownName()).filename().string(), posts);
  }
  const std::set<fs::path> sources = checkedSources();
  const gdal::Dataset dataset = open();
  const int bands = GDALGetRasterCount(dataset.get());
  if (bands == 0) fail(remedyForContainer(dataset.get(), source));
  GDALDriverH driver = GDALGetDatasetDriver(dataset.get());
  const char* long_name = GDALGetMetadataItem(driver, GDAL_DMD_LONGNAME, nullptr);
  format = is_tile ? "SRTMHGT File Format" : long_name ? long_name : GDALGetDriverShortName(driver);
  columns = GDALGetRasterXSize(dataset.get());
  rows = GDALGetRasterYSize(dataset.get());
  if (columns > kMaxPostsPerAxis || rows > kMaxPostsPerAxis) {
    fail("has " + std::to_string(columns) + " x " + std::to_string(rows) + " posts, more than the allowed " +
         std::to_string(kMaxPostsPerAxis) + " in a row or column");
  }
  if (keys.band > bands)
    fail(fmt::format("'band: {}' of the scenario is outside the allowed range 1 to {}, the file's bands",
                     keys.band, bands));
  band = std::max(keys.band, 1);
  if (bands > 1 && keys.band == 0 && !keys.encoding) {
    std::string names;
    for (int n = 1; n <= bands; ++n) {
      const std::string name_of_band = GDALGetDescription(GDALGetRasterBand(dataset.get(), n));
      if (!name_of_band.empty())
        names += fmt::format("{}{} '{}'", names.empty() ? "" : ", ", n, name_of_band);
    }
    const std::string text = fmt::format("has {} bands{}: heights are taken from the first", bands,
                                         names.empty() ? "" : " (" + names + ")");
    if (names.empty())
      notes.push_back(text);
    else
      band_warning = text + "; `band` of the file in the scenario chooses another";
  }
  checkDatasets(dataset.get(), sources);
  if (EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get())), "AAIGrid")) {
    std::ifstream in_folder(source.file, std::ios::binary);
    std::istringstream in_archive(source.member.empty() ? "" : unpackedContent(source));
    const std::string fault = faultOfGridLines(
        source.member.empty() ? static_cast<std::istream&>(in_folder) : in_archive, columns, rows);
    if (!fault.empty()) fail(fault);
  }
  readBand(dataset.get());
  placePosts(dataset.get());
}

void TerrainFile::Impl::readBand(GDALDatasetH dataset) {
  GDALRasterBandH of_heights = GDALGetRasterBand(dataset, band);
  if (GDALDataTypeIsComplex(GDALGetRasterDataType(of_heights))) fail("holds complex numbers, not heights");
  const GDALColorInterp colour = GDALGetRasterColorInterpretation(of_heights);
  if (keys.has_classes) {
    requireClasses(of_heights);
    return;
  }
  if (keys.encoding) {
    if (GDALGetRasterCount(dataset) < band + 2 || GDALGetRasterDataType(of_heights) != GDT_Byte)
      fail(fmt::format(
          "'encoding: {}' of the scenario needs red, green and blue as bands of bytes; the file has {} "
          "band{} of {}",
          toString(*keys.encoding), GDALGetRasterCount(dataset), GDALGetRasterCount(dataset) == 1 ? "" : "s",
          GDALGetDataTypeName(GDALGetRasterDataType(of_heights))));
    notes.push_back(fmt::format("heights are decoded from colours ({})", toString(*keys.encoding)));
  } else if (colour != GCI_Undefined && colour != GCI_GrayIndex) {
    fail(remedyForPicture(band, GDALGetColorInterpretationName(colour), GDALGetRasterCount(dataset)));
  }
  if (!keys.encoding && GDALGetRasterDataType(of_heights) == GDT_Byte && !keys.height_unit)
    fail(
        "has 8 bits for a post, as pictures, masks and classes have, but no heights. If it has heights, "
        "`height_unit: m` of the file in the scenario states it");
  is_16_bits =
      GDALGetRasterDataType(of_heights) == GDT_Int16 || GDALGetRasterDataType(of_heights) == GDT_UInt16;
  is_real = GDALGetRasterDataType(of_heights) == GDT_Float32;
  if (keys.swap_bytes && !is_16_bits && !is_real)
    fail(fmt::format(
        "'swap_bytes' of the scenario needs heights of 16 bits or real numbers of 32; the file has {}",
        GDALGetDataTypeName(GDALGetRasterDataType(of_heights))));
  scale = GDALGetRasterScale(of_heights, nullptr);
  if (scale > 0) readMeaningOfNetcdf(of_heights);
  offset = GDALGetRasterOffset(of_heights, nullptr);
  if (scale != 1.0 || offset != 0.0) {
    notes.push_back("heights are stored with scale " + std::to_string(scale) + " and offset " +
                    std::to_string(offset));
  }
}

/// What the CF conventions state of a variable, also in copies of it; a scale below 0 makes heights of
/// depths.
void TerrainFile::Impl::readMeaningOfNetcdf(GDALRasterBandH of_heights) {
  const auto attribute = [&](const char* key) {
    const char* const text = GDALGetMetadataItem(of_heights, key, nullptr);
    return std::string(text == nullptr ? "" : text);
  };
  const std::string standard_name = attribute("standard_name"), long_name = attribute("long_name");
  const bool is_depth = standard_name.find("depth") != std::string::npos;
  if (is_depth || EQUAL(attribute("positive").c_str(), "down")) {
    fail(fmt::format(
        "states depths, downwards ({}); gdal_translate -ot Float32 -a_scale -1 -a_offset 0 {} HEIGHTS.tif "
        "makes "
        "a copy of heights",
        is_depth ? "standard_name: " + standard_name : "positive: down", shellWord(source.ownName())));
  }
  is_ellipsoidal = standard_name == "height_above_reference_ellipsoid";
  if (long_name.find("depth") != std::string::npos || long_name.find("Depth") != std::string::npos)
    depth_name = long_name;
}

void TerrainFile::Impl::requireClasses(GDALRasterBandH band_of_codes) const {
  const GDALColorInterp colour = GDALGetRasterColorInterpretation(band_of_codes);
  if (colour != GCI_Undefined && colour != GCI_GrayIndex && colour != GCI_PaletteIndex)
    fail(fmt::format(
        "is a picture, not codes of land cover: its band {} is '{}'; get the raster of class codes", band,
        GDALGetColorInterpretationName(colour)));
  const GDALDataType type = GDALGetRasterDataType(band_of_codes);
  if (type == GDT_Float32 || type == GDT_Float64)
    fail(
        "holds real numbers, not codes of land cover; if they are whole, gdal_translate -ot UInt16 makes a "
        "raster of codes");
}

}  // namespace emscape::scenario
