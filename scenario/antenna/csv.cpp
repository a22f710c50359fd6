#include "document/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <utility>

#include "document/text_lines.h"
#include "emscape/base/log.h"
#include "emscape/base/units.h"
#include "scenario/antenna/csv_grid.h"
#include "scenario/antenna/pattern_file.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"

namespace emscape::scenario {
namespace {

using document::CsvCell;
using document::CsvReader;
using document::CsvRow;
using document::numberIn;
using document::TextLines;
using document::upperCase;

constexpr ColumnSpec kAzimuthColumn{"azimuth_deg", -360, 360, "deg"};
constexpr ColumnSpec kElevationColumn{"elevation_deg", -90, 90, "deg"};
constexpr ColumnSpec kAttenuation{"attenuation_db", 0, kMaxAttenuation_db, "dB"};

struct GridRow {
  std::array<double, 3> values{};  ///< in the order of the requested columns, two or three
  int line = 0;
};

/// The rows of a table with exactly the requested columns, in any order.
std::vector<GridRow> readRows(const TextLines& text, const std::vector<ColumnSpec>& columns) {
  int line = 1;
  const auto fail = [&](const CsvCell& cell, const std::string& message) {
    throw Error(ErrorCode::bad_input, {text.file(), line, cell.column}, message);
  };
  std::string wanted;
  for (const ColumnSpec& column : columns) wanted += (wanted.empty() ? "" : ",") + std::string(column.name);
  CsvReader reader(text.text());
  CsvRow header_row;
  if (!reader.next(header_row)) {
    throw Error(ErrorCode::bad_input, {text.file(), 1, 1},
                fmt::format("no header line; it should be {}", wanted));
  }
  const std::vector<CsvCell>& header = header_row.cells;
  line = header_row.line;
  if (const auto fault = document::headerFault(header))
    throw Error(ErrorCode::bad_input, {text.file(), line, fault->column}, fault->message);
  std::vector<std::size_t> position(columns.size(), header.size());  // of each column in a line
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto column = std::find_if(columns.begin(), columns.end(),
                                     [&](const ColumnSpec& spec) { return header[i].text == spec.name; });
    if (column == columns.end()) {
      fail(header[i], fmt::format("unknown column '{}'; the header should be {}", header[i].text, wanted));
    }
    std::size_t& index = position[static_cast<std::size_t>(column - columns.begin())];
    if (index < header.size()) fail(header[i], fmt::format("column '{}' occurs twice", header[i].text));
    index = i;
  }
  if (header.size() < columns.size())
    fail(header.front(), fmt::format("missing column; the header should be {}", wanted));

  std::vector<GridRow> rows;
  for (CsvRow cells_of; reader.next(cells_of);) {
    line = cells_of.line;
    const std::vector<CsvCell>& cells = cells_of.cells;
    if (cells.size() != columns.size()) {
      fail(cells.front(),
           fmt::format("{} values, but the header names {} columns", cells.size(), columns.size()));
    }
    GridRow row;
    row.line = cells_of.line;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const CsvCell& cell = cells[position[i]];
      const ColumnSpec& column = columns[i];
      const std::optional<double> value = numberIn(cell.text);
      if (!value) fail(cell, fmt::format("{} is '{}', not a number", column.name, cell.text));
      if (*value < column.lowest || *value > column.highest) {
        fail(cell, fmt::format("{} is {} {}; allowed are {} to {} {}", column.name, *value, column.unit,
                               column.lowest, column.highest, column.unit));
      }
      row.values[i] = *value;
    }
    rows.push_back(row);
  }
  if (const std::string unended = reader.unendedWarning(text.file(), "a row"); !unended.empty())
    logWarning(unended);
  return rows;
}

MeasuredCut readCut(const std::string& file, const ColumnSpec& angle, AxisKind kind) {
  const TextLines text(file);
  std::vector<CutRow> rows;
  double smallest_db = std::numeric_limits<double>::infinity();
  for (const GridRow& row : readRows(text, {angle, kAttenuation})) {
    rows.push_back({row.values[0], row.values[1], row.line, 1});
    smallest_db = std::min(smallest_db, row.values[1]);
  }
  MeasuredCut cut(kind, std::move(rows), {file, 0, 0}, "cut");
  requireMaximum(smallest_db, {file, 0, 0}, "cut");
  return cut;
}

ShapeTable tableOf(const MeasuredCut& cut, double half_span) {
  return tabulate([cut](double angle_rad) { return cut.amplitudeAt(radToDeg(angle_rad)); }, half_span,
                  cut.angles_deg());
}

