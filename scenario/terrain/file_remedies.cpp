#include "scenario/terrain/file_remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/geodesy/gdal_file.h"
#include "base/text/shell_word.h"
#include "emscape/base/units.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/raster_access.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

/// The whole of a text as a number >= 0; -1 if it is none.
long long wholeNumber(const std::string& text) {
  long long number = -1;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  return fault == std::errc() && end == text.data() + text.size() ? number : -1;
}

}  // namespace

std::string faultOfUnreadable(const ElevationSource& source, bool is_picture) {
  const std::string ending = lowerEnding(source.ownName());
  if (source.member.empty()) {
    if (!is_picture && ending == ".png")
      return "is a PNG picture, not heights; `encoding: terrain-rgb` (or terrarium) of the file in the "
             "scenario decodes "
             "tiles whose colours encode heights";
    const GdalMessages quiet;
    if (const std::string other = otherFormatOf(source.file); !other.empty())
      return fmt::format(
          "its format, {}, is not read; read are {}. gdal_translate {} HEIGHTS.tif makes a GeoTIFF of it",
          other, elevationFormats(), shellWord(source.file));
  }
  return "not a raster in one of the formats that are read: " + elevationFormats();
}

std::string remedyForContainer(GDALDatasetH dataset, const ElevationSource& source) {
  std::string first;
  std::vector<std::string> names;
  const char* const* list = GDALGetMetadata(dataset, "SUBDATASETS");
  for (; list != nullptr && *list != nullptr; ++list) {
    const std::string item = *list;
    const std::size_t name = item.find("_NAME=");
    if (name == std::string::npos) continue;
    if (first.empty()) first = item.substr(name + 6);
    names.push_back(item.substr(item.rfind(':') + 1));
  }
  if (names.empty()) return "has no raster";
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  std::string remedy = first;
  if (!source.member.empty())
    remedy = first.substr(0, first.find(':')) + ":" + source.member + ":" + names.front();
  return fmt::format(
      "has no raster itself, but {} in it: {}. gdal_translate {} HEIGHTS.tif makes a file of {}",
      names.size(), all, shellWord(remedy), names.front());
}

std::string remedyForPicture(int band, const std::string& colour, int bands) {
  const std::string decode =
      bands >= 3
          ? "`encoding: terrain-rgb` (or terrarium) of the file in the scenario decodes tiles whose colours "
            "encode heights; `band:` chooses another band"
          : "a palette or a single colour has no heights; get the elevation model itself, not a picture of "
            "it";
  return fmt::format("is a picture, not heights: its band {} is '{}'. {}", band, colour, decode);
}

std::string remedyForNoGeoreference(const ElevationSource& source) {
  return fmt::format(
      "has no georeference: where its posts are on the earth is not known. gdal_translate -a_srs EPSG:4326 "
      "-a_ullr WEST NORTH EAST SOUTH {} HEIGHTS.tif makes a copy that states it",
      shellWord(source.member.empty() ? source.file : source.member));
}

std::string remedyForNoSystem(bool is_plane) {
  return is_plane ? "has no coordinate reference system, and its coordinates are no degrees. `crs` of the "
                    "file in the "
                    "scenario states it, such as EPSG:32633 for UTM zone 33 north: files: [{file: NAME, crs: "
                    "\"EPSG:32633\"}]"
                  : "has no coordinate reference system. `crs: EPSG:4326` of the file in the scenario states "
                    "latitudes "
                    "and longitudes: files: [{file: NAME, crs: \"EPSG:4326\"}]";
}

std::string remedyForTileWithoutPosition() {
  return "has no position: an HGT tile is placed by its name. Rename it to that of its south-western corner, "
         "such as "
         "N38E052.hgt";
}

bool webTileTransform(const std::string& file, int columns, int rows, double (&transform)[6]) {
  const fs::path path = fs::absolute(file).lexically_normal();
  const long long zoom = wholeNumber(path.parent_path().parent_path().filename().string());
  const long long column = wholeNumber(path.parent_path().filename().string());
  const long long row = wholeNumber(path.stem().string());
  if (zoom < 0 || zoom > 24 || column < 0 || row < 0 || column >= 1LL << zoom || row >= 1LL << zoom)
    return false;
  constexpr double kHalf_m = kPi * 6378137.0;  // of the equator
  const double tile_m = 2 * kHalf_m / static_cast<double>(1LL << zoom);
  transform[0] = -kHalf_m + static_cast<double>(column) * tile_m;
  transform[1] = tile_m / columns;
  transform[3] = kHalf_m - static_cast<double>(row) * tile_m;
  transform[5] = -tile_m / rows;
  transform[2] = transform[4] = 0;
  return true;
}

std::optional<int> epsgCodeIn(const std::string& text) {
  if (text.rfind("EPSG:", 0) != 0) return std::nullopt;
  const long long code = wholeNumber(text.substr(5));
  return code > 0 && code < 1000000 ? std::optional<int>(static_cast<int>(code)) : std::nullopt;
}

}  // namespace emscape::scenario
