#include "scenario/map/point_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files/file_reading.h"
#include "base/geodesy/position_limits.h"
#include "base/geodesy/position_text.h"
#include "base/text/decimal_signs.h"
#include "document/csv.h"
#include "document/text_file.h"
#include "document/text_lines.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/log.h"
#include "scenario/map/vector_file.h"

namespace emscape::scenario {
namespace {

using document::CsvCell;
using document::CsvRow;

constexpr std::size_t kMaxTableBytes = std::size_t{64} << 20;

bool isTableName(const std::string& name) {
  return lowerEnding(name) == ".csv" || lowerEnding(name) == ".tsv";
}

/// The text of a table; none for another file.
std::optional<std::string> tableText(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  const ElevationSource source = vectorSourceIn(file);
  if (!isTableName(source.ownName())) return std::nullopt;
  const std::string bytes =
      source.member.empty() ? readWholeText(file, kMaxTableBytes) : unpackedContent(source, kMaxTableBytes);
  return document::checkedUtf8(file, bytes, "a table of points");
}

/// The title of a column in lower case, without a unit or form: "Latitude (DMS)", "lat_deg".
std::string titleOf(std::string_view text) {
  std::string title = document::upperCase(text.substr(0, text.find_first_of("([")));
  for (const std::string_view form : {"_DEG", "_DMS", "_DM", "_DDM", "_DD", "_WGS84"}) {
    if (title.size() > form.size() && title.compare(title.size() - form.size(), form.size(), form) == 0)
      title.resize(title.size() - form.size());
  }
  return std::string(document::withoutBlanks(title));
}

/// True for columns such as "lat_min" and "Lon Sec".
bool isPartOfAngle(std::string_view text) {
  const std::string title = document::upperCase(text);
  const bool is_angle = title.rfind("LAT", 0) == 0 || title.rfind("LON", 0) == 0;
  return is_angle && (title.find("MIN") != std::string::npos || title.find("SEC") != std::string::npos);
}

/// Columns of a table; npos: it has none.
struct PointColumns {
  static constexpr std::size_t kNone = std::string::npos;
  std::size_t latitude = kNone, longitude = kNone, position = kNone, name = kNone;
  std::size_t north_or_south = kNone, east_or_west = kNone;  ///< letters of the directions
  struct Height {
    std::size_t column;
    HeightReference reference;
  };
  std::vector<Height> heights;  ///< the first is used, the others are compared with it
  bool has_geometry = false;

  explicit PointColumns(const std::vector<CsvCell>& header) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string title = titleOf(header[i].text);
      const auto take = [&](std::size_t& column, const std::initializer_list<const char*>& titles) {
        if (column == kNone && std::find(titles.begin(), titles.end(), title) != titles.end()) column = i;
      };
      take(latitude, {"LATITUDE", "LAT"});
      take(longitude, {"LONGITUDE", "LON", "LONG", "LNG"});
      take(position, {"MGRS", "USNG", "UTM", "POSITION", "COORDINATES", "COORDINATE", "LATLON"});
      take(name, {"NAME"});
      take(north_or_south, {"NS", "N/S", "N_S"});
      take(east_or_west, {"EW", "E/W", "E_W"});
      has_geometry = has_geometry || title.find("WKT") != std::string::npos;
      if (const auto told = heightReferenceOf(header[i].text)) heights.push_back({i, *told});
    }
    if (latitude != kNone && longitude != kNone) {
      position = kNone;
    } else {
      latitude = longitude = north_or_south = east_or_west = kNone;
    }
  }
  bool arePositions() const { return (latitude != kNone || position != kNone) && !has_geometry; }
  /// True for the height that is used, and one that contradicts it if it is not the same.
  bool isCompared(std::size_t column) const {
    return std::any_of(heights.begin(), heights.end(), [&](const Height& height) {
      const bool is_first = &height == &heights.front();
      return height.column == column && (is_first || (heights.front().reference != HeightReference::agl &&
                                                      height.reference != HeightReference::agl &&
                                                      height.reference != heights.front().reference));
    });
  }
  bool isUsed(std::size_t column) const {
    return column == latitude || column == longitude || column == position || column == name ||
           column == north_or_south || column == east_or_west || isCompared(column);
  }
};

/// Degrees without the last digits that minutes and turns leave.
double rounded(double degrees) {
  return std::round(degrees * 1e9) / 1e9;
}

