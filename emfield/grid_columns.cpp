#include "emfield/grid_columns.h"

#include <algorithm>
#include <cmath>

#include "emfield/foot_inverse.h"
#include "emscape/base/error.h"
#include "emscape/base/geoid.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"

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

/// Undulations of the geoid at many positions close to each other: bilinear in small cells, parts of the
/// cells of the geoid grid, in which the geoid is nearly flat.
/// @accuracy 0.1 mm if the geoid's slope changes by 1e-6 per km
class NearGeoid {
 public:
  double undulation_m(double latitude_deg, double longitude_deg) {
    const double row = latitude_deg * kCellsPerDegree, column = longitude_deg * kCellsPerDegree;
    const double j = std::floor(row), i = std::floor(column);
    const Cell& cell = cellAt(i, j);
    const double x = column - i, y = row - j;
    const double south = cell.corners_m[0] + x * (cell.corners_m[1] - cell.corners_m[0]);
    const double north = cell.corners_m[2] + x * (cell.corners_m[3] - cell.corners_m[2]);
    return south + y * (north - south);
  }

 private:
  static constexpr double kCellsPerDegree = 64;
  static constexpr int kKept = 128;  ///< cells of one row, which the next row of positions often needs again
  struct Cell {
    double i = HUGE_VAL, j = HUGE_VAL;
    double corners_m[4];
  };

  const Cell& cellAt(double i, double j) {
    Cell& cell = cells_[static_cast<unsigned>(static_cast<long long>(i)) % kKept];
    if (cell.i != i || cell.j != j) {
      cell.i = i;
      cell.j = j;
      for (int n = 0; n < 4; ++n) {
        cell.corners_m[n] =
            geoidUndulation_m(std::min((j + n / 2) / kCellsPerDegree, 90.0), (i + n % 2) / kCellsPerDegree);
      }
    }
    return cell;
  }

  Cell cells_[kKept];
};

/// Makes vertical columns whose t = 0 is at a height above a position.
class ColumnMaker {
 public:
  PlaceColumn columnAbove(const Surface::Place& place, double base_msl_m) {
    return {toEcef({place.latitude_deg, place.longitude_deg, 0}),
            base_msl_m + geoid_.undulation_m(place.latitude_deg, place.longitude_deg), base_msl_m};
  }

