/// Ground distance and azimuth from a station to the points of a grid.
#pragma once

#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"

namespace emscape::emfield {

/// From the station to the point of the ellipsoid below a column's point at t (m).
EMSCAPE_HD inline FastInverse footInverse(const Station& station, const GridColumn& column, double t_m) {
  return fastInverse(station.geodesy, column.foot_ecef_m + column.foot_drift * t_m);
}

}  // namespace emscape::emfield
