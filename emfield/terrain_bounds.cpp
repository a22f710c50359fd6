#include "emfield/terrain_bounds.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

/// Between posts heights are bilinear: no slope along a row or column is larger than one between neighbours.
double steepestOf(const scenario::TerrainRaster& raster) {
  std::vector<float> rises_m(static_cast<std::size_t>(raster.rows)), runs_m(rises_m.size());
  parallelFor(raster.rows, 16, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float* const posts = raster.heights_msl_m + static_cast<long long>(j) * raster.columns;
      const float* const north = j + 1 < raster.rows ? posts + raster.columns : posts;
      float along = 0, across = 0;
      for (int i = 0; i < raster.columns; ++i) {
        const float to_east = i + 1 < raster.columns ? std::fabs(posts[i + 1] - posts[i]) : 0;
        const float to_north = std::fabs(north[i] - posts[i]);
        along = to_east > along ? to_east : along;
        across = to_north > across ? to_north : across;
      }
      runs_m[j] = along;
      rises_m[j] = across;
    }
  });
  // A lower bound of the earth's radii of curvature, and of the radius of a parallel.
  constexpr double kMinRadius_m = 6335e3;
  const double north_rad = raster.south_rad + (raster.rows - 1) / raster.posts_per_rad_lat;
  const double parallel_m = kMinRadius_m * std::min(std::cos(raster.south_rad), std::cos(north_rad));
  if (!(parallel_m > 0)) return HUGE_VAL;
  const auto along = static_cast<double>(*std::max_element(runs_m.begin(), runs_m.end()));
  const auto across = static_cast<double>(*std::max_element(rises_m.begin(), rises_m.end()));
  return std::hypot(along * raster.posts_per_rad_lon / parallel_m,
                    across * raster.posts_per_rad_lat / kMinRadius_m);
}

}  // namespace

TerrainBounds::TerrainBounds(const scenario::TerrainView& terrain) {
  constexpr int kMaxPosts = 1 << 15;  // of a row or column: positions within 1/256 post as float
  constexpr int kWindow = kStride + static_cast<int>(kMaxExtent) + 1;
  if (terrain.count == 0) return;
  const scenario::TerrainRaster& raster = terrain.rasters[0];
  if (raster.columns > kMaxPosts || raster.rows > kMaxPosts) return;
  const auto higher = [](float a, float b) { return a >= b ? a : b == b ? b : HUGE_VALF; };
  windows_ = (raster.columns + kStride - 1) / kStride;
  const int rows = (raster.rows + kStride - 1) / kStride;
  const std::size_t row_windows = static_cast<std::size_t>(windows_);
  std::vector<float> of_rows(row_windows * raster.rows);
  parallelFor(raster.rows, 16, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float* const posts = raster.heights_msl_m + static_cast<long long>(j) * raster.columns;
      for (int i = 0; i < windows_; ++i) {
        float highest = -HUGE_VALF;
        const int last = std::min(i * kStride + kWindow, raster.columns);
        for (int post = i * kStride; post < last; ++post) highest = higher(highest, posts[post]);
        of_rows[j * row_windows + i] = highest;
      }
    }
  });
  steepest_ = steepestOf(raster);
  highest_msl_m_.assign(row_windows * rows, -HUGE_VALF);
  parallelFor(rows, 4, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      float* const highest = highest_msl_m_.data() + j * row_windows;
      const int last = std::min(j * kStride + kWindow, raster.rows);
      for (int row = j * kStride; row < last; ++row) {
        for (int i = 0; i < windows_; ++i) highest[i] = higher(highest[i], of_rows[row * row_windows + i]);
      }
    }
  });
}

}  // namespace emscape::emfield
