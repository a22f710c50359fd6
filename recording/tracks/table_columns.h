/// Columns of a table of positions: which is what, in which unit.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/common/dates.h"

namespace emscape::interop {

constexpr double kMetresPerFoot = 0.3048;
/// Begin of GPS time since 1970 (s), less the 18 leap seconds since 2017.
constexpr double kGpsBegin_s = 315964800 - 18;

enum class Column {
  time,
  date,  ///< of the time of day in `time`
  latitude,
  longitude,
  position,  ///< latitude and longitude in one cell
  height_msl,
  height_ellipsoid,
  height_pressure,
  heading,
  pitch,
  roll,
  id,
  utc_offset  ///< of local times: "-04:00"
};

/// Name of a column's meaning in --columns.
const char* roleOf(Column column);

struct TableColumn {
  std::size_t index = 0;
  double factor = 1;  ///< to metres, degrees or seconds
  bool has_unit = false;
  DateOrder order = DateOrder::unknown;  ///< of dates
  double day_of_1970 = 0;                ///< number of that day, for a column of numbered days; 0: of none
  double begin_s = 0;                    ///< of a column of seconds, since 1970; 0: that of the numbers
  bool is_degrees_minutes = false;       ///< of coordinates: DDMM.mmmm
};
using Columns = std::map<Column, TableColumn>;

std::vector<std::string> cellsOf(std::string_view line, char separator);
/// The separator of a header line: comma, semicolon or tab.
char separatorOf(std::string_view line);

/// Factor to metres, degrees or seconds of a unit as columns name it; none: it is not known.
std::optional<double> factorOfUnit(const std::string& unit);

/// The columns of a header by common names, among them those of the OpenSky network, Flightradar24, of AIS
/// archives and of logs of drones.
Columns columnsByName(const std::vector<std::string>& header);
/// @param map  "latitude=Breite,height=Hoehe:ft,time=Zeit:dmy". What a map without a time or a position does
/// not tell is known by common names.
/// @throws Error (usage)
Columns columnsByMap(const std::vector<std::string>& header, const std::string& map);

/// What a height is above by its name, for messages: "the ground" or "the take-off point"; empty: the name
/// says neither, or is not of a height.
std::string localDatumOf(const std::string& name);

/// True for a line of the BaseStation format, which has no header: MSG,3,...
bool isBaseStation(std::string_view line);
Columns columnsOfBaseStation();

}  // namespace emscape::interop
