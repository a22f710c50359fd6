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

/// The vertical column whose t = 0 is at a height above a place.
GridColumn columnAbove(const Surface::Place& place, double base_msl_m) {
  const double latitude_rad = degToRad(place.latitude_deg), longitude_rad = degToRad(place.longitude_deg);
  const double base_ellipsoid_m = base_msl_m + geoidUndulation_m(place.latitude_deg, place.longitude_deg);
  GridColumn column;
  column.axis = {std::cos(latitude_rad) * std::cos(longitude_rad),
                 std::cos(latitude_rad) * std::sin(longitude_rad), std::sin(latitude_rad)};
  column.foot_ecef_m = toEcef({place.latitude_deg, place.longitude_deg, 0});
  column.base_ecef_m = column.foot_ecef_m + column.axis * base_ellipsoid_m;
  column.foot_drift = {0, 0, 0};
  column.height_msl_m[0] = base_msl_m;
  column.height_msl_m[1] = 1;
  column.height_msl_m[2] = 0;
  return column;
}

/// Extends a range of heights by those of a column.
/// @param range  with lowest_msl_m and highest_msl_m
template <class Range>
void addHeights(const GridColumn& column, const std::vector<float>& layers_m, Range& range) {
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
      columns.outline.push_back(columns.columns[static_cast<std::size_t>(j) * dims.x + i]);
      addHeights(columns.outline.back(), columns.t_m, columns);
    }
  }
}

/// A circle around all places.
void setOutlineOfPlaces(const Surface& surface, GridColumns& columns) {
  const auto isKnown = [&](std::size_t c) {
    return !std::isnan(surface.places[c].latitude_deg) &&
           (columns.ground_msl_m.empty() || !std::isnan(columns.ground_msl_m[c]));
  };
  // By parts of the places: their sums are added in order, whatever thread computes them.
  constexpr std::size_t kPart = 4096;
  struct Part {
    Vec3d sum{0, 0, 0};
    double lowest_msl_m = HUGE_VAL, highest_msl_m = -HUGE_VAL, beyond_m = 0;
  };
  std::vector<Part> parts((surface.places.size() + kPart - 1) / kPart);
  const auto inParts = [&](const auto& visit) {
    parallelFor(static_cast<int>(parts.size()), 1, [&](int begin, int end) {
      for (std::size_t c = begin * kPart; c < std::min(end * kPart, surface.places.size()); ++c) {
        if (isKnown(c)) visit(c, parts[c / kPart]);
      }
    });
  };
  inParts([&](std::size_t c, Part& part) {
    part.sum = part.sum + columns.columns[c].foot_ecef_m;
    addHeights(columns.columns[c], columns.t_m, part);
  });
  Vec3d sum{0, 0, 0};
  for (const Part& part : parts) {
    sum = sum + part.sum;
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
  columns.outline.push_back(columnAbove({middle.latitude_deg, middle.longitude_deg}, 0));
  const Station station = makeStation({middle.latitude_deg, middle.longitude_deg, 0}, 0, 1);
  inParts([&](std::size_t c, Part& part) {
    part.beyond_m = std::max(part.beyond_m, footInverse(station, columns.columns[c], 0).distance_m);
  });
  for (const Part& part : parts) {
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
  result.columns.resize(surface.places.size());
  for (const double height_m : surface.heights_m) result.t_m.push_back(static_cast<float>(height_m));
  if (terrain != nullptr) result.ground_msl_m.resize(surface.places.size());
  result.first_valid_k.assign(surface.places.size(), 0);
  const bool above_ground = surface.reference == HeightReference::ground;
  parallelFor(static_cast<int>(surface.places.size()), 1024, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const Surface::Place& place = surface.places[c];
      if (std::isnan(place.latitude_deg)) {
        result.first_valid_k[c] = static_cast<std::uint16_t>(result.dims.z);
        continue;
      }
      const double ground_msl_m =
          terrain != nullptr ? terrain->heightMsl_m(place.latitude_deg, place.longitude_deg) : 0;
      const double base_msl_m = (above_ground && !std::isnan(ground_msl_m) ? ground_msl_m : 0) +
                                (surface.offsets_m.empty() ? 0 : static_cast<double>(surface.offsets_m[c]));
      result.columns[c] = columnAbove(place, base_msl_m);
      if (terrain == nullptr) continue;
      result.ground_msl_m[c] = static_cast<float>(ground_msl_m);
      int k = 0;
      if (std::isnan(ground_msl_m)) {
        k = result.dims.z;
      } else if (!above_ground) {
        while (k < result.dims.z && !(base_msl_m + surface.heights_m[k] >= ground_msl_m)) ++k;
      }
      result.first_valid_k[c] = static_cast<std::uint16_t>(k);
    }
  });
  setOutlineOfPlaces(surface, result);
  for (std::size_t c = 0; c < surface.places.size(); ++c) {  // so that their numbers are finite
    if (std::isnan(surface.places[c].latitude_deg)) result.columns[c] = result.outline[0];
  }
  for (std::size_t c = 0; c < result.ground_msl_m.size(); ++c) {
    const bool is_place = !std::isnan(surface.places[c].latitude_deg);
    if (is_place && std::isnan(result.ground_msl_m[c])) countHole(c, result);
  }
  return result;
}

}  // namespace emscape::emfield