/// The values of rows (elevation, azimuth, value), azimuth fastest.
std::vector<double> inGridOrder(std::vector<GridRow> rows, const MeasuredAxis& azimuth,
                                const MeasuredAxis& elevation, const SourceLocation& file, const char* unit) {
  const auto pairOf = [](const GridRow& row) { return std::make_pair(row.values[0], row.values[1]); };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const GridRow& a, const GridRow& b) { return pairOf(a) < pairOf(b); });
  std::vector<double> values;
  const std::size_t columns = azimuth.angles_deg().size();
  const std::size_t cells = columns * elevation.angles_deg().size();
  std::size_t row = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto pair =
        std::make_pair(elevation.angles_deg()[cell / columns], azimuth.angles_deg()[cell % columns]);
    if (row == rows.size() || pairOf(rows[row]) != pair) {
      throw Error(
          ErrorCode::bad_input, file,
          fmt::format("the grid has no row for azimuth {} deg, elevation {} deg", pair.second, pair.first));
    }
    values.push_back(rows[row].values[2]);
    for (++row; row < rows.size() && pairOf(rows[row]) == pair; ++row) {
      if (rows[row].values[2] == values.back()) continue;
      throw Error(
          ErrorCode::bad_input, {file.file, rows[row].line, 1},
          fmt::format("azimuth {} deg, elevation {} deg occurs a second time, with {} {} instead of {} {}",
                      pair.second, pair.first, rows[row].values[2], unit, values.back(), unit));
    }
  }
  return values;
}

}  // namespace

AntennaPtr readCsvCuts(const std::string& azimuth_file, const std::string& elevation_file, double gain_dbi) {
  requireGain(gain_dbi);
  const auto endingOfCut = [](const std::string& file) {
    return upperCase(std::filesystem::path(file).extension().string());
  };
  if (endingOfCut(azimuth_file) == ".AZ" && endingOfCut(elevation_file) == ".EL") {
    std::vector<std::string> warnings;
    AntennaPtr antenna = antennaOf(azimuth_file, readSplat(azimuth_file, elevation_file), gain_dbi, warnings);
    for (const std::string& warning : warnings) logWarning(warning);
    return antenna;
  }
  ShapeTable azimuth = tableOf(readCut(azimuth_file, kAzimuthColumn, AxisKind::circle), kPi);
  ShapeTable elevation = tableOf(readCut(elevation_file, kElevationColumn, AxisKind::elevation), kPi / 2);
  const double azimuth_deg = radToDeg(halfPowerWidth(azimuth.values, azimuth.half_span, true));
  const double elevation_deg = radToDeg(halfPowerWidth(elevation.values, elevation.half_span, false));
  return describedAntenna(std::make_shared<SeparableAntenna>(std::move(azimuth), std::move(elevation), 0.0),
                          gain_dbi, azimuth_deg, elevation_deg, "measured cuts");
}

double MeasuredGrid::valueAt(const AxisSample& a, const AxisSample& e) const {
  const double* below = &values[e.below * azimuth.angles_deg().size()];
  const double* above = &values[e.above * azimuth.angles_deg().size()];
  const double at_below = below[a.below] + a.fraction * (below[a.above] - below[a.below]);
  const double at_above = above[a.below] + a.fraction * (above[a.above] - above[a.below]);
  return at_below + e.fraction * (at_above - at_below);
}

MeasuredGrid readMeasuredGrid(const std::string& file, const ColumnSpec& value, bool allows_azimuth_alone) {
  const SourceLocation location{file, 0, 0};
  const TextLines text(file);
  std::vector<GridRow> rows;
  const std::vector<std::string> names = document::csvColumnsOf(file);
  if (allows_azimuth_alone && std::count(names.begin(), names.end(), kElevationColumn.name) == 0) {
    for (const GridRow& row : readRows(text, {kAzimuthColumn, value})) {
      for (const double elevation_deg : {-90.0, 0.0, 90.0})
        rows.push_back({{elevation_deg, row.values[0], row.values[1]}, row.line});
    }
  } else {
    rows = readRows(text, {kElevationColumn, kAzimuthColumn, value});
  }
  std::vector<double> azimuths_deg, elevations_deg;
  for (GridRow& row : rows) {
    elevations_deg.push_back(row.values[0] = MeasuredAxis::normalized(AxisKind::elevation, row.values[0]));
    azimuths_deg.push_back(row.values[1] = MeasuredAxis::normalized(AxisKind::circle, row.values[1]));
  }
  MeasuredGrid grid{{AxisKind::circle, std::move(azimuths_deg), location, "grid's azimuths"},
                    {AxisKind::elevation, std::move(elevations_deg), location, "grid's elevations"},
                    {}};
  grid.values = inGridOrder(std::move(rows), grid.azimuth, grid.elevation, location, value.unit);
  return grid;
}

PatternFile readGridPattern(const std::string& file) {
  MeasuredGrid grid = readMeasuredGrid(file, kAttenuation);
  requireMaximum(*std::min_element(grid.values.begin(), grid.values.end()), {file, 0, 0}, "grid");
  std::transform(grid.values.begin(), grid.values.end(), grid.values.begin(), amplitudeOfAttenuation);
  PatternFile pattern;
  pattern.format = "CSV grid";
  pattern.name = "measured grid";
  pattern.nodes = gridNodes(grid.azimuth.angles_deg(), grid.elevation.angles_deg());
  std::vector<AxisSample> columns;
  for (const double azimuth_deg : pattern.nodes.azimuths_deg)
    columns.push_back(grid.azimuth.locate(azimuth_deg));
  for (const double elevation_deg : pattern.nodes.elevations_deg) {
    const AxisSample e = grid.elevation.locate(elevation_deg);
    for (const AxisSample& a : columns) pattern.amplitudes.push_back(static_cast<float>(grid.valueAt(a, e)));
  }
  return pattern;
}

}  // namespace emscape::scenario
