#include "emfield/ground/terrain_bounds.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

/// The larger; infinity if one is NaN.
inline float steeper(float a, float b) {
  const float larger = a > b ? a : b;
  return a + b == a + b ? larger : HUGE_VALF;
}

/// Upper bounds of the slope (m per m) in the cells north of a row of posts. Heights are bilinear: along a
/// row or a column no slope is larger than those between neighbouring posts of the cell.
/// @param per_post_lon, per_post_lat  upper bounds of the posts per metre
void slopesOfRow(const float* south, const float* north, int cells, float per_post_lon, float per_post_lat,
                 float* slope) {
#pragma omp simd
  for (int i = 0; i < cells; ++i) {
    const float along = steeper(std::fabs(south[i + 1] - south[i]), std::fabs(north[i + 1] - north[i]));
    const float across = steeper(std::fabs(north[i] - south[i]), std::fabs(north[i + 1] - south[i + 1]));
    const float to_east = along * per_post_lon, to_north = across * per_post_lat;
    slope[i] = std::sqrt(to_east * to_east + to_north * to_north);
  }
}

}  // namespace

TerrainBounds::TerrainBounds(const scenario::TerrainView& terrain) {
  constexpr int kMaxPosts = 1 << 15;  // of a row or column: positions within 1/256 post as float
  constexpr int kWindow = kStride + static_cast<int>(kMaxExtent) + 1;  // cells
  if (terrain.count == 0) return;
  const scenario::TerrainRaster& raster = terrain.rasters[0];
  if (raster.columns > kMaxPosts || raster.rows > kMaxPosts) return;
  // A lower bound of the earth's radii of curvature, and of the radius of a parallel.
  constexpr double kMinRadius_m = 6335e3;
  const double north_rad = raster.south_rad + (raster.rows - 1) / raster.posts_per_rad_lat;
  const double parallel_m = kMinRadius_m * std::min(std::cos(raster.south_rad), std::cos(north_rad));
  if (!(parallel_m > 0)) return;
  const auto per_post_lon = static_cast<float>(raster.posts_per_rad_lon / parallel_m);
  const auto per_post_lat = static_cast<float>(raster.posts_per_rad_lat / kMinRadius_m);

  const int columns = raster.columns - 1, rows = raster.rows - 1;  // of cells
  windows_ = (columns + kStride - 1) / kStride;
  const int window_rows = (rows + kStride - 1) / kStride;
  const auto row_windows = static_cast<std::size_t>(windows_);
  std::vector<float> of_rows(row_windows * rows);
  parallelFor(rows, 16, [&](int begin, int end) {
    std::vector<float> slope(static_cast<std::size_t>(windows_ * kStride + kWindow), 0.0f);
    for (int j = begin; j < end; ++j) {
      const float* const posts = raster.heights_msl_m + static_cast<long long>(j) * raster.columns;
      slopesOfRow(posts, posts + raster.columns, columns, per_post_lon, per_post_lat, slope.data());
      float* const steepest = of_rows.data() + j * row_windows;
      for (int i = 0; i < windows_; ++i) {
        float largest = 0;
        for (int n = 0; n < kWindow; ++n) largest = std::max(largest, slope[i * kStride + n]);
        steepest[i] = largest;
      }
    }
  });
  steepest_.assign(row_windows * window_rows, 0.0f);
  parallelFor(window_rows, 4, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      float* const steepest = steepest_.data() + j * row_windows;
      for (int row = j * kStride; row < std::min(j * kStride + kWindow, rows); ++row) {
        const float* const of_row = of_rows.data() + row * row_windows;
        for (int i = 0; i < windows_; ++i) steepest[i] = std::max(steepest[i], of_row[i]);
      }
    }
  });
}

}  // namespace emscape::emfield
