/// The columns of a grid on the earth; the same for every emitter.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/geodesy/fast_geodesy.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/host_device.h"
#include "emscape/base/unset_vector.h"
#include "emscape/base/vec.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/grid.h"

namespace emscape::emfield {

/// One column of voxels: the line base + t * axis, where t is the frame's z (m). For surfaces t is the height
/// (Surface::heights_m), and base the point with t = 0.
struct GridColumn {
  Vec3d base_ecef_m;       ///< at t = 0
  Vec3d axis;              ///< unit vector of growing t
  Vec3d foot_ecef_m;       ///< point of the ellipsoid below t = 0
  Vec3d foot_drift;        ///< displacement of the foot per metre of t; zero in the altitude frame
  double height_msl_m[3];  ///< height above mean sea level = h0 + h1 t + h2 t^2
};

/// Heights of a column's points above mean sea level at t (m).
EMSCAPE_HD inline double heightMsl_m(const GridColumn& column, double t_m) {
  return column.height_msl_m[0] + t_m * (column.height_msl_m[1] + t_m * column.height_msl_m[2]);
}

/// A vertical column above a position of a surface, in a third of the memory.
struct PositionColumn {
  Vec3d foot_ecef_m;                    ///< point of the ellipsoid below
  double base_ellipsoid_m, base_msl_m;  ///< heights of t = 0
};

EMSCAPE_HD inline double heightMsl_m(const PositionColumn& column, double t_m) {
  return column.base_msl_m + t_m;
}
EMSCAPE_HD inline GridColumn gridColumn(const PositionColumn& column) {
  const Vec3d& foot = column.foot_ecef_m;
  const Vec3d up = normalized(Vec3d{foot.x, foot.y, foot.z / (1 - kWgs84EccentricitySquared)});
  return {foot + up * column.base_ellipsoid_m, up, foot, {0, 0, 0}, {column.base_msl_m, 1, 0}};
}

/// Columns as plain data: one of the two kinds.
struct ColumnsView {
  const GridColumn* of_grid = nullptr;
  const PositionColumn* of_surface = nullptr;

  EMSCAPE_HD GridColumn operator[](std::size_t c) const {
    return of_grid != nullptr ? of_grid[c] : gridColumn(of_surface[c]);
  }
};

namespace cuda {
struct DevicePositions;  // emfield/cuda/device_positions.h
}

/// All columns of a grid, x fastest. Immutable once made.
struct GridColumns {
  Dims dims;
  bool tilted = false;        ///< columns are not vertical (enu frame)
  bool every_height = false;  ///< models do not interpolate between layers
  /// The distance of any column from any point is at most the largest distance of these columns plus
  /// beyond_outline_m (along the ground).
  std::vector<GridColumn> outline;
  double beyond_outline_m = 0;
  double lowest_msl_m = HUGE_VAL, highest_msl_m = -HUGE_VAL;  ///< of the columns' points
  std::vector<GridColumn> of_grid;                            ///< or, of a surface:
  UnsetVector<PositionColumn> of_surface;  ///< positions that are left out have the column of the outline
  /// Or, of a surface, its columns and ground in the memory of the GPU; of_surface and ground_msl_m are
  /// empty.
  std::shared_ptr<const cuda::DevicePositions> on_device;
  std::vector<float> t_m;           ///< z of each layer
  std::vector<float> ground_msl_m;  ///< ground below each column (m); NaN over holes; empty without terrain
  std::vector<std::uint16_t>
      first_valid_k;  ///< lowest layer whose centre is not below ground, nor, without terrain, below mean sea
                      ///< level; dims.z over holes and if left out; empty: 0
  long long hole_columns = 0;
  /// A column over a hole, for messages; -1 if there is none.
  long long first_hole = -1;

  ColumnsView view() const {
    return {of_grid.empty() ? nullptr : of_grid.data(), of_surface.empty() ? nullptr : of_surface.data()};
  }
  std::size_t count() const { return static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y); }
  /// Of the columns, in host or device memory.
  std::size_t bytes() const {
    return count() * (of_grid.empty() ? sizeof(PositionColumn) : sizeof(GridColumn));
  }
  /// z of the middle between the lowest and the highest layer.
  double middle_m() const { return 0.5 * (t_m.front() + t_m.back()); }
};

/// Largest ground distance (m) of a point of a column from its middle; 0 for vertical columns.
double tiltOf(const GridColumns& columns);

/// @param terrain  null: the ground is at mean sea level
/// @accuracy enu: heights along a column within 1 mm, its foot within 1 m, for regions to 500 km
GridColumns makeGridColumns(const volume::Grid& grid, const scenario::Terrain* terrain);
/// The same for a surface. dims: width, height, number of heights.
GridColumns makeGridColumns(const Surface& surface, const scenario::Terrain* terrain);

}  // namespace emscape::emfield
