#include "emfield/columns/grid_columns.h"

#include <algorithm>
#include <cmath>

#include "base/geodesy/geoid_grid.h"
#include "base/large_array.h"
#include "emfield/columns/foot_inverse.h"
#include "emfield/columns/position_columns.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"

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

/// GeoidCells for many positions: keeps the cells.
class NearGeoid {
 public:
  double operator()(double latitude_deg, double longitude_deg) {
    const double i = std::floor(longitude_deg * GeoidCell::kPerDegree);
    const double j = std::floor(latitude_deg * GeoidCell::kPerDegree);
    GeoidCell& cell = cells_[static_cast<unsigned>(static_cast<long long>(i)) % kKept];
    if (cell.i != i || cell.j != j) cell = GeoidCell::at(geoid_, i, j);
    return cell.undulation_m(latitude_deg, longitude_deg);
  }

 private:
  static constexpr int kKept = 128;  ///< cells of one row, which the next row of positions often needs again

  GeoidView geoid_ = egm96Grid().view();
  GeoidCell cells_[kKept];
};

/// Extends a range of heights by those of a column.
/// @param range  with lowest_msl_m and highest_msl_m
template <class Column, class Range>
void addHeights(const Column& column, const std::vector<float>& layers_m, Range& range) {
  for (const float t_m : {layers_m.front(), layers_m.back()}) {
    const double height_m = heightMsl_m(column, static_cast<double>(t_m));
    range.lowest_msl_m = std::min(range.lowest_msl_m, height_m);
    range.highest_msl_m = std::max(range.highest_msl_m, height_m);
  }
}

/// The farthest columns are at a grid's corners; the extreme heights are there or in its middle.
void setOutlineOfGrid(GridColumns& columns) {
  const Dims& dims = columns.dims;
  for (const int i : {0, dims.x / 2, dims.x - 1}) {
    for (const int j : {0, dims.y / 2, dims.y - 1}) {
      columns.outline.push_back(columns.of_grid[static_cast<std::size_t>(j) * dims.x + i]);
      addHeights(columns.outline.back(), columns.t_m, columns);
    }
  }
}

/// Positions that a thread processes together. Their sums are added in order, whichever thread computes them.
constexpr int kPositionsPart = 4096;

/// Calls visit(n, first, end) for all parts.
template <class Visit>
void visitParts(int positions, const Visit& visit) {
  parallelFor((positions + kPositionsPart - 1) / kPositionsPart, 1, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) {
      checkpoint();
      visit(n, n * kPositionsPart, std::min((n + 1) * kPositionsPart, positions));
    }
  });
}

/// Sets a circle around all positions with ground.
void setOutlineOfPositions(const Surface& surface, const std::vector<PositionsPart>& parts,
                           GridColumns& columns) {
  const PositionColumn middle = setMiddle(parts, !columns.ground_msl_m.empty(), columns);
  const auto positions = static_cast<int>(columns.of_surface.size());
  const auto distance2_m2 = [&](int c) {
    const bool is_hole = !columns.ground_msl_m.empty() && std::isnan(columns.ground_msl_m[c]);
    if (is_hole || isLeftOut(surface.positions[c])) return 0.0;
    const Vec3d chord = columns.of_surface[c].foot_ecef_m - middle.foot_ecef_m;
    return dot(chord, chord);
  };
  std::vector<double> farthest2_of_parts_m2(parts.size());
  visitParts(positions, [&](int n, int first, int end) {
    double farthest2_m2 = 0;
    for (int c = first; c < end; ++c) {
      farthest2_m2 = std::max(farthest2_m2, distance2_m2(c));
      if (isLeftOut(surface.positions[c])) columns.of_surface[c] = middle;
    }
    farthest2_of_parts_m2[n] = farthest2_m2;
  });
  // The earth's radii differ by less than 1.5 %, and the arcs over one chord by much less.
  constexpr double kNearlyFarthest2 = 0.97;
  const double near2_m2 =
      kNearlyFarthest2 * *std::max_element(farthest2_of_parts_m2.begin(), farthest2_of_parts_m2.end());
  const FastGeodesy geodesy = geodesyOf(middle);
  std::vector<double> beyond_of_parts_m(parts.size());
  visitParts(positions, [&](int n, int first, int end) {
    if (farthest2_of_parts_m2[n] < near2_m2) return;
    for (int c = first; c < end; ++c) {
      if (distance2_m2(c) < near2_m2) continue;
      beyond_of_parts_m[n] =
          std::max(beyond_of_parts_m[n], fastInverse(geodesy, columns.of_surface[c].foot_ecef_m).distance_m);
    }
  });
  columns.beyond_outline_m = *std::max_element(beyond_of_parts_m.begin(), beyond_of_parts_m.end());
}

void countHole(std::size_t c, GridColumns& columns) {
  if (columns.first_hole < 0) columns.first_hole = static_cast<long long>(c);
  ++columns.hole_columns;
}

double groundBelow(const scenario::Terrain& terrain, const GridColumn& column, double t_m) {
  const GeodeticPosition foot = fromEcef(column.foot_ecef_m + column.foot_drift * t_m);
  return terrain.heightMsl_m(foot.latitude_deg, foot.longitude_deg);
}