 private:
  NearGeoid geoid_;
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

/// Sums over a part of a surface's positions.
struct PlacesPart {
  Vec3d feet{0, 0, 0};  ///< sum
  double lowest_msl_m = HUGE_VAL, highest_msl_m = -HUGE_VAL;
  double farthest2_m2 = 0;               ///< largest squared straight-line distance of a foot from the middle
  double beyond_m = 0;                   ///< the same along the ground
  long long holes = 0, first_hole = -1;  ///< positions without ground
};

/// Positions that a thread processes together. Their sums are added in order, whichever thread computes them.
constexpr int kPlacesPart = 4096;

/// Calls visit(first, end, part) for all parts.
template <class Visit>
void visitParts(std::vector<PlacesPart>& parts, int places, const Visit& visit) {
  parallelFor(static_cast<int>(parts.size()), 1, [&](int begin, int end) {
    for (int n = begin; n < end; ++n)
      visit(n * kPlacesPart, std::min((n + 1) * kPlacesPart, places), parts[n]);
  });
}

/// Sets a circle around all positions with ground. Positions that are left out get the column of its centre,
/// so that their numbers are finite.
void setOutlineOfPlaces(const Surface& surface, std::vector<PlacesPart>& parts, GridColumns& columns) {
  Vec3d sum{0, 0, 0};
  for (const PlacesPart& part : parts) {
    sum = sum + part.feet;
    columns.lowest_msl_m = std::min(columns.lowest_msl_m, part.lowest_msl_m);
    columns.highest_msl_m = std::max(columns.highest_msl_m, part.highest_msl_m);
  }
  if (length(sum) == 0) {
    throw Error(ErrorCode::bad_input,
                columns.ground_msl_m.empty()
                    ? "there is no place to compute the field over"
                    : "the terrain is missing below all places to compute the field over");
  }
  const GeodeticPosition middle = fromEcef(sum * (kWgs84SemiMajor_m / length(sum)));
  const PlaceColumn at_middle = ColumnMaker().columnAbove({middle.latitude_deg, middle.longitude_deg}, 0);
  columns.outline.push_back(gridColumn(at_middle));
  const auto places = static_cast<int>(columns.of_surface.size());
  const auto distance2_m2 = [&](int c) {
    const bool is_hole = !columns.ground_msl_m.empty() && std::isnan(columns.ground_msl_m[c]);
    if (is_hole || std::isnan(surface.places[c].latitude_deg)) return 0.0;
    const Vec3d chord = columns.of_surface[c].foot_ecef_m - columns.outline[0].foot_ecef_m;
    return dot(chord, chord);
  };
  visitParts(parts, places, [&](int first, int end, PlacesPart& part) {
    for (int c = first; c < end; ++c) {
      part.farthest2_m2 = std::max(part.farthest2_m2, distance2_m2(c));
      if (std::isnan(surface.places[c].latitude_deg)) columns.of_surface[c] = at_middle;
    }
  });
  double farthest2_m2 = 0;
  for (const PlacesPart& part : parts) farthest2_m2 = std::max(farthest2_m2, part.farthest2_m2);
  // The earth's radii differ by less than 1.5 %, and the arcs over one chord by much less.
  constexpr double kNearlyFarthest2 = 0.97;
  const Station station = makeStation({middle.latitude_deg, middle.longitude_deg, 0}, 0, 1);
  visitParts(parts, places, [&](int first, int end, PlacesPart& part) {
    if (part.farthest2_m2 < kNearlyFarthest2 * farthest2_m2) return;
    for (int c = first; c < end; ++c) {
      if (distance2_m2(c) < kNearlyFarthest2 * farthest2_m2) continue;
      part.beyond_m =
          std::max(part.beyond_m, fastInverse(station.geodesy, columns.of_surface[c].foot_ecef_m).distance_m);
    }
  });
  for (const PlacesPart& part : parts) {
    columns.beyond_outline_m = std::max(columns.beyond_outline_m, part.beyond_m);
  }
}

void countHole(std::size_t c, GridColumns& columns) {
  if (columns.first_hole < 0) columns.first_hole = static_cast<long long>(c);
  ++columns.hole_columns;
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
  for (const GridColumn& column : columns.of_grid) drift = std::max(drift, length(column.foot_drift));
  return drift * half_height_m;
}

GridColumns makeGridColumns(const volume::Grid& grid, const scenario::Terrain* terrain) {
  const GeoFrame frame(grid.frame);
  GridColumns result;
  result.dims = grid.dims;
  result.tilted = grid.frame.kind == FrameKind::enu;
  const int column_count = grid.dims.x * grid.dims.y;
  result.of_grid.resize(column_count);
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
        GridColumn& column = result.of_grid[c];
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

  setOutlineOfGrid(result);
  for (std::size_t c = 0; c < result.ground_msl_m.size(); ++c) {
    if (std::isnan(result.ground_msl_m[c])) countHole(c, result);
  }
  return result;
}

GridColumns makeGridColumns(const Surface& surface, const scenario::Terrain* terrain) {
  GridColumns result;
  result.every_height = true;
  result.dims = {surface.width, surface.height, static_cast<int>(surface.heights_m.size())};
  const auto places = static_cast<int>(surface.places.size());
  result.of_surface.resize(surface.places.size());
  for (const double height_m : surface.heights_m) result.t_m.push_back(static_cast<float>(height_m));
  if (terrain != nullptr) result.ground_msl_m.resize(surface.places.size());
  result.first_valid_k.assign(surface.places.size(), 0);
  const bool above_ground = surface.reference == HeightReference::ground;
  std::vector<PlacesPart> parts((surface.places.size() + kPlacesPart - 1) / kPlacesPart);
  visitParts(parts, places, [&](int first, int end, PlacesPart& part) {
    ColumnMaker maker;
    for (int c = first; c < end; ++c) {
      const Surface::Place& place = surface.places[c];
      if (std::isnan(place.latitude_deg)) {
        result.first_valid_k[c] = static_cast<std::uint16_t>(result.dims.z);
        continue;
      }
      const double ground_msl_m =
          terrain != nullptr ? terrain->heightMsl_m(place.latitude_deg, place.longitude_deg) : 0;
      const double base_msl_m = (above_ground && !std::isnan(ground_msl_m) ? ground_msl_m : 0) +
                                (surface.offsets_m.empty() ? 0 : static_cast<double>(surface.offsets_m[c]));
      const PlaceColumn& column = result.of_surface[c] = maker.columnAbove(place, base_msl_m);
      if (terrain != nullptr) {
        result.ground_msl_m[c] = static_cast<float>(ground_msl_m);
        int k = 0;
        if (std::isnan(ground_msl_m)) {
          k = result.dims.z;
        } else if (!above_ground) {
          while (k < result.dims.z && !(base_msl_m + surface.heights_m[k] >= ground_msl_m)) ++k;
        }
        result.first_valid_k[c] = static_cast<std::uint16_t>(k);
      }
      if (std::isnan(ground_msl_m)) {
        if (part.holes++ == 0) part.first_hole = c;
        continue;
      }
      part.feet = part.feet + column.foot_ecef_m;
      addHeights(column, result.t_m, part);
    }
  });
  setOutlineOfPlaces(surface, parts, result);
  for (const PlacesPart& part : parts) {
    if (part.holes > 0 && result.hole_columns == 0) result.first_hole = part.first_hole;
    result.hole_columns += part.holes;
  }
  return result;
}

}  // namespace emscape::emfield
