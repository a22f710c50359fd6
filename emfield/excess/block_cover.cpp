#include "emfield/excess/block_cover.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::LandCoverView;
using scenario::TerrainRaster;

constexpr int kPosts = BlockCover::kPosts;
constexpr auto kFree_m = static_cast<float>(kClutterFree_m), kRounding_m = 0.05f;

/// Coordinates of posts in cells, relative to the part's first cell.
struct CellTask {
  float column, row, column_length, row_length;  ///< of the part
  float first_m, per_m;
  float distance_m, columns_per_m, rows_per_m;
  float beside_m;
  int columns, crossings;  ///< numbers of posts
};
struct Cells {
  float part[kPosts];
  int column[kPosts], row[kPosts];
  int beside_column[kPosts],
      beside_row[kPosts];  ///< the same, or the next one, if that is as near as beside_m
  /// 0: not raised; 1: raised; 2: raised, and there is a next cell; 3: perhaps raised
  int state[kPosts];
};

EMSCAPE_SIMD_CLONES void findCells(const CellTask& of, const float* range_m, Cells& cells) {
  constexpr float kOnLine_m = 0.02f;
  const CellTask task = of;
  // A path beside crosses a line farther along it, the more parallel the farther.
  const float along_x = std::fabs(task.column_length * task.rows_per_m),
              along_y = std::fabs(task.row_length * task.columns_per_m), kLeast = 1e-6f;
  const float on_row_m = task.beside_m * (1 + along_x / (along_y + kLeast)),
              on_column_m = task.beside_m * (1 + along_y / (along_x + kLeast));
#pragma omp simd
  for (int n = 0; n < kPosts; ++n) {
    const bool is_on_column = n < task.columns, is_on_row = !is_on_column && n < task.crossings;
    const float near_x = (is_on_column ? kOnLine_m
                          : is_on_row  ? on_row_m
                                       : task.beside_m) *
                         task.columns_per_m;
    const float near_y = (is_on_column ? on_column_m
                          : is_on_row  ? kOnLine_m
                                       : task.beside_m) *
                         task.rows_per_m;
    const float range = range_m[n], beyond = task.distance_m - range;
    const float nearer = range < beyond ? range : beyond;
    const float part = (range - task.first_m) * task.per_m;
    const float x = task.column + part * task.column_length, y = task.row + part * task.row_length;
    const float cell_x = std::floor(x), cell_y = std::floor(y), in_x = x - cell_x, in_y = y - cell_y;
    const int column = static_cast<int>(cell_x), row = static_cast<int>(cell_y);
    cells.part[n] = part;
    cells.column[n] = column;
    cells.row[n] = row;
    const int to_column = in_x < near_x ? -1 : in_x > 1 - near_x ? 1 : 0;
    const int to_row = in_y < near_y ? -1 : in_y > 1 - near_y ? 1 : 0;
    cells.beside_column[n] = column + to_column;
    cells.beside_row[n] = row + to_row;
    const int raised = (to_column | to_row) == 0 ? 1 : 2;
    cells.state[n] = nearer > kFree_m + kRounding_m ? raised : nearer > kFree_m - kRounding_m ? 3 : 0;
  }
}

}  // namespace

BlockCover::BlockCover(const scenario::TerrainView& terrain) : terrain_(terrain), classes_(terrain.cover) {
  const LandCoverView& cover = terrain.cover;
  if (!cover.isSet()) return;
  const TerrainRaster& raster = terrain.rasters[0];
  first_column_ = (raster.west_rad - cover.west_rad) * cover.cells_per_rad_lon;
  first_row_ = (raster.south_rad - cover.south_rad) * cover.cells_per_rad_lat;
  per_column_ = cover.cells_per_rad_lon / raster.posts_per_rad_lon;
  per_row_ = cover.cells_per_rad_lat / raster.posts_per_rad_lat;
  turn_cells_ = 2 * kPi * cover.cells_per_rad_lon;
  constexpr double kMinRadius_m = 6335e3;
  const double north_rad = raster.south_rad + (raster.rows - 1) / raster.posts_per_rad_lat;
  const double parallel_m = kMinRadius_m * std::min(std::cos(raster.south_rad), std::cos(north_rad));
  rows_per_m_ = static_cast<float>(cover.cells_per_rad_lat / kMinRadius_m);
  columns_per_m_ = static_cast<float>(cover.cells_per_rad_lon / parallel_m);
}

