#include "base/geodesy/position_text.h"

#include <fmt/format.h>

#include <GeographicLib/DMS.hpp>
#include <GeographicLib/GeoCoords.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"

namespace emscape {
namespace {

constexpr std::size_t kMaxText = 200;
constexpr double kMaxHeight_m = 1e6;

bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}
bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

const char* hemisphereOf(double degrees, bool is_latitude) {
  if (is_latitude) return degrees < 0 ? "S" : "N";
  return degrees < 0 ? "W" : "E";
}

/// Degrees, minutes and seconds, rounded to units of 1 / parts_per_degree.
std::string sexagesimal(double degrees, bool is_latitude, long long parts_per_degree) {
  const long long parts = std::llround(std::abs(degrees) * static_cast<double>(parts_per_degree));
  const long long whole = parts / parts_per_degree, rest = parts % parts_per_degree;
  const char* const side = hemisphereOf(parts == 0 ? 0 : degrees, is_latitude);
  if (parts_per_degree == 1) return fmt::format("{}°{}", whole, side);
  const long long per_minute = parts_per_degree / 60;
  std::string text = fmt::format("{}°{:02}'", whole, rest / per_minute);
  if (per_minute == 60) text += fmt::format("{:02}\"", rest % per_minute);
  if (per_minute == 600) text += fmt::format("{:04.1f}\"", static_cast<double>(rest % per_minute) / 10);
  return text + side;
}

std::string decimalText(double degrees, bool is_latitude, int decimals) {
  const double scale = std::pow(10.0, decimals);
  const double rounded = std::round(degrees * scale) / scale;
  return fmt::format("{:.{}f}°{}", std::abs(rounded), decimals, hemisphereOf(rounded, is_latitude));
}

std::string mgrsText(double latitude_deg, double longitude_deg) {
  constexpr int kMetres = 0;  // precision of MGRSRepresentation()
  std::string text = GeographicLib::GeoCoords(latitude_deg, longitude_deg).MGRSRepresentation(kMetres);
  constexpr std::size_t kDigits = 5;
  if (text.size() < 2 * kDigits) return text;
  text.insert(text.size() - kDigits, " ");
  text.insert(text.size() - 2 * kDigits - 1, " ");
  constexpr std::size_t kSquare = 2;  // letters
  if (isDigit(text[0])) text.insert(text.find(' ') - kSquare, " ");
  return text;
}

std::string trimmed(const std::string& text) {
  const auto begin = std::find_if_not(text.begin(), text.end(), isSpace);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), isSpace).base();
  return begin < end ? std::string(begin, end) : "";
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// The text without spaces, if it is a reference of MGRS: zone, band, square, and digits, or of the poles. A
/// reference to a square of less than 1 km is not meant by "16S".
std::string mgrsReference(const std::string& text) {
  std::string joined;
  for (const char c : text) {
    if (!isSpace(c)) joined += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  std::size_t at = 0;
  while (at < joined.size() && at < 2 && isDigit(joined[at])) ++at;
  const std::size_t letters = at;
  while (at < joined.size() && std::isalpha(static_cast<unsigned char>(joined[at])) != 0) ++at;
  if (at - letters != 3) return "";
  const bool are_digits =
      std::all_of(joined.begin() + static_cast<std::ptrdiff_t>(at), joined.end(), isDigit);
  return are_digits && at < joined.size() ? joined : "";
}

bool isHemisphere(char c) {
  return std::string("NSEW").find(static_cast<char>(std::toupper(static_cast<unsigned char>(c)))) !=
         std::string::npos;
}

void replaceSigns(std::string& text) {
  for (const char* const sign : {"′", "’", "´"}) replaceAll(text, sign, "'");
  for (const char* const sign : {"″", "”", "''"}) replaceAll(text, sign, "\"");
  for (const char* const sign : {"°", "º", "˚"}) replaceAll(text, sign, "d");
  replaceAll(text, "−", "-");
}

/// Latitude and longitude as GeographicLib reads them: spaces only between the two.
std::string joinedCoordinates(std::string text) {
  replaceSigns(text);
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!isSpace(text[i])) {
      joined += text[i];
      continue;
    }
    const std::size_t next = text.find_first_not_of(" \t\r\n\f\v", i);
    if (next == std::string::npos) break;
    const char before = joined.empty() ? ' ' : joined.back(), after = text[next];
    const char first = joined.empty() ? ' ' : joined[joined.find_last_of(" ,") + 1];  // of this coordinate
    const bool ends_with_side =
        isHemisphere(after) && !isHemisphere(first) && (next + 1 == text.size() || !isDigit(text[next + 1]));
    const bool begins_with_side =
        isHemisphere(before) &&
        (joined.size() == 1 || std::string(" ,").find(*(joined.end() - 2)) != std::string::npos);
    const bool is_within = (begins_with_side && isDigit(after)) || (before == 'd' && isDigit(after)) ||
                           (before == '\'' && isDigit(after)) ||
                           (ends_with_side && std::string("d'\"").find(before) != std::string::npos) ||
                           (ends_with_side && isDigit(before));
    if (!is_within) joined += ' ';
    i = next - 1;
  }
  return joined;
}

