/// Positions as text: decimal degrees, degrees with minutes and seconds, and MGRS.
#pragma once

#include <optional>
#include <string>

#include "emscape/base/units.h"

namespace emscape {

/// A position to about a metre.
/// @param latitude_deg  -90..90, longitude_deg any; else "invalid position"
std::string positionText(double latitude_deg, double longitude_deg,
                         PositionFormat format = PositionFormat::decimal);

/// One coordinate, "84.2°W" or "84°12'W", with the decimals or the parts that a step needs (labels of
/// meridians and parallels).
/// @param format  mgrs: as decimal  @param step_deg  distance of the labels, > 0
std::string coordinateText(double degrees, bool is_latitude, PositionFormat format, double step_deg);

struct ParsedPosition {
  double latitude_deg = 0, longitude_deg = 0;
  std::optional<double> height_m;
};

/// Reads a position in one of the forms of positionText() and in the usual variants of them: "36.5, -84.2",
/// "36.5N 84.2W", "36°30'12\"N 84°12'W", "36d30'12\"N, 84d12'W", "16S GF 12345 67890", UTM as "16n 733000
/// 4043000" or "16north 733000 4043000"; a zone's S with a northing of MGRS's band S is refused. A comma and
/// a number (m) may follow as height. Two numbers without letters are latitude and longitude.
/// @throws Error (usage) that states the forms
ParsedPosition parsePosition(const std::string& text);

/// Reads one coordinate: "84.2", "84.2W", "84°12'W", "84 12.5 W", "84 12 0". @return none for another text,
/// and for a letter of the other coordinate
std::optional<double> parseCoordinate(const std::string& text, bool is_latitude);

}  // namespace emscape
