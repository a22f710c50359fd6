#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/geodesy/position_text.h"
#include "emscape/base/error.h"
#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/tracks/table_columns.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

/// Above the first of these numbers a time is since 1970; the others tell in which unit.
constexpr double kUnixTime_s = 1e8, kUnixTime_ms = 1e11, kUnixTime_us = 1e14, kUnixTime_ns = 1e17;

/// A time since 1970 in seconds.
double secondsOf(double time) {
  return time > kUnixTime_ns   ? time / 1e9
         : time > kUnixTime_us ? time / 1e6
         : time > kUnixTime_ms ? time / 1000
                               : time;
}

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

/// True for an empty line, and for a comment that does not name the columns.
bool isComment(std::string_view line, const ReadOptions& options) {
  if (line.empty() || line.front() != '#') return line.empty();
  try {
    return !hasPosition(columnsOf(headerOf(line), options));
  } catch (const Error&) {  // it does not have the columns that were named
    return true;
  }
}

/// An angle whose parts are apart, "52 06.1 N", as one word, "52:06.1N".
std::string joinedAngle(const std::string& text) {
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_blank = text[i] == ' ';
    const bool is_before_digit = i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    const bool is_after_digit = !joined.empty() && joined.back() >= '0' && joined.back() <= '9';
    if (!is_blank) joined += text[i];
    if (is_blank && is_before_digit && is_after_digit) joined += ':';
  }
  return joined;
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
      takeRow(cellsOf(line, separator_));
    }
    if (is_utc_) recorder_.hasUtc();
    return recorder_.finish();
  }

 private:
  void takeHeader(std::string_view line, long long number) {
    separator_ = separatorOf(line);
    header_ = headerOf(line);
    const std::vector<std::string>& header = header_;
    columns_ = columnsOf(header, options_);
    for (const Column needed : {Column::time, Column::latitude, Column::longitude}) {
      const bool is_in_position = needed != Column::time && columns_.count(Column::position) != 0;
      if (is_in_position || columns_.count(needed) != 0) continue;
      throw Error(ErrorCode::bad_input, {name_, static_cast<int>(number), 1},
                  fmt::format("no column for the {}; name it (--columns, or 'columns' of a track): "
                              "time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft. The table has {}",
                              roleOf(needed), printableText(fmt::format("{}", fmt::join(header, ", ")))));
    }
  }

  /// In tables separated by semicolons or tabs the comma may be decimal, with dots between thousands.
  std::optional<double> numberOf(std::string text) const {
    const std::size_t comma = text.rfind(',');
    if (separator_ != ',' && comma != std::string::npos) {
      if (text.find('.') < comma) text.erase(std::remove(text.begin(), text.end(), '.'), text.end());
      std::replace(text.begin(), text.end(), ',', '.');
    }
    return numberIn(text);
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
    const auto number = cell == nullptr ? std::nullopt : numberOf(*cell);
    return number ? std::optional(*number * columns_.at(column).factor) : std::nullopt;
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
    if (date == nullptr) {
      if (const auto number = numberOf(*told)) {
        const double time = *number * column.factor;
        if (column.day_of_1970 > 0) {
          is_utc_ = true;
          return (*number - column.day_of_1970) * kSecondsPerDay;
        }
        recorder_.mayBeDays(!column.has_unit);
        if (time > kUnixTime_s) is_utc_ = true;
        return secondsOf(time);
      }
    }
    const std::string text = date == nullptr ? *told : *date + " " + *told;
    const DateOrder order = date == nullptr ? column.order : columns_.at(Column::date).order;
    if (const auto time_s = utcSeconds(text, order)) {
      is_utc_ = true;
      return time_s;
    }
    if (needsDateOrder(text)) {
      throw Error(
          ErrorCode::bad_input, {name_, 0, 0},
          fmt::format(
              "{}: the date '{}' may begin with its day or its month; tell it with columns: {}=NAME:dmy "
              "or {}=NAME:mdy, beside latitude=NAME,longitude=NAME",
              location_, printableText(text), roleOf(date == nullptr ? Column::time : Column::date),
              roleOf(date == nullptr ? Column::time : Column::date)));
    }
    return bad(fmt::format("its time '{}' cannot be read", printableText(text)));
  }

  /// Latitude and longitude: numbers, or with minutes, seconds and the letters of the directions.
  std::optional<std::pair<double, double>> placeOf(const std::vector<std::string>& cells) {
    const auto latitude_deg = valueOf(cells, Column::latitude),
               longitude_deg = valueOf(cells, Column::longitude);
    if (latitude_deg && longitude_deg) {
      const bool is_scaled = std::abs(*latitude_deg) > kScaledFrom || std::abs(*longitude_deg) > kScaledFrom;
      if (is_scaled) recorder_.assume("coordinates beyond a million: taken as 1e-7 degrees");
      const double unit = is_scaled ? 1e-7 : 1;
      return std::pair(*latitude_deg * unit, *longitude_deg * unit);
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

  /// Its heights are in metres, by its documentation.
  bool isOfOpenSky(Column column) const {
    const std::string name = lowerCase(header_[columns_.at(column).index]);
    return name == "geoaltitude" || name == "baroaltitude" || name == "geo_altitude" ||
           name == "baro_altitude";
  }

  /// Height above mean sea level (m); none: counted as bad.
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
      if (!height_m) return bad(fmt::format("its height '{}' is no number", printableText(*cell)));
      // As Flightradar24 writes it, which has both coordinates in one column.
      if (columns_.count(Column::position) != 0 && !columns_.at(column).has_unit) {
        recorder_.assume("height without a unit in a table of Flightradar24: taken as feet");
        *height_m *= kMetresPerFoot;
      } else if (!columns_.at(column).has_unit && options_.columns.empty() && !isOfOpenSky(column)) {
        if (height_note_.empty())
          height_note_ = fmt::format(
              "height without a unit in column '{}': taken as metres; if it is in feet, give the columns as "
              "{}",
              printableText(header_[columns_.at(column).index]),
              printableText(mapWithHeightsInFeet(columns_, header_)));
        recorder_.assume(height_note_);
      }
      if (column == Column::height_ellipsoid && std::abs(latitude_deg) <= 90 &&
          std::abs(longitude_deg) <= 720)
        return heightMsl_m(latitude_deg, longitude_deg, *height_m);
      if (column == Column::height_pressure)
        recorder_.assume("weather: a height by pressure is taken as above mean sea level");
      return height_m;
    }
    recorder_.assume("height of a row without one: 0 m is taken");
    return 0;
  }

  void takeRow(const std::vector<std::string>& cells) {
    const auto place = placeOf(cells);
    const auto time_s = place ? timeOf(cells) : std::nullopt;
    if (!time_s) return;
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
    recorder_.add(recorder_.objectOf(id == nullptr ? stem_ : printableText(*id)), pose, location_);
  }

  std::string name_, stem_, location_, height_note_;
  const ReadOptions& options_;
  TrackRecorder recorder_;
  std::vector<std::string> header_;
  Columns columns_;
  char separator_ = ',';
  bool is_utc_ = false, is_base_station_ = false;
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