/// Sets first_valid_k, and with terrain the ground; without it the ground is at mean sea level.
void setGround(const scenario::Terrain* terrain, GridColumns& columns) {
  columns.first_valid_k.resize(columns.count());
  if (terrain != nullptr) columns.ground_msl_m.resize(columns.count());
  parallelFor(static_cast<int>(columns.count()), 1024, [&](int begin, int end) {
    checkpoint();
    for (int c = begin; c < end; ++c) {
      const GridColumn& column = columns.of_grid[c];
      const auto groundAt = [&](float t_m) {
        return terrain != nullptr ? groundBelow(*terrain, column, t_m) : 0.0;
      };
      double ground = groundAt(columns.t_m.front());
      if (terrain != nullptr) columns.ground_msl_m[c] = static_cast<float>(ground);
      int k = 0;
      while (k < columns.dims.z && !(heightMsl_m(column, columns.t_m[k]) >= ground)) {
        ++k;
        if (columns.tilted && k < columns.dims.z) ground = groundAt(columns.t_m[k]);
      }
      columns.first_valid_k[c] = static_cast<std::uint16_t>(k);
    }
  });
}

}  // namespace

double tiltOf(const GridColumns& columns) {
  if (!columns.tilted) return 0;
  const double half_height_m = 0.5 * (columns.t_m.back() - columns.t_m.front());
  double drift = 0;
  for (const GridColumn& column : columns.of_grid) drift = std::max(drift, length(column.foot_drift));
  return drift * half_height_m;
}

GridColumns makeGridColumns(const volume::Grid& grid, const scenario::Terrain* terrain) {
  const GeoFrame frame(grid.frame);
  GridColumns result;
  result.dims = grid.dims;
  result.tilted = grid.frame.kind == FrameKind::enu;
  const int column_count = grid.dims.x * grid.dims.y;
  resizeInParts(result.of_grid, static_cast<std::size_t>(column_count));
  for (int k = 0; k < grid.dims.z; ++k) result.t_m.push_back(static_cast<float>(grid.center_m(0, 0, k).z));
  parallelFor(grid.dims.y, 1, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      checkpoint();
      for (int i = 0; i < grid.dims.x; ++i) {
        const std::size_t c = static_cast<std::size_t>(j) * grid.dims.x + i;
        const Vec3d center = grid.center_m(i, j, 0);
        const Vec3d base_m{center.x, center.y, 0};
        GridColumn& column = result.of_grid[c];
        column =
            result.tilted ? tiltedColumn(frame, base_m, grid.upper_m().z) : verticalColumn(frame, base_m);
      }
    }
  });
  setOutlineOfGrid(result);
  if (terrain != nullptr || result.lowest_msl_m < 0) setGround(terrain, result);
  for (std::size_t c = 0; c < result.ground_msl_m.size(); ++c) {
    if (std::isnan(result.ground_msl_m[c])) countHole(c, result);
  }
  return result;
}

PositionTask positionTask(const Surface& surface, const scenario::Terrain* terrain) {
  PositionTask task;
  task.positions = surface.positions.data();
  task.offsets_m = surface.offsets_m.empty() ? nullptr : surface.offsets_m.data();
  task.heights_m = surface.heights_m.data();
  task.layers = static_cast<int>(surface.heights_m.size());
  task.above_ground = surface.reference == HeightReference::ground;
  task.has_terrain = terrain != nullptr;
  if (terrain != nullptr) task.terrain = terrain->view();
  return task;
}

GridColumns emptyColumns(const Surface& surface) {
  GridColumns columns;
  columns.every_height = true;
  columns.dims = {surface.width, surface.height, static_cast<int>(surface.heights_m.size())};
  for (const double height_m : surface.heights_m) columns.t_m.push_back(static_cast<float>(height_m));
  return columns;
}

PositionColumn setMiddle(const std::vector<PositionsPart>& parts, bool has_terrain, GridColumns& columns) {
  PositionsPart all;
  for (const PositionsPart& part : parts) all.add(part);
  if (length(all.feet) == 0) {
    throw Error(ErrorCode::bad_input,
                has_terrain ? "the terrain is missing below all places to compute the field over; 'terrain: "
                              "{missing: sea}' takes it as sea"
                            : "no positions at which to compute the field");
  }
  columns.lowest_msl_m = all.lowest_msl_m;
  columns.highest_msl_m = all.highest_msl_m;
  columns.hole_columns = all.holes;
  columns.first_hole = all.first_hole;
  const GeodeticPosition middle = fromEcef(all.feet * (kWgs84SemiMajor_m / length(all.feet)));
  const PositionColumn column{ellipsoidPoint_m(degToRad(middle.latitude_deg), degToRad(middle.longitude_deg)),
                              GeoidCells{egm96Grid().view()}(middle.latitude_deg, middle.longitude_deg), 0};
  columns.outline.push_back(gridColumn(column));
  return column;
}

FastGeodesy geodesyOf(const PositionColumn& middle) {
  const GeodeticPosition position = fromEcef(middle.foot_ecef_m);
  return fastGeodesy(position.latitude_deg, position.longitude_deg);
}

GridColumns makeGridColumns(const Surface& surface, const scenario::Terrain* terrain) {
  GridColumns result = emptyColumns(surface);
  const auto positions = static_cast<int>(surface.positions.size());
  result.of_surface.resize(surface.positions.size());
  if (terrain != nullptr) result.ground_msl_m.resize(surface.positions.size());
  result.first_valid_k.resize(surface.positions.size());
  PositionTask task = positionTask(surface, terrain);
  task.columns = result.of_surface.data();
  task.ground_msl_m = result.ground_msl_m.data();
  task.first_valid_k = result.first_valid_k.data();
  std::vector<PositionsPart> parts((surface.positions.size() + kPositionsPart - 1) / kPositionsPart);
  visitParts(positions, [&](int n, int first, int end) {
    NearGeoid undulation_m;
    for (int c = first; c < end; ++c) task(c, undulation_m, parts[n]);
  });
  setOutlineOfPositions(surface, parts, result);
  return result;
}

}  // namespace emscape::emfield
