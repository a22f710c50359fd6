#include "emfield/terrain_bounds.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {

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