inline std::uint8_t BlockCover::cellAt(int column, int row) const {
  const LandCoverView& cover = terrain_.cover;
  const bool is_inside = (column >= 0) & (column < cover.columns) & (row >= 0) & (row < cover.rows);
  return is_inside ? cover.cells[static_cast<long long>(row) * cover.columns + column]
                   : LandCoverView::kNoClass;
}

/// @param surface_m  height of the surface model above the ground; NaN: unknown
inline float BlockCover::heightOf(std::uint8_t cell, float surface_m) const {
  if (std::isnan(surface_m)) return classes_.raise_m(cell);
  return classes_.isWater(cell) ? 0 : std::max(surface_m, 0.0f);
}

float BlockCover::surface_m(const RasterLine& line, float part, float ground_msl_m) const {
  const TerrainRaster& raster = terrain_.rasters[0];
  const auto at = static_cast<double>(part);
  return terrain_.surfaceAt(
             raster.south_rad + (line.row + at * line.row_length) / raster.posts_per_rad_lat,
             raster.west_rad + (line.column + at * line.column_length) / raster.posts_per_rad_lon) -
         ground_msl_m;
}

EMSCAPE_SIMD_CLONES unsigned BlockCover::raise(const RasterLine& line, int columns, int crossings, int count,
                                               float distance_m, float beside_m, float base_msl_m,
                                               const float* range_m, float* height_m) const {
  double column = first_column_ + line.column * per_column_;
  if (column < 0 || column >= turn_cells_) column -= turn_cells_ * std::floor(column / turn_cells_);
  const double row = first_row_ + line.row * per_row_;
  const double first_column = std::floor(column), first_row = std::floor(row);
  Cells cells;
  findCells({static_cast<float>(column - first_column), static_cast<float>(row - first_row),
             static_cast<float>(line.column_length * per_column_),
             static_cast<float>(line.row_length * per_row_), line.first_m, 1 / line.length_m, distance_m,
             columns_per_m_, rows_per_m_, beside_m, columns, crossings},
            range_m, cells);
  const int west = static_cast<int>(first_column), south = static_cast<int>(first_row);
  unsigned doubtful = 0, others = 0;
  float raise_m[kPosts] = {};
  for (int n = 0; n < count; ++n)
    raise_m[n] = classes_.raise_m(cellAt(west + cells.column[n], south + cells.row[n]));
  const int last_simple = terrain_.surface_count > 0 ? 0 : 1;
#pragma omp simd reduction(| : others)
  for (int n = 0; n < kPosts; ++n) {
    const int state = cells.state[n];
    height_m[n] += state == 1 && state <= last_simple ? raise_m[n] : 0.0f;
    others |= (state > last_simple ? 1u : 0u) << n;
  }
  for (others &= (1u << count) - 1; others != 0; others &= others - 1) {
    const int n = __builtin_ctz(others);
    if (!(height_m[n] > -HUGE_VALF)) continue;
    const int i = west + cells.column[n], j = south + cells.row[n];
    const int beside_i = west + cells.beside_column[n], beside_j = south + cells.beside_row[n];
    const std::uint8_t here = cellAt(i, j);
    const float above_m =
        terrain_.surface_count > 0 ? surface_m(line, cells.part[n], height_m[n] + base_msl_m) : NAN;
    const float here_m = heightOf(here, above_m);
    float most_m = here_m, least_m = cells.state[n] < 3 ? here_m : 0;
    for (const std::uint8_t cell : {cellAt(beside_i, j), cellAt(i, beside_j), cellAt(beside_i, beside_j)}) {
      const float beside = heightOf(cell, above_m);
      most_m = std::max(most_m, beside);
      least_m = std::min(least_m, beside);
    }
    if (most_m > least_m) doubtful |= 1u << n;
    height_m[n] += most_m;
  }
  return doubtful;
}

}  // namespace emscape::emfield