/// @param text  perhaps in quotes that its seconds end
std::optional<double> degreesOfText(std::string_view text, bool is_latitude) {
  if (text.size() > 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  const std::optional<double> degrees = parseCoordinate(std::string(text), is_latitude);
  return degrees ? std::optional(rounded(*degrees)) : std::nullopt;
}

class PointReader {
 public:
  PointReader(const std::string& file, char separator, const PointColumns& columns)
      : file_(file), separator_(separator), columns_(columns) {}

  NamedPoint read(const CsvRow& row) {
    row_ = &row;
    NamedPoint point;
    if (columns_.position != PointColumns::kNone) {
      readPosition(row.cells[columns_.position], point);
    } else {
      point.latitude_deg = directed(degreesIn(row.cells[columns_.latitude], true), columns_.north_or_south);
      const double east_deg =
          directed(degreesIn(row.cells[columns_.longitude], false), columns_.east_or_west);
      point.longitude_deg = east_deg <= PositionLimits::kLongitude_deg ? wrapLongitude_deg(east_deg)
                                                                       : rounded(wrapLongitude_deg(east_deg));
    }
    if (columns_.name != PointColumns::kNone) point.name = std::string(row.cells[columns_.name].text);
    for (const PointColumns::Height& of_column : columns_.heights) readHeight(of_column, point);
    return point;
  }

  /// After all rows. @throws Error (bad_input)
  void requireOneDecimalSign() const {
    decimal_signs_.require();
    if (separator_ == ',') decimal_signs_.requireOneComma();
    decimal_signs_.requireClearComma();
  }

  [[noreturn]] void fail(int column, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, row_->line, column}, message);
  }

 private:
  double degreesIn(const CsvCell& cell, bool is_latitude) const {
    const char* const what = is_latitude ? "latitude" : "longitude";
    if (cell.text.find(',') != std::string_view::npos)
      decimal_signs_.seeCoordinate(cell.text);
    else
      decimal_signs_.see(cell.text, {file_, row_->line, cell.column});
    std::optional<double> value = document::numberOrCommaIn(cell.text);
    if (!value) value = degreesOfText(cell.text, is_latitude);
    if (!value) {
      fail(cell.column, fmt::format("the {0} is '{1}', not a number of degrees or such as {2}", what,
                                    cell.text, is_latitude ? "36°30'12\"N" : "84°12'00\"W"));
    }
    const double lowest_deg = is_latitude ? -PositionLimits::kLatitude_deg : -PositionLimits::kLongitude_deg;
    const double highest_deg = is_latitude ? PositionLimits::kLatitude_deg : 360;
    if (!(*value >= lowest_deg && *value <= highest_deg)) {
      fail(cell.column,
           fmt::format("the {} is {}; allowed are {:g} to {:g} deg", what, *value, lowest_deg, highest_deg));
    }
    return *value;
  }

  /// Negative where the letter of a column is S or W.
  double directed(double degrees, std::size_t column) const {
    if (column == PointColumns::kNone) return degrees;
    const CsvCell& cell = row_->cells[column];
    const std::string letter = document::upperCase(cell.text);
    if (letter == "S" || letter == "W") return -std::abs(degrees);
    if (letter == "N" || letter == "E") return degrees;
    fail(cell.column, fmt::format("'{}' is not a direction; allowed are N, S, E and W", cell.text));
  }

  void readPosition(const CsvCell& cell, NamedPoint& point) const {
    try {
      const ParsedPosition position = parsePosition(std::string(cell.text));
      if (position.height_m)
        fail(cell.column, fmt::format("the position '{}' has a height; the columns height_agl_m and "
                                      "height_msl_m state what heights are above",
                                      cell.text));
      point.latitude_deg = position.latitude_deg;
      point.longitude_deg = position.longitude_deg;
    } catch (const Error& error) {
      if (error.location().line > 0) throw;
      fail(cell.column, error.message());
    }
  }

  void readHeight(const PointColumns::Height& of_column, NamedPoint& point) const {
    const CsvCell& cell = row_->cells[of_column.column];
    if (cell.text.empty()) return;
    decimal_signs_.see(cell.text, {file_, row_->line, cell.column});
    const bool is_used = of_column.column == columns_.heights.front().column;
    const std::optional<double> value = document::numberOrCommaIn(cell.text);
    if (!value && is_used)
      fail(cell.column, fmt::format("{} is '{}', not a number of metres",
                                    kHeightKeys[static_cast<int>(of_column.reference)], cell.text));
    if (!value) return;
    const PointHeight height{of_column.reference, *value};
    if (is_used) {
      point.height = height;
    } else if (point.height) {
      const std::string contradiction =
          contradictionOfHeights(point.latitude_deg, point.longitude_deg, *point.height, height);
      if (!contradiction.empty()) fail(cell.column, contradiction);
    }
  }

  const std::string& file_;
  const char separator_;
  const PointColumns& columns_;
  const CsvRow* row_ = nullptr;
  mutable DecimalSigns decimal_signs_;
};

}  // namespace

