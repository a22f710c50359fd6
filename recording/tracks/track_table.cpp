#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "emscape/base/error.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

enum class Column {
  time,
  latitude,
  longitude,
  height_msl,
  height_ellipsoid,
  height_pressure,
  heading,
  pitch,
  roll,
  id
};

/// What a column may be called, in lower case, without a unit, blanks and underscores.
struct ColumnNames {
  Column column;
  const char* role;  ///< name in --columns
  std::vector<std::string> names;
};
const std::vector<ColumnNames>& columnNames() {
  static const std::vector<ColumnNames> names{
      {Column::time, "time", {"t", "time", "timestamp", "utc", "datetime", "unixtime"}},
      {Column::latitude, "latitude", {"latitude", "lat"}},
      {Column::longitude, "longitude", {"longitude", "lon", "lng", "long"}},
      {Column::height_msl, "height", {"heightmsl", "altitude", "alt", "height", "elevation", "ele"}},
      {Column::height_ellipsoid, "height_ellipsoid", {"heightellipsoid", "geoaltitude", "hae"}},
      {Column::height_pressure, "height_pressure", {"baroaltitude"}},
      {Column::heading, "heading", {"heading", "yaw", "course", "track", "truetrack"}},
      {Column::pitch, "pitch", {"pitch"}},
      {Column::roll, "roll", {"roll"}},
      {Column::id, "id", {"icao24", "mmsi", "id", "platform", "object", "name"}},
  };
  return names;
}

constexpr double kMetresPerFoot = 0.3048;
constexpr double kUnixTime_s = 1e8, kUnixTime_ms = 1e11;

struct TableColumn {
  std::size_t index = 0;
  double factor = 1;  ///< to metres or degrees
};
using Columns = std::map<Column, TableColumn>;

std::vector<std::string> cellsOf(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == separator && !is_quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = std::string(trimmed(cell));
  return cells;
}

char separatorOf(std::string_view line) {
  char best = ',';
  for (const char c : {';', '\t'}) {
    if (std::count(line.begin(), line.end(), c) > std::count(line.begin(), line.end(), best)) best = c;
  }
  return best;
}

/// @throws Error (usage) for another unit
double factorOf(const std::string& unit) {
  if (unit.empty() || unit == "m" || unit == "deg" || unit == "s") return 1;
  if (unit == "ft") return kMetresPerFoot;
  if (unit == "km") return 1000;
  if (unit == "rad") return 180 / 3.14159265358979323846;
  throw Error(ErrorCode::usage, fmt::format("columns: '{}' is no unit; allowed are m, km, ft, deg and rad",
                                            printableText(unit)));
}

/// A name without its unit: "Alt (ft)", "altitude_ft", "alt[m]".
std::pair<std::string, std::string> nameAndUnit(const std::string& told) {
  std::string name = lowerCase(told), unit;
  const std::size_t at = name.find_first_of("([");
  if (at != std::string::npos) {
    unit = name.substr(at + 1, name.find_first_of(")]", at) - at - 1);
    name.resize(at);
  }
  for (const char* end : {"ft", "m", "deg", "rad", "s", "km"}) {
    const std::string ending = std::string("_") + end;
    if (name.size() > ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
      unit = end;
      name.resize(name.size() - ending.size());
      break;
    }
  }
  name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == '_'; }),
             name.end());
  return {name, unit};
}

Columns columnsByName(const std::vector<std::string>& header) {
  Columns columns;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto [name, unit] = nameAndUnit(header[i]);
    const bool is_unit = unit.empty() || unit == "ft" || unit == "m" || unit == "deg" || unit == "rad" ||
                         unit == "s" || unit == "km";
    for (const ColumnNames& known : columnNames()) {
      const bool is_it = std::find(known.names.begin(), known.names.end(), name) != known.names.end();
      if (is_it && is_unit) columns.try_emplace(known.column, TableColumn{i, factorOf(unit)});
    }
  }
  return columns;
}

/// @param map  "latitude=Breite,height=Hoehe:ft"  @throws Error (usage)
Columns columnsByMap(const std::vector<std::string>& header, const std::string& map) {
  Columns columns;
  for (const std::string& entry : cellsOf(map, ',')) {
    const std::size_t at = entry.find('=');
    const std::string role = entry.substr(0, at);
    const auto known = std::find_if(columnNames().begin(), columnNames().end(),
                                    [&](const ColumnNames& names) { return names.role == role; });
    if (at == std::string::npos || known == columnNames().end()) {
      std::string roles;
      for (const ColumnNames& names : columnNames())
        roles += (roles.empty() ? "" : ", ") + std::string(names.role);
      throw Error(ErrorCode::usage,
                  fmt::format("columns: '{}' is not ROLE=NAME or ROLE=NAME:UNIT; roles are {}",
                              printableText(entry), roles));
    }
    std::string name = entry.substr(at + 1), unit;
    auto found = std::find(header.begin(), header.end(), name);
    const std::size_t colon = name.rfind(':');
    if (found == header.end() && colon != std::string::npos) {
      unit = lowerCase(name.substr(colon + 1));
      name.resize(colon);
      found = std::find(header.begin(), header.end(), name);
    }
    if (found == header.end()) {
      throw Error(ErrorCode::usage,
                  fmt::format("columns: the table has no column '{}'; it has {}", printableText(name),
                              printableText(fmt::format("{}", fmt::join(header, ", ")))));
    }
    columns[known->column] = {static_cast<std::size_t>(found - header.begin()), factorOf(unit)};
  }
  return columns;
}

