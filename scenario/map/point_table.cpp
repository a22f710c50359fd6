#include "scenario/map/point_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files/file_reading.h"
#include "document/csv.h"
#include "document/text_file.h"
#include "document/text_lines.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape::scenario {
namespace {

using document::CsvCell;

constexpr std::size_t kMaxTableBytes = std::size_t{64} << 20;

bool isTableName(const std::string& file) {
  const std::string ending = document::upperCase(std::filesystem::path(file).extension().string());
  std::error_code ignored;
  return (ending == ".CSV" || ending == ".TSV") && std::filesystem::is_regular_file(file, ignored);
}

/// Columns of a table; npos: it has none.
struct PointColumns {
  std::size_t latitude = std::string::npos, longitude = std::string::npos, name = std::string::npos;
  bool has_geometry = false;
  std::vector<std::string> others;

  explicit PointColumns(const std::vector<CsvCell>& header) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string title = document::upperCase(header[i].text);
      const auto isOneOf = [&](const std::initializer_list<const char*>& titles) {
        return std::any_of(titles.begin(), titles.end(), [&](const char* each) { return title == each; });
      };
      if (latitude == std::string::npos && isOneOf({"LATITUDE_DEG", "LATITUDE", "LAT"})) {
        latitude = i;
      } else if (longitude == std::string::npos &&
                 isOneOf({"LONGITUDE_DEG", "LONGITUDE", "LON", "LONG", "LNG"})) {
        longitude = i;
      } else if (name == std::string::npos && title == "NAME") {
        name = i;
      } else {
        others.push_back(std::string(header[i].text));
      }
      has_geometry = has_geometry || title.find("WKT") != std::string::npos;
    }
  }
  bool arePositions() const {
    return latitude != std::string::npos && longitude != std::string::npos && !has_geometry;
  }
};

}  // namespace

std::optional<std::vector<NamedPoint>> readPointTable(const std::string& file,
                                                      std::vector<std::string>* others) {
  if (!isTableName(file)) return std::nullopt;
  const std::string text =
      document::checkedUtf8(file, readWholeText(file, kMaxTableBytes), "a table of points");
  document::CsvReader reader(text, document::separatorOf(text));
  document::CsvRow row;
  if (!reader.next(row)) return std::nullopt;
  const PointColumns columns(row.cells);
  if (!columns.arePositions()) return std::nullopt;
  const std::size_t count = row.cells.size();
  const auto fail = [&](int column, const std::string& message) {
    throw Error(ErrorCode::bad_input, {file, row.line, column}, message);
  };
  const auto degreesIn = [&](const CsvCell& cell, const char* what, double limit) {
    const std::optional<double> value = document::numberOrCommaIn(cell.text);
    if (!value) fail(cell.column, fmt::format("the {} is '{}', not a number of degrees", what, cell.text));
    if (!(std::abs(*value) <= limit))
      fail(cell.column,
           fmt::format("the {} is {}; allowed are -{:g} to {:g} deg", what, *value, limit, limit));
    return *value;
  };
  std::vector<NamedPoint> points;
  while (reader.next(row)) {
    if (row.cells.size() != count) {
      fail(row.cells.front().column,
           fmt::format("{} values, but the header names {} columns", row.cells.size(), count));
    }
    NamedPoint point;
    point.latitude_deg = degreesIn(row.cells[columns.latitude], "latitude", 90);
    point.longitude_deg = degreesIn(row.cells[columns.longitude], "longitude", 180);
    if (columns.name != std::string::npos) point.name = std::string(row.cells[columns.name].text);
    points.push_back(std::move(point));
  }
  if (others != nullptr) {
    *others = columns.others;
  } else if (!columns.others.empty()) {
    logInfo(fmt::format("{}: {} other column{} ignored: {}", file, columns.others.size(),
                        columns.others.size() == 1 ? " is" : "s are", fmt::join(columns.others, ", ")));
  }
  return points;
}

}  // namespace emscape::scenario