std::optional<HeightReference> heightReferenceOf(std::string_view name) {
  constexpr std::size_t kShapefileName = 10;
  const std::string title = document::upperCase(name);
  for (const HeightReference reference :
       {HeightReference::agl, HeightReference::msl, HeightReference::ellipsoid}) {
    const std::string key = document::upperCase(kHeightKeys[static_cast<int>(reference)]);
    if (title == key || title == key.substr(0, key.size() - 2) || title == key.substr(0, kShapefileName))
      return reference;
  }
  return std::nullopt;
}

std::string contradictionOfHeights(double latitude_deg, double longitude_deg, const PointHeight& a,
                                   const PointHeight& b) {
  constexpr double kTolerance_m = 20;  // of datums of mean sea level
  if (a.reference == HeightReference::ellipsoid && b.reference == HeightReference::msl)
    return contradictionOfHeights(latitude_deg, longitude_deg, b, a);
  if (a.reference != HeightReference::msl || b.reference != HeightReference::ellipsoid) return "";
  const double geoid_m = geoidUndulation_m(latitude_deg, longitude_deg);
  if (std::abs(b.height_m - a.height_m - geoid_m) <= kTolerance_m) return "";
  return fmt::format(
      "{} is {:g} and {} {:g}; mean sea level is {:.0f} m above the ellipsoid there: rename the column that "
      "is "
      "another height, or remove it",
      a.key(), a.height_m, b.key(), b.height_m, geoid_m);
}

std::optional<std::vector<NamedPoint>> readPointTable(const std::string& file,
                                                      std::vector<std::string>* others) {
  const std::optional<std::string> text = tableText(file);
  if (!text) return std::nullopt;
  const char separator = document::separatorOf(*text);
  document::CsvReader reader(*text, separator);
  CsvRow row;
  if (!reader.next(row)) return std::nullopt;
  // Spreadsheets write the separator above the header.
  if (document::upperCase(row.cells[0].text.substr(0, 4)) == "SEP=" && !reader.next(row)) return std::nullopt;
  const PointColumns columns(row.cells);
  if (!columns.arePositions()) return std::nullopt;
  const std::size_t count = row.cells.size();
  std::vector<std::string> unused;
  for (std::size_t i = 0; i < count; ++i) {
    if (columns.isUsed(i)) continue;
    if (isPartOfAngle(row.cells[i].text)) {
      throw Error(
          ErrorCode::bad_input, {file, row.line, row.cells[i].column},
          fmt::format("'{}' is a part of a position; write degrees, minutes and seconds in one column, "
                      "such as 43 45.5 N",
                      row.cells[i].text));
    }
    unused.emplace_back(row.cells[i].text);
  }
  PointReader points_in(file, separator, columns);
  std::vector<NamedPoint> points;
  while (reader.next(row)) {
    if (row.cells.size() != count) {
      throw Error(ErrorCode::bad_input, {file, row.line, row.cells.front().column},
                  fmt::format("{} values, but the header names {} columns", row.cells.size(), count));
    }
    points.push_back(points_in.read(row));
  }
  points_in.requireOneDecimalSign();
  if (const std::string unended = reader.unendedWarning(file, "a row"); !unended.empty()) logWarning(unended);
  if (others != nullptr) {
    *others = unused;
  } else if (!unused.empty()) {
    logInfo(fmt::format("{}: {} other column{} ignored: {}", file, unused.size(),
                        unused.size() == 1 ? " is" : "s are", fmt::join(unused, ", ")));
  }
  return points;
}

}  // namespace emscape::scenario
