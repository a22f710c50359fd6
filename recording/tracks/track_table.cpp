#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/geodesy/position_text.h"
#include "emscape/base/error.h"
#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/tracks/table_cells.h"
#include "recording/tracks/table_columns.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

/// Coordinates from here on are integers, as flight controllers log them.
constexpr double kScaledFrom = 1e6;

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
      : name_(name),
        stem_(std::filesystem::path(name).stem().string()),
        options_(options),
        recorder_("track table", options) {}

  Recording read(LineReader& lines) {
    for (std::string_view line; lines.next(line);) {
      line = lineOf(line);
      if (columns_.empty() && !line.empty() && line.front() == '#') units_ = headerOf(line);
      if (columns_.empty() ? isComment(line, options_) : line.empty() || line.front() == '#') continue;
      if (columns_.empty() && isBaseStation(line)) {
        columns_ = columnsOfBaseStation();
        is_base_station_ = true;
      } else if (columns_.empty()) {
        takeHeader(line, lines.line());
        continue;
      }
      location_ = fmt::format("line {}", lines.line());
      ++recorder_.tally().records;
      const std::vector<std::string> cells = cellsOf(line, separator_);
      if (hasSurplus(cells)) {
        bad(
            fmt::format("it has {} cells, the header {}; are decimals written with commas, or texts with "
                        "separators?",
                        cells.size(), header_.size()));
      } else {
        takeRow(cells);
      }
    }
    if (is_utc_) recorder_.hasUtc();
    recorder_.tellObjectsApartBy(objectsRemedy());
    Recording recording = recorder_.finish();
    recording.has_times_of_day = has_times_of_day_;
    if (!letters_told_.empty()) recording.tally.notes.push_back(letters_told_);
    tellUnused(recording.tally);
    tellLongSteps(recording.tally);
    return recording;
  }

 private:
  void takeHeader(std::string_view line, long long number) {
    separator_ = separatorOf(line);
    header_ = headerOf(line);
    if (!isUtf8(line)) utf8Of(line, "", &letters_told_);
    const std::vector<std::string>& header = header_;
    columns_ = columnsOf(header, options_);
    takeUnitsAbove();
    for (const Column needed : {Column::time, Column::latitude, Column::longitude}) {
      const bool is_in_position = needed != Column::time && columns_.count(Column::position) != 0;
      if (is_in_position || columns_.count(needed) != 0) continue;
      throw Error(ErrorCode::bad_input, {name_, static_cast<int>(number), 1},
                  fmt::format("no column for the {}; name it (--columns, or 'columns' of a track): "
                              "time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft; where several columns "
                              "make it (year, month, ...), join them in one first. The table has {}",
                              roleOf(needed), printableText(fmt::format("{}", fmt::join(header, ", ")))));
    }
    for (std::size_t i = 0; i < header.size(); ++i) {
      const bool is_used = std::any_of(columns_.begin(), columns_.end(),
                                       [i](const auto& column) { return column.second.index == i; });
      if (!is_used && !header[i].empty()) unused_.push_back({i, {}, {}, 0, 0, false});
    }
  }

  /// Units of heights in a comment above the header that has a cell for each column, as Garmin's avionics
  /// write it.
  void takeUnitsAbove() {
    if (units_.size() != header_.size()) return;
    for (const Column height : {Column::height_msl, Column::height_ellipsoid, Column::height_pressure}) {
      const auto found = columns_.find(height);
      if (found == columns_.end() || found->second.has_unit) continue;
      const std::string& unit = units_[found->second.index];
      const auto factor = unit.empty() ? std::nullopt : factorOfUnit(unit);
      if (!factor) continue;
      found->second.factor = *factor;
      found->second.has_unit = true;
    }
  }

  /// Whole numbers without a unit that are far apart, in which an object creeps, are no seconds.
  void tellLongSteps(ReadingTally& tally) const {
    constexpr double kLongStep_s = 3e4, kCreeping_mps = 0.05, kDegree_m = 111e3;
    const double span_s = last_time_ - first_time_;
    if (plain_times_ < 3 || span_s < kLongStep_s * static_cast<double>(plain_times_ - 1) || path_deg_ == 0 ||
        path_deg_ * kDegree_m > kCreeping_mps * span_s)
      return;
    const std::string name = header_.empty() ? "" : printableText(header_[columns_.at(Column::time).index]);
    tally.notes.push_back(
        fmt::format("times of column '{0}' are taken as seconds; they are {1:.6g} apart on average: if they "
                    "are in microseconds or milliseconds, columns tell it: time={0}:us or time={0}:ms",
                    name, span_s / static_cast<double>(plain_times_ - 1)));
  }

  std::string nameOf(const UnusedColumn& column) const { return printableText(header_[column.index]); }

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
    if (unused_.empty()) return;
    std::string names, example;
    for (const UnusedColumn& column : unused_) {
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", nameOf(column));
      if (column.has_text && column.mayBeNames() && 2 * column.turns > column.rows && example.empty()) {
        example = "id=" + nameOf(column);
        tally.notes.push_back(fmt::format(
            "the texts of column '{}' take turns, as the names of several objects do: {} makes an "
            "object of each",
            nameOf(column), example));
      }
    }
    tally.notes.push_back(
        fmt::format("not used: {} {}; --columns (or 'columns' of a track) tells what a column is, such as "
                    "id=NAME or height=NAME:ft",
                    unused_.size() == 1 ? "column" : "columns", names));
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

  /// In tables separated by semicolons or tabs the comma may be decimal, with dots between thousands. In
  /// tables separated by commas a quoted one of a coordinate is decimal, others stand between thousands if
  /// three digits follow each.
  std::optional<double> numberOf(std::string text, bool is_coordinate = false) const {
    const std::size_t comma = text.rfind(',');
    if (comma == std::string::npos) return numberIn(text);
    if (separator_ != ',') {
      if (text.find('.') < comma) text.erase(std::remove(text.begin(), text.end(), '.'), text.end());
    } else if (!is_coordinate && haveThreeDigits(text)) {
      text.erase(std::remove(text.begin(), text.end(), ','), text.end());
    }
    std::replace(text.begin(), text.end(), ',', '.');
    return numberIn(text);
  }

  /// True if each comma has three digits after it, and then no further one.
  static bool haveThreeDigits(const std::string& text) {
    for (std::size_t at = text.find(','); at != std::string::npos; at = text.find(',', at + 1)) {
      const std::size_t end = text.find_first_not_of("0123456789", at + 1);
      if (std::min(end, text.size()) - at != 4) return false;
    }
    return true;
  }

  /// The cell of a column; null if the row has none, or nothing in it.
  const std::string* cellOf(const std::vector<std::string>& cells, Column column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end() || found->second.index >= cells.size()) return nullptr;
    const std::string& cell = cells[found->second.index];
    return cell.empty() ? nullptr : &cell;
  }

  std::optional<double> valueOf(const std::vector<std::string>& cells, Column column) const {
    const std::string* const cell = cellOf(cells, column);
    const bool is_coordinate = column == Column::latitude || column == Column::longitude;
    const auto number = cell == nullptr ? std::nullopt : numberOf(*cell, is_coordinate);
    if (!number) return std::nullopt;
    const TableColumn& told = columns_.at(column);
    return told.is_degrees_minutes ? degreesOf(*number) : *number * told.factor;
  }

  /// True if a row has more cells than the header, but for empty ones at its end.
  bool hasSurplus(const std::vector<std::string>& cells) const {
    if (is_base_station_ || header_.empty() || cells.size() <= header_.size()) return false;
    return std::any_of(cells.begin() + static_cast<std::ptrdiff_t>(header_.size()), cells.end(),
                       [](const std::string& cell) { return !cell.empty(); });
  }

  std::nullopt_t bad(const std::string& reason) {
    countBad(recorder_.tally(), location_, reason);
    return std::nullopt;
  }

  std::optional<double> timeOf(const std::vector<std::string>& cells) {
    const std::string* const told = cellOf(cells, Column::time);
    if (told == nullptr) return bad("it has no time");
    const TableColumn& column = columns_.at(Column::time);
    const std::string* const date = cellOf(cells, Column::date);
    const bool is_compact = date == nullptr && !column.has_unit && isCompactDate(*told);
    if (date == nullptr && !is_compact) {
      if (const auto number = numberOf(*told)) {
        const double time = *number * column.factor;
        if (column.day_of_1970 > 0 || column.begin_s > 0) {
          is_utc_ = true;
          return column.begin_s > 0 ? *number + column.begin_s
                                    : (*number - column.day_of_1970) * kSecondsPerDay;
        }
        recorder_.mayBeDays(!column.has_unit);
        if (!column.has_unit && time == std::floor(time)) {
          if (plain_times_++ == 0) first_time_ = secondsOf(time);
          last_time_ = secondsOf(time);
        }
        if (time > kFirstUnixTime_s) {
          is_utc_ = true;
          tellGpsName(column);
        }
        return secondsOf(time);
      }
    }
    std::string text = is_compact        ? told->substr(0, 8) + "T" + told->substr(8)
                       : date == nullptr ? *told
                                         : *date + " " + *told;
    double offset_s = 0;
    if (const std::string* const cell = cellOf(cells, Column::utc_offset);
        cell != nullptr && cell->find_first_not_of(" ") != std::string::npos && !isUtc(text)) {
      const std::optional<double> offset = offsetOf_s(*cell);
      if (!offset)
        return bad(
            fmt::format("its offset from UTC '{}' cannot be read; it is one as -04:00, in hours and minutes",
                        printableText(*cell)));
      offset_s = *offset;
      recorder_.assume(fmt::format("times are local: column '{}' gives their offset from UTC",
                                   printableText(header_[columns_.at(Column::utc_offset).index])));
    }
    const DateOrder order = date == nullptr ? column.order : columns_.at(Column::date).order;
    if (const auto time_s = utcSeconds(text, order)) {
      is_utc_ = true;
      return *time_s - offset_s;
    }
    if (needsDateOrder(text)) {
      throw Error(
          ErrorCode::bad_input, {name_, 0, 0},
          fmt::format(
              "{}: the date '{}' may begin with its day or its month; tell it with columns: {}=NAME:dmy "
              "or {}=NAME:mdy",
              location_, printableText(text), roleOf(date == nullptr ? Column::time : Column::date),
              roleOf(date == nullptr ? Column::time : Column::date)));
    }
    if (const auto time_s = date == nullptr ? timeOfDay(text) : std::nullopt) return *time_s - offset_s;
    return bad(
        fmt::format("its time '{}' cannot be read; it is one as 2026-06-01T06:00:00Z or "
                    "2026-06-01 08:00:00+02:00, in seconds since 1970 or of the scenario, or hh:mm:ss",
                    printableText(text)));
  }

  /// True if a time, or the name of its column, says that it is UTC or has its own offset.
  bool isUtc(const std::string& text) const {
    const std::string name = header_.empty() ? "" : lowerCase(header_[columns_.at(Column::time).index]);
    for (const char* const word : {"utc", "gmt", "zulu"}) {
      if (name.find(word) != std::string::npos) return true;
    }
    const std::size_t clock = text.find(':');
    return text.find_last_of("Zz") != std::string::npos ||
           (clock != std::string::npos && text.find_first_of("+-", clock) != std::string::npos);
  }

  /// hh:mm:ss without a date, as times of a day that is not told, and of the next ones where they fall.
  std::optional<double> timeOfDay(const std::string& text) {
    if (is_utc_ || std::count(text.begin(), text.end(), ':') != 2) return std::nullopt;
    const auto time_s = utcSeconds("1970-01-01 " + text);
    if (!time_s) return std::nullopt;
    has_times_of_day_ = true;
    if (*time_s + day_s_ < last_of_day_s_ - kSecondsPerDay / 2) day_s_ += kSecondsPerDay;
    last_of_day_s_ = *time_s + day_s_;
    return last_of_day_s_;
  }

  void tellGpsName(const TableColumn& column) {
    const std::string& name = header_.empty() ? stem_ : header_[column.index];
    if (header_.empty() || lowerCase(name).find("gps") == std::string::npos) return;
    recorder_.assume(
        fmt::format("time of column '{0}' taken as since 1970; if it is GPS time, since 1980, columns tell "
                    "it: time={0}:gps",
                    printableText(name)));
  }

  /// Latitude and longitude: numbers, or with minutes, seconds and the letters of the directions.
  std::optional<std::pair<double, double>> placeOf(const std::vector<std::string>& cells) {
    const auto latitude_deg = valueOf(cells, Column::latitude),
               longitude_deg = valueOf(cells, Column::longitude);
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
    const std::string *const north = cellOf(cells, Column::latitude),
                             *const east = cellOf(cells, Column::longitude),
                             *const both = cellOf(cells, Column::position);
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
      return std::any_of(header_.begin(), header_.end(),
                         [name](const std::string& cell) { return lowerCase(cell) == name; });
    };
    return columns_.count(Column::position) != 0 && has("callsign") && has("direction");
  }

  /// Its heights are in metres, by its documentation.
  bool isOfOpenSky(Column column) const {
    const std::string name = lowerCase(header_[columns_.at(column).index]);
    return name == "geoaltitude" || name == "baroaltitude" || name == "geo_altitude" ||
           name == "baro_altitude";
  }

  /// Height above mean sea level (m), NaN if the row has none; no value: counted as bad.
  std::optional<double> heightOf_m(const std::vector<std::string>& cells, double latitude_deg,
                                   double longitude_deg) {
    for (const Column column : {Column::height_msl, Column::height_ellipsoid, Column::height_pressure}) {
      const std::string* const cell = cellOf(cells, column);
      if (cell == nullptr) continue;
      auto height_m = valueOf(cells, column);
      if (!height_m && lowerCase(*cell) == "ground") {
        recorder_.assume("height of an object on the ground: 0 m is taken");
        return 0;
      }
      const bool is_unknown = height_m ? isFill(*numberOf(*cell))  // "n/a", "null", "-"
                                       : cell->find_first_of("0123456789") == std::string::npos;
      if (is_unknown) continue;
      if (!height_m) return bad(fmt::format("its height '{}' is no number", printableText(*cell)));
      if (!columns_.at(column).has_unit && isOfFlightradar()) {
        recorder_.assume("height without a unit in a table of Flightradar24: taken as feet");
        *height_m *= kMetresPerFoot;
      } else if (!columns_.at(column).has_unit && !isOfOpenSky(column)) {
        recorder_.assume(fmt::format(
            "height without a unit in column '{0}': taken as metres; if it is in feet, columns tell it: "
            "{1}={0}:ft",
            printableText(header_[columns_.at(column).index]), roleOf(column)));
      }
      if (column == Column::height_ellipsoid && std::abs(latitude_deg) <= 90 &&
          std::abs(longitude_deg) <= 720)
        return heightMsl_m(latitude_deg, longitude_deg, *height_m);
      if (column == Column::height_pressure)
        recorder_.assume("weather: a height by pressure is taken as above mean sea level");
      return height_m;
    }
    return kUnknown;
  }

  void takeRow(const std::vector<std::string>& cells) {
    const auto place = placeOf(cells);
    for (UnusedColumn& column : unused_) column.take(column.index < cells.size() ? cells[column.index] : "");
    const auto time_s = place ? timeOf(cells) : std::nullopt;
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
    const auto heading_deg = valueOf(cells, Column::heading);
    constexpr double kTurn_deg = 360;
    if (heading_deg && std::abs(*heading_deg) <= kTurn_deg) {
      pose.heading_deg = *heading_deg;
      pose.pitch_deg = valueOf(cells, Column::pitch).value_or(kUnknown);
      pose.roll_deg = valueOf(cells, Column::roll).value_or(kUnknown);
    } else if (heading_deg) {  // AIS writes 511 for an unknown one
      recorder_.assume("heading beyond a turn: not known");
    }
    const std::string* const id = cellOf(cells, Column::id);
    recorder_.add(recorder_.objectOf(id == nullptr ? stem_ : idText(*id)), pose, location_);
  }

  std::string name_, stem_, location_, letters_told_;
  const ReadOptions& options_;
  TrackRecorder recorder_;
  std::vector<std::string> header_, units_;  ///< units_: the last comment above the header
  Columns columns_;
  long long plain_times_ = 0;  ///< whole numbers without a unit, since no known time
  double first_time_ = 0, last_time_ = 0;
  double path_deg_ = 0;  ///< way of all rows, roughly
  std::optional<std::pair<double, double>> last_place_;
  char separator_ = ',';
  std::vector<UnusedColumn> unused_;
  std::optional<std::pair<std::size_t, std::size_t>> hemispheres_;  ///< columns of N or S, and of E or W
  double day_s_ = 0, last_of_day_s_ = 0;
  bool is_utc_ = false, has_times_of_day_ = false, is_base_station_ = false,
       has_looked_for_hemispheres_ = false;
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
