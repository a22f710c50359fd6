#include "emfield/grid_columns.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

Vec3d footEcef(GeodeticPosition position) {
  position.height_ellipsoid_m = 0;
  return toEcef(position);
}

GridColumn verticalColumn(const GeoFrame& frame, const Vec3d& base_m) {
  const GeodeticPosition base = frame.toGeodetic(base_m);
  GridColumn column;
  column.base_ecef_m = toEcef(base);
  column.foot_ecef_m = footEcef(base);
  GeodeticPosition above = base;
  above.height_ellipsoid_m += 1e6;
  column.axis = normalized(toEcef(above) - column.base_ecef_m);
  column.foot_drift = {0, 0, 0};
  column.height_msl_m[0] = 0;
  column.height_msl_m[1] = 1;
  column.height_msl_m[2] = 0;
  return column;
}

/// Exact at the column's lower end, middle and upper end; a parabola between.
GridColumn tiltedColumn(const GeoFrame& frame, const Vec3d& base_m, double upper_m) {
  const Vec3d middle_m{base_m.x, base_m.y, base_m.z + 0.5 * upper_m};
  const Vec3d top_m{base_m.x, base_m.y, base_m.z + upper_m};
  const GeodeticPosition base = frame.toGeodetic(base_m), top = frame.toGeodetic(top_m);
  GridColumn column;
  column.base_ecef_m = toEcef(base);
  column.axis = normalized(toEcef(top) - column.base_ecef_m);
  column.foot_ecef_m = footEcef(base);
  column.foot_drift = (footEcef(top) - column.foot_ecef_m) / upper_m;
  const double low = frame.heightMsl_m(base_m), middle = frame.heightMsl_m(middle_m),
               high = frame.heightMsl_m(top_m);
  column.height_msl_m[0] = low;
  column.height_msl_m[1] = (4 * middle - high - 3 * low) / upper_m;
  column.height_msl_m[2] = 2 * (high - 2 * middle + low) / (upper_m * upper_m);
  return column;
}

double groundBelow(const scenario::Terrain& terrain, const GridColumn& column, double t_m) {
  const GeodeticPosition foot = fromEcef(column.foot_ecef_m + column.foot_drift * t_m);
  return terrain.heightMsl_m(foot.latitude_deg, foot.longitude_deg);
}

}  // namespace

double tiltOf(const GridColumns& columns) {
  if (!columns.tilted) return 0;
  const double half_height_m = 0.5 * (columns.t_m.back() - columns.t_m.front());
  double drift = 0;
  for (const GridColumn& column : columns.columns) drift = std::max(drift, length(column.foot_drift));
  return drift * half_height_m;
}

GridColumns makeGridColumns(const volume::Grid& grid, const scenario::Terrain* terrain) {
  const GeoFrame frame(grid.frame);
  GridColumns result;
  result.dims = grid.dims;
  result.tilted = grid.frame.kind == FrameKind::enu;
  const int column_count = grid.dims.x * grid.dims.y;
  result.columns.resize(column_count);
  for (int k = 0; k < grid.dims.z; ++k) result.t_m.push_back(static_cast<float>(grid.center_m(0, 0, k).z));
  if (terrain != nullptr) {
    result.ground_msl_m.resize(column_count);
    result.first_valid_k.assign(column_count, 0);
  }

  parallelFor(grid.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < grid.dims.x; ++i) {
        const std::size_t c = static_cast<std::size_t>(j) * grid.dims.x + i;
        const Vec3d center = grid.center_m(i, j, 0);
        const Vec3d base_m{center.x, center.y, 0};
        GridColumn& column = result.columns[c];
        column =
            result.tilted ? tiltedColumn(frame, base_m, grid.upper_m().z) : verticalColumn(frame, base_m);
        if (terrain == nullptr) continue;
        double ground = groundBelow(*terrain, column, result.t_m.front());
        result.ground_msl_m[c] = static_cast<float>(ground);
        int k = 0;
        while (k < grid.dims.z && !(heightMsl_m(column, result.t_m[k]) >= ground)) {
          ++k;
          if (result.tilted && k < grid.dims.z) ground = groundBelow(*terrain, column, result.t_m[k]);
        }
        result.first_valid_k[c] = static_cast<std::uint16_t>(k);
      }
    }
  });

  for (std::size_t c = 0; c < result.ground_msl_m.size(); ++c) {
    if (!std::isnan(result.ground_msl_m[c])) continue;
    if (result.first_hole < 0) result.first_hole = static_cast<long long>(c);
    ++result.hole_columns;
  }
  return result;
}

}  // namespace emscape::emfield