/// A position in UTM: zone with a letter, easting and northing (m).
struct Utm {
  std::string zone, easting, northing;
  char letter = ' ';  ///< of the hemisphere or MGRS's band, in upper case
  bool is_zone_first = true;

  std::string text(const std::string& side) const {
    const std::string whole = zone + side;
    return is_zone_first ? whole + " " + easting + " " + northing : easting + " " + northing + " " + whole;
  }
};

/// Reads "19T 316175 4904508", "19 T 316175.0 m E 4904508.0 m N", "316175 4904508 19T"; none for other texts.
std::optional<Utm> utmOf(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  const auto isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  if (words.size() > 3 && words[1].size() == 1 && isLetter(words[1][0]) && isDigit(words[0].back())) {
    words[0] += words[1];
    words.erase(words.begin() + 1);
  }
  std::vector<std::string> parts;  // without the units and directions of the distances
  for (const std::string& word : words) {
    const std::size_t end = word.find_last_not_of("mEN") + 1;
    if (parts.empty() || end > 2)
      parts.push_back(parts.empty() ? word : word.substr(0, end));
    else if (end > 0)
      parts.push_back(word);
  }
  if (parts.size() != 3) return std::nullopt;
  Utm utm;
  utm.is_zone_first = isLetter(parts[0].back());
  const std::string& zone = parts[utm.is_zone_first ? 0 : 2];
  utm.zone = zone.substr(0, zone.size() - 1);
  utm.letter = static_cast<char>(std::toupper(static_cast<unsigned char>(zone.back())));
  utm.easting = parts[utm.is_zone_first ? 1 : 0];
  utm.northing = parts[utm.is_zone_first ? 2 : 1];
  const auto isNumber = [](const std::string& number) {
    return number.find_first_not_of("0123456789.") == std::string::npos;
  };
  const bool is_zone = isLetter(utm.letter) && !utm.zone.empty() && utm.zone.size() <= 2 &&
                       std::all_of(utm.zone.begin(), utm.zone.end(), isDigit);
  return is_zone && isNumber(utm.easting) && isNumber(utm.northing) ? std::optional(utm) : std::nullopt;
}

/// As GeographicLib reads it. The letters of MGRS's bands tell the hemisphere, but for S, which is also
/// south: "16S 733000 4043000" with a northing of the band S, 32 to 40 degrees north, is refused. Other
/// northings are south of the equator.
std::string clearUtm(const Utm& utm) {
  constexpr double kBandBegin_m = 3.53e6, kBandEnd_m = 4.44e6;
  const double north_m = std::strtod(utm.northing.c_str(), nullptr);
  if (utm.letter == 'S' && north_m > kBandBegin_m && north_m < kBandEnd_m) {
    throw Error(
        ErrorCode::usage,
        fmt::format("in '{}' {} may be MGRS's band, 32 to 40 degrees north, or south "
                    "of the equator; write '{}' or '{}'",
                    utm.text(std::string(1, utm.letter)), utm.letter, utm.text("north"), utm.text("south")));
  }
  const bool is_band = std::string("CDEFGHJKLMPQRTUVWX").find(utm.letter) != std::string::npos;
  return utm.text(is_band ? (utm.letter < 'N' ? "south" : "north") : std::string(1, utm.letter));
}

/// True if a word has more than degrees, minutes and seconds: GeographicLib writes beyond its arrays there.
bool hasTooManyParts(const std::string& text) {
  constexpr int kParts = 3;
  int marks = 0;
  for (const char c : text) {
    if (c == ' ' || c == ',') marks = 0;
    marks += std::string("dD'\":").find(c) != std::string::npos ? 1 : 0;
    if (marks > kParts) return true;
  }
  return false;
}

