#include "emfield/excess/block_cover.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::LandCoverView;
using scenario::TerrainRaster;

constexpr auto kFree_m = static_cast<float>(kClutterFree_m), kRounding_m = 0.05f;

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

float BlockCover::surface_m(double column, double row, float ground_msl_m) const {
  const TerrainRaster& raster = terrain_.rasters[0];
  return terrain_.surfaceAt(raster.south_rad + row / raster.posts_per_rad_lat,
                            raster.west_rad + column / raster.posts_per_rad_lon) -
         ground_msl_m;
}

EMSCAPE_SIMD_CLONES unsigned BlockCover::raise(const CoverTask& task, unsigned lanes, float* height_m) const {
  using Floats = PathFloats;
  using Ints = PathInts;
  constexpr float kOnLine_m = 0.02f, kLeast = 1e-6f;
  Floats range_m, distance_m, beside_m, to_columns, to_rows, columns_on, rows_on;
  load(task.range_m, range_m);
  load(task.distance_m, distance_m);
  load(task.beside_m, beside_m);
  load(task.column, to_columns);
  load(task.row, to_rows);
  load(task.columns, columns_on);
  load(task.rows, rows_on);
  // Cells relative to that of the first path.
  const double first_column = static_cast<double>(task.column[0]) + task.corner_column,
               first_row = static_cast<double>(task.row[0]) + task.corner_row;
  double column = first_column_ + first_column * per_column_;
  if (column < 0 || column >= turn_cells_) column -= turn_cells_ * std::floor(column / turn_cells_);
  const double row = first_row_ + first_row * per_row_;
  const int west = static_cast<int>(std::floor(column)), south = static_cast<int>(std::floor(row));
  const auto per_column = static_cast<float>(per_column_), per_row = static_cast<float>(per_row_);
  const Floats x = (to_columns - task.column[0]) * per_column + static_cast<float>(column - west);
  const Floats y = (to_rows - task.row[0]) * per_row + static_cast<float>(row - south);
  const Floats zero{};
  const auto floorOf = [](const Floats& of, Ints& cell) {
    cell = __builtin_convertvector(of, Ints);
    Ints is_under;
    setAbove(__builtin_convertvector(cell, Floats), of, is_under);
    cell += is_under;
  };
  Ints cell_x, cell_y;
  floorOf(x, cell_x);
  floorOf(y, cell_y);
  const Floats in_x = x - __builtin_convertvector(cell_x, Floats),
               in_y = y - __builtin_convertvector(cell_y, Floats);
  // A path beside crosses a line farther along it, the more parallel the farther.
  Floats near_x = beside_m * columns_per_m_, near_y = beside_m * rows_per_m_;
  if (task.on != PostOn::neither) {
    const Floats x_on = columns_on * (per_column * rows_per_m_), y_on = rows_on * (per_row * columns_per_m_);
    const auto setLength = [&](const Floats& on, Floats& length) {
      Ints is_negative;
      setAbove(zero, on, is_negative);
      choose(is_negative, -on, on, length);
    };
    Floats along_x, along_y;
    setLength(x_on, along_x);
    setLength(y_on, along_y);
    if (task.on == PostOn::column) {
      near_x = zero + kOnLine_m * columns_per_m_;
      near_y *= 1 + along_y / (along_x + kLeast);
    } else {
      near_x *= 1 + along_x / (along_y + kLeast);
      near_y = zero + kOnLine_m * rows_per_m_;
    }
  }
  const auto setBeside = [](const Floats& in, const Floats& near, Ints& beside) {
    Ints is_before, is_after;
    setAbove(near, in, is_before);
    setAbove(in, 1 - near, is_after);
    beside = is_before | (-is_after & ~is_before);
  };
  Ints beside_x, beside_y, is_nearer_tx, is_raised, is_beyond_end;
  setBeside(in_x, near_x, beside_x);
  setBeside(in_y, near_y, beside_y);
  const Floats beyond_m = distance_m - range_m;
  Floats nearer_m;
  setAbove(beyond_m, range_m, is_nearer_tx);
  choose(is_nearer_tx, range_m, beyond_m, nearer_m);
  setAbove(nearer_m, zero + (kFree_m - kRounding_m), is_raised);
  setAbove(nearer_m, zero + (kFree_m + kRounding_m), is_beyond_end);
  const Ints is_other = beside_x | beside_y | ~is_beyond_end;
  int columns[kPathLanes], rows[kPathLanes], to_column[kPathLanes], to_row[kPathLanes];
  int raised_of[kPathLanes], other_of[kPathLanes];
  store(cell_x + west, columns);
  store(cell_y + south, rows);
  store(beside_x, to_column);
  store(beside_y, to_row);
  store(is_raised, raised_of);
  store(is_other, other_of);
  unsigned raised = 0, others = 0;  // bit i: perhaps with clutter; perhaps another cell, or without clutter
#pragma omp simd reduction(| : raised, others)
  for (int n = 0; n < kPathLanes; ++n) {
    raised |= (raised_of[n] != 0 ? 1u : 0u) << n;
    others |= (other_of[n] != 0 ? 1u : 0u) << n;
  }
  unsigned doubtful = 0;
  for (unsigned left = lanes & raised; left != 0; left &= left - 1) {
    const int n = __builtin_ctz(left);
    if (!(height_m[n] > -HUGE_VALF)) continue;
    const std::uint8_t here = cellAt(columns[n], rows[n]);
    float above_m = NAN;
    if (terrain_.surface_count > 0) {
      above_m = surface_m(static_cast<double>(task.column[n]) + task.corner_column,
                          static_cast<double>(task.row[n]) + task.corner_row, height_m[n] + task.base_msl_m);
    }
    const float here_m = heightOf(here, above_m);
    float most_m = here_m;
    if ((others >> n & 1) != 0) {
      const float nearer = std::min(task.range_m[n], task.distance_m[n] - task.range_m[n]);
      float least_m = nearer > kFree_m + kRounding_m ? here_m : 0;
      const int beside_column = columns[n] + to_column[n], beside_row = rows[n] + to_row[n];
      for (const std::uint8_t cell : {cellAt(beside_column, rows[n]), cellAt(columns[n], beside_row),
                                      cellAt(beside_column, beside_row)}) {
        const float beside = heightOf(cell, above_m);
        most_m = std::max(most_m, beside);
        least_m = std::min(least_m, beside);
      }
      if (most_m > least_m) doubtful |= 1u << n;
    }
    height_m[n] += most_m;
  }
  return doubtful;
}

}  // namespace emscape::emfield
