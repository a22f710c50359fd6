#include "scenario/terrain/file_remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <vector>

#include "base/text/shell_word.h"
#include "document/text_lines.h"
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

std::string beginningOf(const std::string& file) {
  constexpr std::size_t kBytes = 4096;
  std::ifstream stream(file, std::ios::binary);
  std::string beginning(kBytes, '\0');
  stream.read(beginning.data(), kBytes);
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return beginning;
}

/// True if lines begin with a number, a blank or separator, and a further one.
bool isTableOfNumbers(std::string_view text) {
  int rows = 0;
  for (std::size_t begin = 0; begin < text.size() && rows < 10;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line(text.substr(begin, end - begin));
    begin = end + 1;
    const char* at = line.c_str();
    int numbers = 0;
    for (char* after = nullptr; numbers < 3; ++numbers, at = after + std::strspn(after, " \t,;")) {
      std::strtod(at, &after);
      if (after == at) break;
    }
    rows += numbers == 3 ? 1 : 0;
  }
  return rows >= 2;
}

/// What makes a grid that GDAL reads of a table of points: longitude, latitude and height in rows.
std::string remedyForTable(const std::string& file) {
  return fmt::format(
      "as XYZ, whose lines are longitude (or easting), latitude (or northing) and height, without comments, "
      "row by row, at posts of a grid. awk -F '[,; \\t]+' '/^[-+0-9.]/{{print $1,$2,$3}}' {0} | LC_ALL=C "
      "sort "
      "-k2,2g -k1,1g > HEIGHTS.xyz sorts its rows; where the latitude comes first, print $2,$1,$3",
      shellWord(file));
}

}  // namespace

std::string foreignContent(std::string_view beginning) {
  const std::size_t first = beginning.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string_view::npos) return "";
  const std::string_view text = beginning.substr(first);
  const std::string head = document::upperCase(text.substr(0, 15));
  if (head.rfind("<!DOCTYPE HTML", 0) == 0 || head.rfind("<HTML", 0) == 0)
    return "is a web page, such as that of a login; get the file again";
  if (text.rfind("version https://git-lfs", 0) == 0)
    return "is a pointer of Git LFS; 'git lfs pull' gets the file";
  return text.rfind("%PDF-", 0) == 0 ? "is a PDF document" : "";
}

std::string foreignContentOf(const std::string& file) {
  return foreignContent(beginningOf(file));
}

std::string faultOfUnreadable(const ElevationSource& source, bool is_picture) {
  const std::string ending = lowerEnding(source.ownName());
  if (source.member.empty()) {
    if (const std::string foreign = foreignContentOf(source.file); !foreign.empty()) return foreign;
    if (isTableOfNumbers(beginningOf(source.file)))
      return "is a table of numbers that cannot be read " + remedyForTable(source.file);
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

std::string remedyForNoGeoreference(const ElevationSource& source, bool is_tile) {
  if (is_tile)
    return "has no position: a tile of a web map is placed by its path, ZOOM/COLUMN/ROW.png, or its name, "
           "ZOOM-COLUMN-ROW.png, with rows counted from the north. Rename it so; gdal_edit.py or a world "
           "file "
           "places other pictures";
  return fmt::format(
      "has no georeference: where its posts are on the earth is not known. gdal_translate -a_srs EPSG:4326 "
      "-a_ullr WEST NORTH EAST SOUTH {} HEIGHTS.tif makes a copy that states it",
      shellWord(source.member.empty() ? source.file : source.member));
}

std::string remedyForNoSystem(const ElevationSource& source, bool has_classes, bool is_plane) {
  if (has_classes)
    return fmt::format(
        "has no coordinate reference system{}. gdal_translate -a_srs {} {} COVER.tif makes a copy that "
        "states {}",
        is_plane ? ", and its coordinates are no degrees" : "", is_plane ? "EPSG:32633" : "EPSG:4326",
        shellWord(source.ownName()),
        is_plane ? "one, such as UTM zone 33 north" : "latitudes and longitudes");
  return is_plane ? "has no coordinate reference system, and its coordinates are no degrees. `crs` of the "
                    "file in the "
                    "scenario states it, such as EPSG:32633 for UTM zone 33 north: files: [{file: NAME, crs: "
                    "\"EPSG:32633\"}]"
                  : "has no coordinate reference system. `crs: EPSG:4326` of the file in the scenario states "
                    "latitudes "
                    "and longitudes: files: [{file: NAME, crs: \"EPSG:4326\"}]";
}

std::string remedyForTileWithoutPosition() {
  return "has no position, or two: an HGT tile is placed by its name. Rename it to that of its south-western "
         "corner, "
         "such as "
         "N38E052.hgt";
}

std::string faultOfGridLines(std::istream& text, long long columns, long long rows) {
  std::string line;
  constexpr int kMaxHeaderLines = 20;
  for (int n = 0; n < kMaxHeaderLines && std::isalpha((text >> std::ws).peek()) != 0; ++n) {
    if (std::getline(text, line); document::upperCase(line).rfind("NAN", 0) == 0) return "";
  }
  long long values = 0;
  bool is_value = false;
  std::streambuf* const bytes = text.rdbuf();
  const auto countTo = [&](bool whole) {
    while (bytes->sgetc() != EOF && (whole || bytes->sgetc() != '\n')) {
      const bool is_blank = std::isspace(bytes->sbumpc()) != 0;
      if (!is_blank && !is_value) ++values;
      is_value = !is_blank;
    }
    return values;
  };
  const long long of_line = countTo(false);
  // A line may be any part of the rows; that there are too few values GDAL tells.
  if (of_line == columns || countTo(true) <= columns * rows) return "";
  return fmt::format(
      "has {} values, {} in its first line, but 'ncols' {} and 'nrows' {} make {}: heights would be at wrong "
      "positions. Correct 'ncols' and 'nrows', or get the file again",
      values, of_line, columns, rows, columns * rows);
}

std::string heightUnitBeside(const std::string& file) {
  for (const char* const ending : {".prj", ".PRJ"}) {
    std::ifstream stream(fs::path(file).replace_extension(ending));
    for (std::string word; stream >> word;) {
      if (document::upperCase(word) != "ZUNITS" || !(stream >> word)) continue;
      const std::string unit = document::upperCase(word);
      return unit == "FEET" ? "ft" : unit == "METERS" ? "m" : "";
    }
  }
  return "";
}

bool webTileTransform(const std::string& file, int columns, int rows, double (&transform)[6]) {
  const fs::path path = fs::absolute(file).lexically_normal();
  std::string stem = path.stem().string();
  if (const std::size_t scale = stem.rfind('@'); scale != std::string::npos) stem.resize(scale);  // 613@2x
  long long zoom = wholeNumber(path.parent_path().parent_path().filename().string());
  long long column = wholeNumber(path.parent_path().filename().string());
  long long row = wholeNumber(stem);
  const std::size_t first = stem.find_first_of("-_"), second = stem.find_first_of("-_", first + 1);
  if (second < stem.size()) {
    zoom = wholeNumber(stem.substr(0, first));
    column = wholeNumber(stem.substr(first + 1, second - first - 1));
    row = wholeNumber(stem.substr(second + 1));
  }
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
