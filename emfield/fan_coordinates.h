/// Polar coordinates of the grid's points about a station: azimuth and ground range.
#pragma once

#include <vector>

#include "emfield/grid_columns.h"
#include "emfield/station.h"

namespace emscape::emfield {

/// Azimuth (rad, 0..2 pi) and ground range (m) of a point of the ellipsoid.
struct FanCoordinates {
  double azimuth_rad = 0;
  double range_m = 0;
};

EMSCAPE_HD inline FanCoordinates fanCoordinates(const Station& station, const Vec3d& foot_ecef_m) {
  const FastInverse inverse = fastInverse(station.geodesy, foot_ecef_m);
  double azimuth = std::atan2(inverse.sin_azimuth, inverse.cos_azimuth);
  if (azimuth < 0) azimuth += 2 * kPi;
  return {azimuth, inverse.distance_m};
}

/// The same for a column's foot below t (m).
EMSCAPE_HD inline FanCoordinates fanCoordinates(const Station& station, const GridColumn& column,
                                                double t_m) {
  return fanCoordinates(station, column.foot_ecef_m + column.foot_drift * t_m);
}

/// Fan coordinates of every column's foot at the middle of the grid's height, x fastest.
std::vector<FanCoordinates> fanCoordinates(const Station& station, const GridColumns& columns);

}  // namespace emscape::emfield
