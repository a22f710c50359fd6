/// The columns above the positions of a surface, on host or device.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/geodesy/fast_geodesy.h"
#include "base/geodesy/geoid_grid.h"
#include "emfield/columns/grid_columns.h"
#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {

/// Undulations of the geoid at positions close to each other: bilinear in small cells, parts of the cells of
/// the geoid grid, in which the geoid is nearly flat.
/// @accuracy 0.1 mm if the geoid's slope changes by 1e-6 per km
struct GeoidCell {
  static constexpr double kPerDegree = 64;
  double i = HUGE_VAL, j = HUGE_VAL;  ///< of its south-western corner: multiples of 1 / kPerDegree degrees
  double corners_m[4];                ///< south-west, south-east, north-west, north-east

  EMSCAPE_HD static GeoidCell at(const GeoidView& geoid, double i, double j) {
    GeoidCell cell;
    cell.i = i;
    cell.j = j;
    for (int n = 0; n < 4; ++n) {
      cell.corners_m[n] = geoid.undulation_m((j + n / 2) / kPerDegree, (i + n % 2) / kPerDegree);
    }
    return cell;
  }
  EMSCAPE_HD double undulation_m(double latitude_deg, double longitude_deg) const {
    const double x = longitude_deg * kPerDegree - i, y = latitude_deg * kPerDegree - j;
    const double south = corners_m[0] + x * (corners_m[1] - corners_m[0]);
    const double north = corners_m[2] + x * (corners_m[3] - corners_m[2]);
    return south + y * (north - south);
  }
};

/// Computes each cell.
struct GeoidCells {
  GeoidView geoid;

  EMSCAPE_HD double operator()(double latitude_deg, double longitude_deg) const {
    const double i = std::floor(longitude_deg * GeoidCell::kPerDegree);
    const double j = std::floor(latitude_deg * GeoidCell::kPerDegree);
    return GeoidCell::at(geoid, i, j).undulation_m(latitude_deg, longitude_deg);
  }
};

/// Sums over a part of a surface's positions; those that are left out do not count.
struct PositionsPart {
  Vec3d feet{0, 0, 0};  ///< sum over positions with ground
  double lowest_msl_m = HUGE_VAL, highest_msl_m = -HUGE_VAL;
  long long holes = 0, first_hole = -1;  ///< positions without ground

  EMSCAPE_HD void addHeight(double height_msl_m) {
    lowest_msl_m = height_msl_m < lowest_msl_m ? height_msl_m : lowest_msl_m;
    highest_msl_m = height_msl_m > highest_msl_m ? height_msl_m : highest_msl_m;
  }
  EMSCAPE_HD void add(const PositionsPart& other) {
    feet = feet + other.feet;
    lowest_msl_m = other.lowest_msl_m < lowest_msl_m ? other.lowest_msl_m : lowest_msl_m;
    highest_msl_m = other.highest_msl_m > highest_msl_m ? other.highest_msl_m : highest_msl_m;
    holes += other.holes;
    if (first_hole < 0 || (other.first_hole >= 0 && other.first_hole < first_hole))
      first_hole = other.first_hole;
  }
};

EMSCAPE_HD inline bool isLeftOut(const Surface::Position& position) {
  return position.latitude_deg != position.latitude_deg;
}

/// Computes the columns of a surface. Pointers are to host or device memory.
struct PositionTask {
  const Surface::Position* positions = nullptr;
  const float* offsets_m = nullptr;  ///< null: 0
  const double* heights_m = nullptr;
  int layers = 0;
  bool above_ground = true, has_terrain = false;
  scenario::TerrainView terrain;
  PositionColumn* columns = nullptr;
  float* ground_msl_m = nullptr;           ///< with terrain
  std::uint16_t* first_valid_k = nullptr;  ///< see GridColumns

  /// Sets column c; of a position that is left out only its ground and first_valid_k.
  /// @param undulation_m(latitude_deg, longitude_deg)  as GeoidCells
  /// @param part  the column is added
  template <class Undulation>
  EMSCAPE_HD void operator()(long long c, Undulation& undulation_m, PositionsPart& part) const {
    const Surface::Position position = positions[c];
    if (isLeftOut(position)) {
      if (has_terrain) ground_msl_m[c] = 0;
      first_valid_k[c] = static_cast<std::uint16_t>(layers);
      return;
    }
    const double latitude_rad = degToRad(position.latitude_deg),
                 longitude_rad = degToRad(position.longitude_deg);
    const double ground_m =
        has_terrain ? static_cast<double>(terrain.heightAt(latitude_rad, longitude_rad)) : 0;
    const bool is_hole = ground_m != ground_m;
    PositionColumn column;
    column.base_msl_m = (above_ground && !is_hole ? ground_m : 0) +
                        (offsets_m == nullptr ? 0 : static_cast<double>(offsets_m[c]));
    column.base_ellipsoid_m = column.base_msl_m + undulation_m(position.latitude_deg, position.longitude_deg);
    column.foot_ecef_m = ellipsoidPoint_m(latitude_rad, longitude_rad);
    columns[c] = column;
    if (has_terrain) ground_msl_m[c] = static_cast<float>(ground_m);
    first_valid_k[c] = static_cast<std::uint16_t>(is_hole ? layers : firstValid(column.base_msl_m, ground_m));
    if (is_hole) {
      if (part.holes++ == 0) part.first_hole = c;
      return;
    }
    part.feet = part.feet + column.foot_ecef_m;
    part.addHeight(heightMsl_m(column, static_cast<double>(static_cast<float>(heights_m[0]))));
    part.addHeight(heightMsl_m(column, static_cast<double>(static_cast<float>(heights_m[layers - 1]))));
  }

 private:
  /// The lowest layer that is not below ground.
  EMSCAPE_HD int firstValid(double base_msl_m, double ground_m) const {
    int k = 0;
    if (!above_ground) {
      while (k < layers && !(base_msl_m + heights_m[k] >= ground_m)) ++k;
    }
    return k;
  }
};

/// The arrays and pointers of a surface in host memory, without the results.
PositionTask positionTask(const Surface& surface, const scenario::Terrain* terrain);

/// Columns of a surface without those of its positions: its dims and layers.
GridColumns emptyColumns(const Surface& surface);

/// Sets the sums over all positions, and the first column of the outline, which is in their middle.
/// @return that column, which positions that are left out get, so that their numbers are finite
/// @throws Error (bad_input) if no position has ground
PositionColumn setMiddle(const std::vector<PositionsPart>& parts, bool has_terrain, GridColumns& columns);

/// Distances from the middle of a surface. @param middle  of setMiddle()
FastGeodesy geodesyOf(const PositionColumn& middle);

}  // namespace emscape::emfield
