/// Geometry of the grid's columns relative to an emitter: the input of the loops over voxels.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "emfield/columns/excess_code.h"
#include "emfield/columns/foot_inverse.h"
#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"
#include "emfield/columns/two_rays.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

/// Column arrays, x fastest. In the emitter's east-north-up axes a voxel at z = t is at b + t d.
struct ColumnGeometryView {
  const float* base_east_m = nullptr;
  const float* base_north_m = nullptr;
  const float* base_up_m = nullptr;
  const float* axis_east = nullptr;
  const float* axis_north = nullptr;
  const float* axis_up = nullptr;
  /// Squared distance (m2) of the emitter from the column's line, and t (m) of the nearest point of the line:
  /// the squared distance is offset2 + (t - nearest)^2, without cancellation at any distance.
  const float* offset2_m2 = nullptr;
  const float* nearest_t_m = nullptr;
  /// Added to the straight line's rise (m) so that it points along the start of the refracted ray.
  /// @accuracy launch angle within 0.001 degree to 500 km and 10 km of height; it is computed at the column's
  /// middle
  const float* lift_m = nullptr;
  /// Voxels below this z (m) are in shadow; -infinity: none is. NaN: unknown.
  const float* shadow_edge_m = nullptr;
  /// Excess loss of each voxel; empty: none.
  ExcessView excess;
  /// Reflected ray of each voxel, dense order; null: the model has none.
  const ReflectedRayCode* reflected = nullptr;
  /// Mechanism of each voxel (propagation::Mechanism), dense order; null: the model has only one, or it is
  /// not needed.
  const std::uint8_t* mechanisms = nullptr;
};

/// Numbers per column from columnGeometry(), in the order of ColumnGeometryView.
constexpr int kColumnNumbers = 9;

/// @param numbers  kColumnNumbers x columns, as columnGeometry() fills them
EMSCAPE_HD inline ColumnGeometryView columnGeometryView(const float* numbers, std::size_t columns,
                                                        const float* shadow_edge_m, const ExcessView& excess,
                                                        const ReflectedRayCode* reflected,
                                                        const std::uint8_t* mechanisms) {
  const auto array = [&](std::size_t n) { return numbers + n * columns; };
  return {array(0), array(1), array(2),      array(3), array(4),  array(5),  array(6),
          array(7), array(8), shadow_edge_m, excess,   reflected, mechanisms};
}

/// @param foot         footInverse() of the column's middle
/// @param middle_m     z of the middle
/// @param out          out[n * stride], n below kColumnNumbers
EMSCAPE_HD inline void columnGeometry(const Station& station, const GridColumn& column,
                                      const FastInverse& foot, double middle_m, float* out,
                                      std::size_t stride) {
  const Vec3d& up = station.geodesy.station.up;
  const Vec3d base = column.base_ecef_m - station.ecef_m;
  const double nearest_t_m = -dot(base, column.axis);
  const Vec3d offset = base + column.axis * nearest_t_m;
  const auto liftAt = [&](double t_m) {
    const Vec3d point = base + column.axis * t_m;
    const double east_m = dot(point, station.geodesy.east), north_m = dot(point, station.geodesy.north);
    const double level_m = std::sqrt(east_m * east_m + north_m * north_m);
    return refractionLift_m(station, foot.distance_m, level_m, heightMsl_m(column, t_m));
  };
  const double lift_m = liftAt(middle_m);
  // In an exponential atmosphere the lift falls with height, which turns the column's line.
  double lift_rise = 0;
  if (station.refraction.exponential && middle_m != 0) {
    lift_rise = (liftAt(1.5 * middle_m) - liftAt(0.5 * middle_m)) / middle_m;
  }
  const double numbers[kColumnNumbers] = {dot(base, station.geodesy.east),
                                          dot(base, station.geodesy.north),
                                          dot(base, up) - lift_rise * middle_m,
                                          dot(column.axis, station.geodesy.east),
                                          dot(column.axis, station.geodesy.north),
                                          dot(column.axis, up) + lift_rise,
                                          dot(offset, offset),
                                          nearest_t_m,
                                          lift_m};
  for (int n = 0; n < kColumnNumbers; ++n) out[n * stride] = static_cast<float>(numbers[n]);
}

}  // namespace emscape::emfield
