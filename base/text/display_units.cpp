#include "base/text/display_units.h"

#include <fmt/format.h>

#include <cmath>

namespace emscape {
namespace {

/// Three digits, all of those before the decimal point.
std::string threeDigits(double value) {
  const double size = std::abs(value);
  return fmt::format("{:.{}f}", value, size >= 99.95 ? 0 : (size >= 9.995 ? 1 : 2));
}

}  // namespace

DisplayUnit distanceUnit(Units units) {
  return units == Units::metric ? DisplayUnit{"km", 1000} : DisplayUnit{"NM", 1852};
}
DisplayUnit heightUnit(Units units) {
  return units == Units::metric ? DisplayUnit{"m", 1} : DisplayUnit{"ft", 0.3048};
}

std::string distanceText(double distance_m, Units units) {
  if (units == Units::metric && std::abs(distance_m) < 999.5) return fmt::format("{:.0f} m", distance_m);
  const DisplayUnit unit = distanceUnit(units);
  return threeDigits(distance_m / unit.factor) + " " + unit.name;
}

std::string roundDistanceText(double distance_m, Units units) {
  if (units == Units::metric && std::abs(distance_m) < 1000) return fmt::format("{:g} m", distance_m);
  const DisplayUnit unit = distanceUnit(units);
  double distance = distance_m / unit.factor;
  // Of a distance that is round in metres only what matters is shown.
  const double part = std::abs(distance) < 1 ? 0.01 : 0.1;
  if (units != Units::metric) distance = std::round(distance / part) * part;
  return fmt::format("{:.4g} {}", distance, unit.name);
}

std::string heightText(double height_m, Units units) {
  const DisplayUnit unit = heightUnit(units);
  return fmt::format("{:.0f} {}", height_m / unit.factor, unit.name);
}

}  // namespace emscape
