/// Lengths and speeds in the units in which they are shown; files and results have SI units.
#pragma once

#include <string>

#include "emscape/base/units.h"

namespace emscape {

/// A unit and the value of 1 in SI units.
struct DisplayUnit {
  const char* name;
  double factor;
};
DisplayUnit distanceUnit(Units units);  ///< km, NM
DisplayUnit heightUnit(Units units);    ///< m, ft

/// "850 m", "12.3 km", "160 km"; "0.46 NM", "86.4 NM".
std::string distanceText(double distance_m, Units units);
/// A distance that is round in the unit: "10 km", "500 m", "0.5 NM".
std::string roundDistanceText(double distance_m, Units units);
/// "250 m", "820 ft".
std::string heightText(double height_m, Units units);

}  // namespace emscape
