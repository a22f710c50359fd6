/// Where a column of the grid lies as seen from an emitter: what the loops over voxels start from.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "emfield/fan_coordinates.h"
#include "emfield/grid_columns.h"
#include "emfield/station.h"

namespace emscape::emfield {

/// Numbers that columnGeometry() gives, in the order of ColumnGeometryView.
constexpr int kColumnNumbers = 9;

/// @param coordinates  of the column's foot below its middle
/// @param middle_m     z of the middle
/// @param out          out[n * stride], n below kColumnNumbers
EMSCAPE_HD inline void columnGeometry(const Station& station, const GridColumn& column,
                                      const FanCoordinates& coordinates, double middle_m, float* out,
                                      std::size_t stride) {
  const Vec3d& up = station.geodesy.station.up;
  const Vec3d base = column.base_ecef_m - station.ecef_m;
  const double nearest_t_m = -dot(base, column.axis);
  const Vec3d offset = base + column.axis * nearest_t_m;
  const Vec3d middle = base + column.axis * middle_m;
  const double level_m = std::hypot(dot(middle, station.geodesy.east), dot(middle, station.geodesy.north));
  const double numbers[kColumnNumbers] = {dot(base, station.geodesy.east),
                                          dot(base, station.geodesy.north),
                                          dot(base, up),
                                          dot(column.axis, station.geodesy.east),
                                          dot(column.axis, station.geodesy.north),
                                          dot(column.axis, up),
                                          dot(offset, offset),
                                          nearest_t_m,
                                          refractionLift_m(station, coordinates.range_m, level_m)};
  for (int n = 0; n < kColumnNumbers; ++n) out[n * stride] = static_cast<float>(numbers[n]);
}

}  // namespace emscape::emfield