Columns columnsOf(const std::vector<std::string>& header, const ReadOptions& options) {
  return options.columns.empty() ? columnsByName(header) : columnsByMap(header, options.columns);
}

/// The first line with a text in it, without the byte order mark.
std::string_view headerOf(std::string_view line) {
  if (line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
  return trimmed(line);
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
      line = headerOf(line);
      if (line.empty() || line.front() == '#') continue;
      if (columns_.empty()) {
        takeHeader(line);
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
  void takeHeader(std::string_view line) {
    separator_ = separatorOf(line);
    columns_ = columnsOf(cellsOf(line, separator_), options_);
    for (const Column needed : {Column::time, Column::latitude, Column::longitude}) {
      if (columns_.count(needed) != 0) continue;
      throw Error(ErrorCode::bad_input, {name_, 1, 1},
                  fmt::format("no column for the {}; name it (--columns, or 'columns' of a track): "
                              "time=NAME,latitude=NAME,longitude=NAME,height=NAME:ft",
                              columnNames()[static_cast<std::size_t>(needed)].role));
    }
  }

  /// In tables separated by semicolons the comma may be decimal.
  std::optional<double> numberOf(std::string text) const {
    if (separator_ == ';' && text.find('.') == std::string::npos)
      std::replace(text.begin(), text.end(), ',', '.');
    return numberIn(text);
  }

  std::optional<double> valueOf(const std::vector<std::string>& cells, Column column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end() || found->second.index >= cells.size()) return std::nullopt;
    const auto number = numberOf(cells[found->second.index]);
    return number ? std::optional(*number * found->second.factor) : std::nullopt;
  }

  std::optional<double> timeOf(const std::vector<std::string>& cells) {
    const std::size_t index = columns_.at(Column::time).index;
    if (index >= cells.size()) return std::nullopt;
    if (const auto number = numberOf(cells[index])) {
      if (*number > kUnixTime_s) is_utc_ = true;
      return *number > kUnixTime_ms ? *number / 1000 : *number;
    }
    const auto time_s = utcSeconds(cells[index]);
    if (time_s) is_utc_ = true;
    return time_s;
  }

  void takeRow(const std::vector<std::string>& cells) {
    const auto time_s = timeOf(cells), latitude_deg = valueOf(cells, Column::latitude),
               longitude_deg = valueOf(cells, Column::longitude);
    if (!time_s || !latitude_deg || !longitude_deg)
      return countBad(recorder_.tally(), location_, "it has no time, latitude or longitude");
    PoseSample pose;
    pose.t_s = *time_s;
    pose.latitude_deg = *latitude_deg;
    pose.longitude_deg = *longitude_deg;
    const auto msl_m = valueOf(cells, Column::height_msl),
               ellipsoid_m = valueOf(cells, Column::height_ellipsoid),
               pressure_m = valueOf(cells, Column::height_pressure);
    if (msl_m) {
      pose.height_msl_m = *msl_m;
    } else if (ellipsoid_m && std::abs(*latitude_deg) <= 90 && std::abs(*longitude_deg) <= 720) {
      pose.height_msl_m = heightMsl_m(*latitude_deg, *longitude_deg, *ellipsoid_m);
    } else if (pressure_m) {
      pose.height_msl_m = *pressure_m;
      recorder_.assume("weather: a height by pressure is taken as above mean sea level");
    } else {
      recorder_.assume("height of a row without one: 0 m is taken");
    }
    if (const auto heading_deg = valueOf(cells, Column::heading)) {
      pose.heading_deg = *heading_deg;
      pose.pitch_deg = valueOf(cells, Column::pitch).value_or(kUnknown);
      pose.roll_deg = valueOf(cells, Column::roll).value_or(kUnknown);
    }
    const auto id = columns_.find(Column::id);
    const bool has_id = id != columns_.end() && id->second.index < cells.size();
    recorder_.add(recorder_.objectOf(has_id ? printableText(cells[id->second.index]) : stem_), pose,
                  location_);
  }

  std::string name_, stem_, location_;
  const ReadOptions& options_;
  TrackRecorder recorder_;
  Columns columns_;
  char separator_ = ',';
  bool is_utc_ = false;
};

}  // namespace

bool isTrackTable(std::string_view head, const ReadOptions& options) {
  const std::size_t end = head.find('\n');
  if (end == std::string_view::npos || end > 4096) return false;
  if (!options.columns.empty()) return true;
  const std::string_view line = headerOf(head.substr(0, end));
  const Columns columns = columnsByName(cellsOf(line, separatorOf(line)));
  return columns.count(Column::latitude) != 0 && columns.count(Column::longitude) != 0;
}

Recording readTrackTable(ByteSource& source, const std::string& name, const ReadOptions& options) {
  LineReader lines(source);
  return TableReader(name, options).read(lines);
}

}  // namespace emscape::interop
