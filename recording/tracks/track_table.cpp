#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/geodesy/position_text.h"
#include "base/text/decimal_signs.h"
#include "base/text/unended_line.h"
#include "emscape/base/error.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/tracks/table_cells.h"
#include "recording/tracks/table_columns.h"
#include "recording/tracks/table_times.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

/// Coordinates from here on are integers, as flight controllers log them.
constexpr double kScaledFrom = 1e6;

/// In the order of preference.
constexpr std::array<Column, 3> kHeights{Column::height_msl, Column::height_ellipsoid,
                                         Column::height_pressure};

/// A line without the byte order mark.
std::string_view lineOf(std::string_view line) {
  if (line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
  return trimmed(line);
}

bool hasPosition(const Columns& columns) {
  return columns.count(Column::position) != 0 ||
         (columns.count(Column::latitude) != 0 && columns.count(Column::longitude) != 0);
}

/// The columns of a header line. @throws Error (usage)
Columns columnsOf(const std::vector<std::string>& header, const ReadOptions& options) {
  return options.columns.empty() ? columnsByName(header) : columnsByMap(header, options.columns);
}

/// Names of columns; they may stand in a comment.
std::vector<std::string> headerOf(std::string_view line) {
  if (!line.empty() && line.front() == '#') line.remove_prefix(1);
  return cellsOf(line, separatorOf(line));
}

/// True for an empty line, for the separator that spreadsheets write, and for a comment that does not name
/// the columns.
bool isComment(std::string_view line, const ReadOptions& options) {
  if (lowerCase(std::string(line.substr(0, 4))) == "sep=") return true;
  if (line.empty() || line.front() != '#') return line.empty();
  try {
    return !hasPosition(columnsOf(headerOf(line), options));
  } catch (const Error&) {  // it does not have the columns that were named
    return true;
  }
}

class TableReader {
 public:
  TableReader(const std::string& name, const ReadOptions& options)
      : stem_(std::filesystem::path(name).stem().string()),
        options_(options),
        recorder_("track table", options) {
    table_.file = name;
  }

  Recording read(LineReader& lines) {
    for (std::string_view line; lines.next(line);) {
      line = lineOf(line);
      if (table_.columns.empty() && !line.empty() && line.front() == '#') units_ = headerOf(line);
      if (table_.columns.empty() ? isComment(line, options_) : line.empty() || line.front() == '#') continue;
      if (table_.columns.empty() && isBaseStation(line)) {
        table_.columns = columnsOfBaseStation();
        is_base_station_ = true;
      } else if (table_.columns.empty()) {
        takeHeader(line, lines.line());
        continue;
      }
      location_ = fmt::format("line {}", lines.line());
      ++recorder_.tally().records;
      const std::vector<std::string> cells = cellsOf(line, table_.separator);
      if (hasSurplus(cells)) {
        bad(
            fmt::format("it has {} cells, the header {}; are decimals written with commas, or texts with "
                        "separators?",
                        cells.size(), table_.header.size()));
      } else {
        seeNumbers(cells, lines.line());
        takeRow(cells);
        if (!lines.isTerminated()) recorder_.tally().notes.push_back(unendedLineText(lines.line(), "a row"));
      }
    }
    requireOneDecimalSign();
    if (times_.areUtc()) recorder_.hasUtc();
    recorder_.tellObjectsApartBy(objectsRemedy());
    Recording recording = recorder_.finish();
    recording.has_times_of_day = times_.areOfDay();
    if (!letters_told_.empty()) recording.tally.notes.push_back(letters_told_);
    tellUnused(recording.tally);
    times_.tellLongSteps(path_deg_, recording.tally);
    return recording;
  }

 private:
  void seeNumbers(const std::vector<std::string>& cells, long long line) {
    for (const auto& [column, of_table] : table_.columns) {
      if (column == Column::id || column == Column::position || of_table.index >= cells.size()) continue;
      const std::string& cell = cells[of_table.index];
      const bool is_coordinate = column == Column::latitude || column == Column::longitude;
      if (is_coordinate && table_.separator == ',')
        decimal_signs_.seeCoordinate(cell);
      else
        decimal_signs_.see(cell, {table_.file, static_cast<int>(line), 0});
    }
  }

  /// Where commas separate cells, one within a number is between thousands; see TrackTable::numberOf().
  void requireOneDecimalSign() const {
    if (table_.separator == ',')
      decimal_signs_.requireOneComma();
    else
      decimal_signs_.require();
  }

  void takeHeader(std::string_view line, long long number) {
    table_.separator = separatorOf(line);
    table_.header = headerOf(line);
    if (!isUtf8(line)) utf8Of(line, "", &letters_told_);
    const std::vector<std::string>& header = table_.header;
    table_.columns = columnsOf(header, options_);
    takeUnitsAbove();
    tellLocalHeights();
    for (const Column needed : {Column::time, Column::latitude, Column::longitude}) {
      const bool is_in_position = needed != Column::time && table_.columns.count(Column::position) != 0;
      if (is_in_position || table_.columns.count(needed) != 0) continue;
      throw Error(ErrorCode::bad_input, {table_.file, static_cast<int>(number), 1},
                  fmt::format("no column for the {}; name it (--columns, or 'columns' of a track): "
                              "time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft; where several columns "
                              "make it (year, month, ...), join them in one first. The table has {}",
                              roleOf(needed), printableText(fmt::format("{}", fmt::join(header, ", ")))));
    }
    for (std::size_t i = 0; i < header.size(); ++i) {
      const bool is_used = std::any_of(table_.columns.begin(), table_.columns.end(),
                                       [i](const auto& column) { return column.second.index == i; });
      if (!is_used && !header[i].empty()) unused_.push_back({i, {}, {}, 0, 0, false});
    }
  }

  /// Units of heights in a comment above the header that has a cell for each column, as Garmin's avionics
  /// write it.
  void takeUnitsAbove() {
    if (units_.size() != table_.header.size()) return;
    for (const Column height : kHeights) {
      const auto found = table_.columns.find(height);
      if (found == table_.columns.end() || found->second.has_unit) continue;
      const std::string& unit = units_[found->second.index];
      const auto factor = unit.empty() ? std::nullopt : factorOfUnit(unit);
      if (!factor) continue;
      found->second.factor = *factor;
      found->second.has_unit = true;
    }
  }

  std::string nameOf(const UnusedColumn& column) const { return printableText(table_.header[column.index]); }

  bool hasHeight() const {
    return std::any_of(kHeights.begin(), kHeights.end(),
                       [this](Column height) { return table_.columns.count(height) != 0; });
  }

  /// Of a column that by its name has another datum than heights have. @param datum  by localDatumOf()
  std::string localHeightText(std::size_t index, const char* use, const std::string& datum) const {
    return fmt::format(
        "column '{}' {}: by its name it is above {}, but heights of tracks are above mean sea level "
        "or the ellipsoid. Add the height of {} to it in the table, and rename it; or {}",
        printableText(table_.header[index]), use, datum, datum, kHeightsAboveGround);
  }

  /// Columns that are named as heights, but by their names have another datum.
  void tellLocalHeights() {
    for (const Column height : kHeights) {
      const auto found = table_.columns.find(height);
      if (found == table_.columns.end() || !options_.uses_heights) continue;
      const std::size_t index = found->second.index;
      const std::string datum = localDatumOf(table_.header[index]);
      if (!datum.empty())
        recorder_.tally().notes.push_back(localHeightText(index, "is taken as 'columns' says", datum));
    }
  }

  /// What tells the objects of rows apart: of the columns without a role those of texts that repeat, or of
  /// numbers if there are none.
  std::string objectsRemedy() const {
    std::string names;
    for (const bool has_text : {true, false}) {
      for (const UnusedColumn& column : unused_) {
        if (column.mayBeNames() && column.has_text == has_text)
          names += (names.empty() ? "id=" : " or id=") + nameOf(column);
      }
      if (!names.empty()) break;
    }
    return fmt::format("--columns (or 'columns' of a track) names the column that tells objects apart: {}",
                       names.empty() ? "id=NAME" : names);
  }

  void tellUnused(ReadingTally& tally) const {
    std::string names, example;
    bool are_all_heights = true;
    for (const UnusedColumn& column : unused_) {
      const std::string datum = localDatumOf(table_.header[column.index]);
      are_all_heights = are_all_heights && !datum.empty();
      if (!datum.empty() && !hasHeight() && options_.uses_heights) {
        tally.notes.push_back(localHeightText(column.index, "is not used", datum));
        continue;
      }
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", nameOf(column));
      if (column.has_text && column.mayBeNames() && 2 * column.turns > column.rows && example.empty()) {
        example = "id=" + nameOf(column);
        tally.notes.push_back(fmt::format(
            "the texts of column '{}' take turns, as the names of several objects do: {} makes an "
            "object of each",
            nameOf(column), example));
      }
    }
    if (names.empty()) return;
    tally.notes.push_back(fmt::format(
        "not used: {} {}{}", names.find("', '") == std::string::npos ? "column" : "columns", names,
        are_all_heights ? ""
                        : "; --columns (or 'columns' of a track) tells what a column is, such as id=NAME or "
                          "height=NAME:ft"));
  }

  /// Finds the columns of N or S and of E or W, which give coordinates their signs, by the first row.
  void findHemispheres(const std::vector<std::string>& cells) {
    const auto columnOf = [&](char positive, char negative) {
      return std::find_if(unused_.begin(), unused_.end(), [&](const UnusedColumn& column) {
        if (column.index >= cells.size() || cells[column.index].size() != 1) return false;
        const char letter = cells[column.index][0] & ~0x20;
        return letter == positive || letter == negative;
      });
    };
    has_looked_for_hemispheres_ = true;
    const auto north = columnOf('N', 'S'), east = columnOf('E', 'W');
    if (north == unused_.end() || east == unused_.end()) return;
    hemispheres_ = std::pair(north->index, east->index);
    const auto is_one = [&](const UnusedColumn& column) {
      return column.index == hemispheres_->first || column.index == hemispheres_->second;
    };
    unused_.erase(std::remove_if(unused_.begin(), unused_.end(), is_one), unused_.end());
  }

  /// A coordinate with the sign of its hemisphere. @param letters  positive and negative
  std::optional<double> inHemisphere(double value_deg, const std::vector<std::string>& cells,
                                     std::size_t index, std::string_view letters) {
    const std::string cell = index < cells.size() ? cells[index] : "";
    const std::size_t found = cell.size() == 1 ? letters.find(cell[0] & ~0x20) : std::string_view::npos;
    if (found == std::string_view::npos || (found == 0 && value_deg < 0))
      return bad(fmt::format("its hemisphere '{}' with {:.7g} degrees cannot be read", printableText(cell),
                             value_deg));
    return found == 0 ? value_deg : -std::abs(value_deg);
  }

  /// True if a row has more cells than the header, but for empty ones at its end.
  bool hasSurplus(const std::vector<std::string>& cells) const {
    if (is_base_station_ || table_.header.empty() || cells.size() <= table_.header.size()) return false;
    return std::any_of(cells.begin() + static_cast<std::ptrdiff_t>(table_.header.size()), cells.end(),
                       [](const std::string& cell) { return !cell.empty(); });
  }

  std::nullopt_t bad(const std::string& reason) {
    countBad(recorder_.tally(), location_, reason);
    return std::nullopt;
  }

  /// Latitude and longitude: numbers, or with minutes, seconds and the letters of the directions.
  std::optional<std::pair<double, double>> placeOf(const std::vector<std::string>& cells) {
    const auto latitude_deg = table_.valueOf(cells, Column::latitude),
               longitude_deg = table_.valueOf(cells, Column::longitude);
    if (latitude_deg && longitude_deg) {
      const bool is_scaled = std::abs(*latitude_deg) > kScaledFrom || std::abs(*longitude_deg) > kScaledFrom;
      if (is_scaled) recorder_.assume("coordinates beyond a million: taken as 1e-7 degrees");
      const double unit = is_scaled ? 1e-7 : 1;
      if (!has_looked_for_hemispheres_) findHemispheres(cells);
      if (!hemispheres_) return std::pair(*latitude_deg * unit, *longitude_deg * unit);
      const auto north_deg = inHemisphere(*latitude_deg * unit, cells, hemispheres_->first, "NS");
      const auto east_deg =
          north_deg ? inHemisphere(*longitude_deg * unit, cells, hemispheres_->second, "EW") : std::nullopt;
      return east_deg ? std::optional(std::pair(*north_deg, *east_deg)) : std::nullopt;
    }
    const std::string *const north = table_.cellOf(cells, Column::latitude),
                             *const east = table_.cellOf(cells, Column::longitude),
                             *const both = table_.cellOf(cells, Column::position);
    if (both == nullptr && (north == nullptr || east == nullptr)) {
      if (!is_base_station_) return bad("it has no latitude or longitude");
      countIgnored(recorder_.tally(), "message without a position");
      return std::nullopt;
    }
    const std::string text = both != nullptr ? *both : joinedAngle(*north) + ", " + joinedAngle(*east);
    // A decimal comma would be taken for one between numbers.
    const bool is_clear = std::count(text.begin(), text.end(), ',') <= 1;
    try {
      if (is_clear) {
        const ParsedPosition position = parsePosition(text);
        return std::pair(position.latitude_deg, position.longitude_deg);
      }
    } catch (const Error&) {  // told below
    }
    return bad(fmt::format("its position '{}' cannot be read", printableText(text)));
  }

  std::string idText(const std::string& id) {
    return printableText(isUtf8(id) ? id : utf8Of(id, "", &letters_told_));
  }

  /// It has both coordinates in one column.
  bool isOfFlightradar() const {
    const auto has = [this](const char* name) {
      return std::any_of(table_.header.begin(), table_.header.end(),
                         [name](const std::string& cell) { return lowerCase(cell) == name; });
    };
    return table_.columns.count(Column::position) != 0 && has("callsign") && has("direction");
  }

  /// Its heights are in metres, by its documentation.
  bool isOfOpenSky(Column column) const {
    const std::string name = lowerCase(table_.header[table_.columns.at(column).index]);
    return name == "geoaltitude" || name == "baroaltitude" || name == "geo_altitude" ||
           name == "baro_altitude";
  }

  /// Height above mean sea level (m), NaN if the row has none; no value: counted as bad.
  std::optional<double> heightOf_m(const std::vector<std::string>& cells, double latitude_deg,
                                   double longitude_deg) {
    for (const Column column : kHeights) {
      const std::string* const cell = table_.cellOf(cells, column);
      if (cell == nullptr) continue;
      auto height_m = table_.valueOf(cells, column);
      if (!height_m && lowerCase(*cell) == "ground") {
        recorder_.assumeHeight(
            "height of an object on the ground: 0 m is taken; 'height_agl_m: 0' of a track puts it there");
        return 0;
      }
      const bool is_unknown = height_m ? isFill(*table_.numberOf(*cell))  // "n/a", "null", "-"
                                       : cell->find_first_of("0123456789") == std::string::npos;
      if (is_unknown) continue;
      if (!height_m) return bad(fmt::format("its height '{}' is no number", printableText(*cell)));
      if (!table_.columns.at(column).has_unit && isOfFlightradar()) {
        recorder_.assumeHeight("height without a unit in a table of Flightradar24: taken as feet");
        *height_m *= kMetresPerFoot;
      } else if (!table_.columns.at(column).has_unit && !isOfOpenSky(column)) {
        recorder_.assumeHeight(fmt::format(
            "height without a unit in column '{0}': taken as metres; if it is in feet, columns tell it: "
            "{1}={0}:ft",
            table_.nameOf(column), roleOf(column)));
      }
      if (column == Column::height_ellipsoid && std::abs(latitude_deg) <= 90 &&
          std::abs(longitude_deg) <= 720)
        return heightMsl_m(latitude_deg, longitude_deg, *height_m);
      if (column == Column::height_pressure)
        recorder_.assumeHeight("weather: a height by pressure is taken as above mean sea level");
      return height_m;
    }
    return kUnknown;
  }

  void takeRow(const std::vector<std::string>& cells) {
    const auto place = placeOf(cells);
    for (UnusedColumn& column : unused_) column.take(column.index < cells.size() ? cells[column.index] : "");
    const auto time_s = place ? times_.of(cells, location_) : std::nullopt;
    if (!time_s) return;
    if (last_place_)
      path_deg_ += std::hypot(place->first - last_place_->first, place->second - last_place_->second);
    last_place_ = place;
    PoseSample pose;
    pose.t_s = *time_s;
    pose.latitude_deg = place->first;
    pose.longitude_deg = place->second;
    const auto height_m = heightOf_m(cells, pose.latitude_deg, pose.longitude_deg);
    if (!height_m) return;
    pose.height_msl_m = *height_m;
    const auto heading_deg = table_.valueOf(cells, Column::heading);
    constexpr double kTurn_deg = 360;
    if (heading_deg && std::abs(*heading_deg) <= kTurn_deg) {
      pose.heading_deg = *heading_deg;
      pose.pitch_deg = table_.valueOf(cells, Column::pitch).value_or(kUnknown);
      pose.roll_deg = table_.valueOf(cells, Column::roll).value_or(kUnknown);
    } else if (heading_deg) {  // AIS writes 511 for an unknown one
      recorder_.assume("heading beyond a turn: not known");
    }
    const std::string* const id = table_.cellOf(cells, Column::id);
    recorder_.add(recorder_.objectOf(id == nullptr ? stem_ : idText(*id)), pose, location_);
  }

  std::string stem_, location_, letters_told_;
  const ReadOptions& options_;
  TrackRecorder recorder_;
  DecimalSigns decimal_signs_;
  TrackTable table_;
  TableTimes times_{table_, recorder_};
  std::vector<std::string> units_;  ///< the last comment above the header
  double path_deg_ = 0;             ///< way of all rows, roughly
  std::optional<std::pair<double, double>> last_place_;
  std::vector<UnusedColumn> unused_;
  std::optional<std::pair<std::size_t, std::size_t>> hemispheres_;  ///< columns of N or S, and of E or W
  bool is_base_station_ = false, has_looked_for_hemispheres_ = false;
};

}  // namespace

bool isTrackTable(std::string_view head, const ReadOptions& options) {
  constexpr std::size_t kLongestHeader = 4096;
  std::string_view rest = head;
  for (;;) {
    const std::size_t end = rest.find_first_of("\r\n");
    if (end == std::string_view::npos || end > kLongestHeader) return false;
    const std::string_view line = lineOf(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (isComment(line, options)) continue;
    return !options.columns.empty() || isBaseStation(line) || hasPosition(columnsByName(headerOf(line)));
  }
}

Recording readTrackTable(ByteSource& source, const std::string& name, const ReadOptions& options) {
  LineReader lines(source);
  return TableReader(name, options).read(lines);
}

}  // namespace emscape::interop
