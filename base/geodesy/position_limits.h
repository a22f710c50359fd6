/// Limits of positions in files.
#pragma once

namespace emscape {

struct PositionLimits {
  static constexpr double kLatitude_deg = 90;                       ///< largest, north and south
  static constexpr double kLongitude_deg = 180;                     ///< largest, east and west
  static constexpr double kLowest_m = -12000, kHighest_m = 100000;  ///< above sea level or the ellipsoid
};

}  // namespace emscape