/// None if it is not a position.
std::optional<ParsedPosition> parseHorizontal(const std::string& text) {
  const std::string reference = mgrsReference(text);
  const std::optional<Utm> utm = reference.empty() ? utmOf(text) : std::nullopt;
  const std::string coordinates = utm                 ? clearUtm(*utm)
                                  : reference.empty() ? joinedCoordinates(text)
                                                      : reference;
  // One word alone would be a zone of MGRS: an area of hundreds of kilometres.
  if (reference.empty() && coordinates.find_first_of(" ,") == std::string::npos) return std::nullopt;
  if (hasTooManyParts(coordinates)) return std::nullopt;
  try {
    const GeographicLib::GeoCoords read(coordinates);
    if (!std::isfinite(read.Latitude()) || !std::isfinite(read.Longitude())) return std::nullopt;
    return ParsedPosition{read.Latitude(), wrapLongitude_deg(read.Longitude()), {}};
  } catch (const GeographicLib::GeographicErr&) {
    return std::nullopt;
  }
}

std::optional<double> parseHeight(const std::string& text) {
  const std::string number = trimmed(text);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  const bool is_height = !number.empty() && *end == '\0' && std::abs(value) <= kMaxHeight_m;
  return is_height ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string positionText(double latitude_deg, double longitude_deg, PositionFormat format) {
  if (!(std::abs(latitude_deg) <= 90) || !std::isfinite(longitude_deg)) return "invalid position";
  const double longitude = wrapLongitude_deg(longitude_deg);
  constexpr int kDecimals = 5;
  constexpr long long kTenthsOfSeconds = 36000;
  switch (format) {
    case PositionFormat::mgrs:
      return mgrsText(latitude_deg, longitude);
    case PositionFormat::dms:
      return sexagesimal(latitude_deg, true, kTenthsOfSeconds) + " " +
             sexagesimal(longitude, false, kTenthsOfSeconds);
    case PositionFormat::decimal:
      break;
  }
  return decimalText(latitude_deg, true, kDecimals) + " " + decimalText(longitude, false, kDecimals);
}

std::string coordinateText(double degrees, bool is_latitude, PositionFormat format, double step_deg) {
  const auto isMultiple = [step_deg](double unit_deg) {
    const double units = step_deg / unit_deg;
    return std::abs(units - std::round(units)) < 1e-6 && units > 0.5;
  };
  if (format == PositionFormat::dms)
    return sexagesimal(degrees, is_latitude, isMultiple(1) ? 1 : (isMultiple(1.0 / 60) ? 60 : 3600));
  int decimals = 0;
  while (decimals < 6 && !isMultiple(std::pow(10.0, -decimals))) ++decimals;
  return decimalText(degrees, is_latitude, decimals);
}

ParsedPosition parsePosition(const std::string& text) {
  const std::string whole = trimmed(text);
  if (!whole.empty() && whole.size() <= kMaxText) {
    const std::size_t comma = whole.rfind(',');
    if (comma != std::string::npos) {
      const std::optional<double> height_m = parseHeight(whole.substr(comma + 1));
      std::optional<ParsedPosition> position =
          height_m ? parseHorizontal(trimmed(whole.substr(0, comma))) : std::nullopt;
      if (position) {
        position->height_m = height_m;
        return *position;
      }
    }
    if (const std::optional<ParsedPosition> position = parseHorizontal(whole)) return *position;
  }
  throw Error(ErrorCode::usage,
              "'" + whole.substr(0, kMaxText) +
                  "' is not a position such as 36.5,-84.2 or 36.5N 84.2W or "
                  "36°30'12\"N 84°12'W or 16S GF 12345 67890 or, in UTM, 19T 316175 4904508");
}

std::optional<double> parseCoordinate(const std::string& text, bool is_latitude) {
  using GeographicLib::DMS;
  std::string coordinate = trimmed(text);
  if (coordinate.empty() || coordinate.size() > kMaxText) return std::nullopt;
  replaceSigns(coordinate);
  std::string joined;  // with colons between degrees, minutes and seconds
  int colons = 0;
  for (std::size_t i = 0; i < coordinate.size(); ++i) {
    if (!isSpace(coordinate[i])) {
      joined += coordinate[i];
    } else if (!joined.empty() && isDigit(joined.back()) && isDigit(coordinate[i + 1])) {
      joined += ':';
      ++colons;
    }
  }
  // Two numbers without a direction are a position, and GeographicLib would add signed ones.
  const bool has_direction = !joined.empty() && (isHemisphere(joined.front()) || isHemisphere(joined.back()));
  if ((colons == 1 && !has_direction) || joined.find_first_of("+-", 1) != std::string::npos ||
      hasTooManyParts(joined)) {
    return std::nullopt;
  }
  try {
    DMS::flag kind = DMS::NONE;
    const double degrees = DMS::Decode(joined, kind);
    const bool is_other = kind == (is_latitude ? DMS::LONGITUDE : DMS::LATITUDE);
    return is_other || !std::isfinite(degrees) ? std::nullopt : std::optional(static_cast<double>(degrees));
  } catch (const GeographicLib::GeographicErr&) {
    return std::nullopt;
  }
}

}  // namespace emscape
