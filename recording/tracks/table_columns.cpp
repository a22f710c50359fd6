#include "recording/tracks/table_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "emscape/base/error.h"
#include "recording/common/text.h"

namespace emscape::interop {
namespace {

bool endsWith(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::optional<double> factorOfUnit(const std::string& told) {
  std::string unit = lowerCase(told);
  static const std::map<std::string, double> factors{{"", 1},
                                                     {"m", 1},
                                                     {"metres", 1},
                                                     {"meters", 1},
                                                     {"metre", 1},
                                                     {"meter", 1},
                                                     {"deg", 1},
                                                     {"degrees", 1},
                                                     {"degree", 1},
                                                     {"\xC2\xB0", 1},
                                                     {"s", 1},
                                                     {"sec", 1},
                                                     {"seconds", 1},
                                                     {"utc", 1},
                                                     {"ft", kMetresPerFoot},
                                                     {"feet", kMetresPerFoot},
                                                     {"fl", 100 * kMetresPerFoot},
                                                     {"km", 1000},
                                                     {"cm", 0.01},
                                                     {"mm", 0.001},
                                                     {"rad", 180 / 3.14159265358979323846},
                                                     {"min", 60},
                                                     {"h", 3600},
                                                     {"d", kSecondsPerDay},
                                                     {"days", kSecondsPerDay},
                                                     {"ms", 1e-3},
                                                     {"milliseconds", 1e-3},
                                                     {"us", 1e-6},
                                                     {"\xC2\xB5s", 1e-6},
                                                     {"microsecond", 1e-6},
                                                     {"microseconds", 1e-6},
                                                     {"ns", 1e-9},
                                                     {"nanosecond", 1e-9},
                                                     {"nanoseconds", 1e-9},
                                                     {"millisecond", 1e-3}};
  for (const std::string_view reference : {" msl", " amsl", " asl", " baro", " wgs84", " gps"}) {
    if (endsWith(unit, reference)) unit.resize(unit.size() - reference.size());
  }
  const auto found = factors.find(unit);
  return found == factors.end() ? std::nullopt : std::optional(found->second);
}

namespace {

/// What a column may be called, in lower case, without a unit, blanks and underscores; the first that a
/// header has is taken.
struct ColumnNames {
  Column column;
  const char* role;  ///< name in --columns
  std::vector<std::string> names;
};
const std::vector<ColumnNames>& columnNames() {
  static const std::vector<ColumnNames> names{
      {Column::time,
       "time",
       {"timestamp", "datetime", "basedatetime", "utc", "utctime", "timeutc", "gpstime", "unixtime",
        "updatetime", "time", "t", "seconds", "flytime", "lcltime"}},
      {Column::date, "date", {"date", "utcdate", "dateutc", "lcldate"}},
      {Column::latitude, "latitude", {"latitude", "lat"}},
      {Column::longitude, "longitude", {"longitude", "lon", "lng", "long"}},
      {Column::position, "position", {"position", "latlon", "latlng", "coordinates"}},
      {Column::height_msl, "height", {}},  // by heightNameOf()
      {Column::height_ellipsoid, "height_ellipsoid", {}},
      {Column::height_pressure, "height_pressure", {}},
      {Column::heading,
       "heading",
       {"heading", "trueheading", "hdg", "yaw", "course", "cog", "track", "truetrack", "direction"}},
      {Column::pitch, "pitch", {"pitch"}},
      {Column::roll, "roll", {"roll"}},
      {Column::id, "id", {"icao24", "icao", "hex", "mmsi", "id", "platform", "object", "name", "callsign"}},
      {Column::utc_offset, "utc_offset", {"utcofst", "utcoffset"}},
  };
  return names;
}

/// Words for a height; of several columns that of the first word is taken. A word stands before those that
/// are a part of it.
constexpr std::array<std::string_view, 7> kHeightWords{"altitude",  "alt",  "height", "hgt",
                                                       "elevation", "elev", "ele"};

/// What a name says of a height: a word for it, and one for its reference at most. Another word (above
/// ground, of the geoid, of a cloud) makes it the height of something else.
struct HeightName {
  Column column;
  bool has_reference;
  std::ptrdiff_t word;  ///< index in kHeightWords, or beyond
};
std::optional<HeightName> heightNameOf(std::string name) {
  if (name == "hae" || name == "geoaltitude")
    return HeightName{Column::height_ellipsoid, true, kHeightWords.size()};
  const auto word = std::find_if(kHeightWords.begin(), kHeightWords.end(), [&](std::string_view of_height) {
    return name.find(of_height) != std::string::npos;
  });
  if (word == kHeightWords.end()) return std::nullopt;
  name.erase(name.find(*word), word->size());
  static const std::map<std::string, Column> references{{"", Column::height_msl},
                                                        {"msl", Column::height_msl},
                                                        {"amsl", Column::height_msl},
                                                        {"asl", Column::height_msl},
                                                        {"abovesealevel", Column::height_msl},
                                                        {"abovemeansealevel", Column::height_msl},
                                                        {"ellipsoid", Column::height_ellipsoid},
                                                        {"aboveellipsoid", Column::height_ellipsoid},
                                                        {"wgs84", Column::height_ellipsoid},
                                                        {"geom", Column::height_ellipsoid},
                                                        {"hae", Column::height_ellipsoid},
                                                        {"baro", Column::height_pressure},
                                                        {"barometric", Column::height_pressure},
                                                        {"pressure", Column::height_pressure}};
  const auto found = references.find(name);
  return found == references.end()
             ? std::nullopt
             : std::optional(HeightName{found->second, !name.empty(), word - kHeightWords.begin()});
}

bool isHeight(Column column) {
  return column == Column::height_msl || column == Column::height_ellipsoid ||
         column == Column::height_pressure;
}

/// True if a unit measures what a column holds: "Lat (d)" is in degrees, not in days.
bool measures(const std::string& told, Column column) {
  const std::string unit = lowerCase(told).substr(0, told.find(' '));
  const bool is_angle =
      unit == "deg" || unit == "degrees" || unit == "degree" || unit == "rad" || unit == "\xC2\xB0";
  const bool is_length = unit == "fl" || unit == "ft" || unit == "feet" || unit == "m" || unit == "km" ||
                         unit == "cm" || unit == "mm" || unit.rfind("met", 0) == 0;
  if (column == Column::time) return !is_angle && !is_length;
  return isHeight(column) ? is_length : is_angle;
}

/// Takes a unit that is a word of a name out of it: "altitude_ft", "altitude feet", "alt in feet msl"; a
/// short one at its end.
std::string unitTakenFrom(std::string& name) {
  static const std::set<std::string> kAnywhere{
      "ft",    "feet", "foot", "metres",       "meters",       "metre",
      "meter", "deg",  "rad",  "degrees",      "seconds",      "km",
      "ms",    "us",   "ns",   "milliseconds", "microseconds", "nanoseconds"};
  static const std::set<std::string> kAtEnd{"_m", "_s", "_utc", " m", " s"};
  constexpr const char* kBetween = " _-,/";
  for (std::size_t at = name.find_first_of(kBetween); at != std::string::npos;
       at = name.find_first_of(kBetween, at + 1)) {
    const std::size_t end = std::min(name.find_first_of(kBetween, at + 1), name.size());
    const std::string unit = name.substr(at + 1, end - at - 1);
    const bool is_unit =
        kAnywhere.count(unit) != 0 || (end == name.size() && kAtEnd.count(name.substr(at)) != 0);
    if (!is_unit || at == 0) continue;
    name.erase(at, end - at);
    if (endsWith(name.substr(0, at), " in") || endsWith(name.substr(0, at), "_in")) name.erase(at - 3, 3);
    return unit == "foot" ? "ft" : unit;
  }
  for (const char* const unit : {"feet", "meters", "metres"}) {  // "AltitudeFeet"
    if (name.size() <= std::string_view(unit).size() || !endsWith(name, unit)) continue;
    name.resize(name.size() - std::string_view(unit).size());
    return unit;
  }
  return "";
}

/// A name without its unit and what stands before a dot: "Alt (ft)", "altitude_ft", "Altitude feet",
/// "alt[m]", "OSD.height [m]".
std::pair<std::string, std::string> nameAndUnit(const std::string& told) {
  std::string name = lowerCase(told), unit;
  const std::size_t at = name.find_first_of("([");
  if (at != std::string::npos) {
    unit = std::string(trimmed(std::string_view(name).substr(at + 1, name.find_first_of(")]", at) - at - 1)));
    name.resize(at);
  }
  const bool is_of_dji = name.rfind("osd.", 0) == 0;
  name.erase(0, name.rfind('.') + 1);
  const std::string word = unitTakenFrom(name);
  if (!word.empty()) unit = word;
  name.erase(
      std::remove_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == '_' || c == '#'; }),
      name.end());
  if (name == "timeus" && unit.empty()) return {"time", "us"};  // of ArduPilot
  if (name == "height" && is_of_dji) name = "heightabovetakeoff";
  return {name, unit};
}

/// Numbers of 1970-01-01 in ways to number days.
std::optional<double> dayOf1970(const std::string& unit) {
  if (unit == "excel") return kSpreadsheetDayOf1970;
  if (unit == "mjd") return 40587;
  if (unit == "jd") return 2440587.5;
  return std::nullopt;
}

[[noreturn]] void refuseEntry(const std::string& entry) {
  std::string roles;
  for (const ColumnNames& names : columnNames())
    roles += (roles.empty() ? "" : ", ") + std::string(names.role);
  throw Error(ErrorCode::usage, fmt::format("columns: '{}' is not ROLE=NAME or ROLE=NAME:UNIT; roles are {}",
                                            printableText(entry), roles));
}

}  // namespace

const char* roleOf(Column column) {
  return columnNames()[static_cast<std::size_t>(column)].role;
}

std::vector<std::string> cellsOf(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool is_quote = c == '"' && (is_quoted || trimmed(cells.back()).empty());  // else seconds of an arc
    if (is_quote && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (is_quote) {
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

Columns columnsByName(const std::vector<std::string>& header) {
  std::vector<std::pair<std::string, std::string>> told;
  for (const std::string& cell : header) told.push_back(nameAndUnit(cell));
  Columns columns;
  for (const ColumnNames& known : columnNames()) {
    for (const std::string& name : known.names) {
      for (std::size_t i = 0; i < told.size() && columns.count(known.column) == 0; ++i) {
        const auto factor = factorOfUnit(told[i].second);
        if (told[i].first == name && factor) columns[known.column] = {i, *factor, !told[i].second.empty()};
      }
    }
  }
  // Local times without their offset are not known.
  const auto is_local = [&](Column column) {
    return columns.count(column) != 0 && told[columns[column].index].first.rfind("lcl", 0) == 0;
  };
  for (const Column column : {Column::time, Column::date}) {
    if (columns.count(Column::utc_offset) == 0 && is_local(column)) columns.erase(column);
  }
  std::vector<std::pair<HeightName, TableColumn>> heights;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto height = heightNameOf(told[i].first);
    const auto factor = factorOfUnit(told[i].second);
    if (height && factor) heights.emplace_back(*height, TableColumn{i, *factor, !told[i].second.empty()});
  }
  // Of several heights of a kind one that names its reference comes first.
  std::stable_sort(heights.begin(), heights.end(), [](const auto& a, const auto& b) {
    return std::pair(!a.first.has_reference, a.first.word) < std::pair(!b.first.has_reference, b.first.word);
  });
  for (const auto& [height, column] : heights) columns.try_emplace(height.column, column);
  return columns;
}

namespace {

/// Adds what a map that does not tell time and position leaves to the common names.
void completeByName(const std::vector<std::string>& header, Columns& columns) {
  const Columns mapped = columns;
  const auto has = [&mapped](Column column) { return mapped.count(column) != 0; };
  const bool has_place = has(Column::latitude) || has(Column::longitude) || has(Column::position);
  const bool has_height =
      std::any_of(mapped.begin(), mapped.end(), [](const auto& of) { return isHeight(of.first); });
  for (const auto& [column, told] : columnsByName(header)) {
    const bool is_place_known = column == Column::position && has_place;
    const bool is_told = is_place_known || (column == Column::date && has(Column::time)) ||
                         (isHeight(column) && has_height) ||
                         std::any_of(mapped.begin(), mapped.end(),
                                     [i = told.index](const auto& of) { return of.second.index == i; });
    if (!is_told) columns.try_emplace(column, told);
  }
}

}  // namespace

Columns columnsByMap(const std::vector<std::string>& header, const std::string& map) {
  Columns columns;
  for (const std::string& entry : cellsOf(map, ',')) {
    const std::size_t at = entry.find('=');
    const std::string role = entry.substr(0, at);
    const auto known = std::find_if(columnNames().begin(), columnNames().end(),
                                    [&](const ColumnNames& names) { return names.role == role; });
    if (at == std::string::npos || known == columnNames().end()) refuseEntry(entry);
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
    TableColumn& column = columns[known->column];
    column.index = static_cast<std::size_t>(found - header.begin());
    column.has_unit = !unit.empty();
    column.is_degrees_minutes = unit == "dm";
    if (column.is_degrees_minutes) continue;
    if (unit == "dmy" || unit == "mdy") {
      column.order = unit == "dmy" ? DateOrder::day_first : DateOrder::month_first;
      continue;
    }
    if (const auto day = dayOf1970(unit); day && known->column == Column::time) {
      column.day_of_1970 = *day;
      continue;
    }
    const std::string unit_in_name = nameAndUnit(name).second;  // "Alt (ft)"
    if (unit.empty() && unit_in_name != "utc" && factorOfUnit(unit_in_name) &&
        measures(unit_in_name, known->column))
      unit = unit_in_name;
    if (unit == "gps" && known->column == Column::time) {
      column.begin_s = kGpsBegin_s;
      continue;
    }
    column.has_unit = !unit.empty();
    const auto factor = factorOfUnit(unit);
    if (!factor) {
      throw Error(
          ErrorCode::usage,
          fmt::format(
              "columns: '{}' is no unit; allowed are m, km, ft, cm, mm, fl (flight levels), deg, rad, dm "
              "(DDMM.mmmm), s, ms, us, ns, min, h, days, gps (seconds since 1980), of dates dmy and mdy, and "
              "of "
              "numbered days excel, mjd and jd",
              printableText(unit)));
    }
    column.factor = *factor;
  }
  const bool has_place = columns.count(Column::position) != 0 ||
                         (columns.count(Column::latitude) != 0 && columns.count(Column::longitude) != 0);
  if (columns.count(Column::time) == 0 || !has_place) completeByName(header, columns);
  return columns;
}

std::string localDatumOf(const std::string& told) {
  auto [name, unit] = nameAndUnit(told);  // "altitude (ft agl)", "alt_agl_ft"
  const auto word = std::find_if(
      kHeightWords.begin(), kHeightWords.end(),
      [&name = name](std::string_view of_height) { return name.find(of_height) != std::string::npos; });
  if (word != kHeightWords.end()) {
    name.erase(name.find(*word), word->size());
  } else if (name != "agl" && name != "relativetoground") {
    return "";
  }
  const auto contains = [&name = name](std::string_view part) {
    return name.find(part) != std::string::npos;
  };
  if (name == "agl" || name == "radar" || name == "radio" || name == "vps" || endsWith(name, "agl") ||
      name.rfind("agl", 0) == 0 || endsWith(unit, "agl") || contains("aboveground") ||
      contains("overground") || contains("abovegnd") || contains("toground"))
    return "the ground";
  const bool is_relative = name == "rel" || contains("relative") || contains("takeoff") ||
                           contains("take-off") || contains("abovehome") || contains("abovelaunch");
  return is_relative ? "the take-off point" : "";
}

bool isBaseStation(std::string_view line) {
  return line.substr(0, 4) == "MSG," && std::count(line.begin(), line.end(), ',') >= 15;
}

/// @see http://woodair.net/sbs/article/barebones42_socket_data.htm
Columns columnsOfBaseStation() {
  const auto at = [](std::size_t index, double factor = 1) { return TableColumn{index, factor, true}; };
  return {{Column::id, at(4)},        {Column::date, at(6)},
          {Column::time, at(7)},      {Column::height_pressure, at(11, kMetresPerFoot)},
          {Column::heading, at(13)},  {Column::latitude, at(14)},
          {Column::longitude, at(15)}};
}

}  // namespace emscape::interop
