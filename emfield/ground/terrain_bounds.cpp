#include "emfield/ground/terrain_bounds.h"

#include <algorithm>
#include <cmath>

#include "emfield/ground/read_cover.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using scenario::TerrainRaster;

constexpr int kStride = TerrainBounds::kStride;
constexpr int kWindow = kStride + static_cast<int>(TerrainBounds::kMaxExtent) + 1;  // cells

int windowsOf(int cells) {
  return (cells + kStride - 1) / kStride;
}

/// The largest value >= 0 of the cells of each window.
/// @param valuesOf(j, values)  sets the values of row j of cells
template <class ValuesOf>
std::vector<float> largestOfWindows(const TerrainRaster& raster, const ValuesOf& valuesOf) {
  const int rows = raster.rows - 1, windows = windowsOf(raster.columns - 1), window_rows = windowsOf(rows);
  const auto row_windows = static_cast<std::size_t>(windows);
  std::vector<float> of_rows(row_windows * rows);
  parallelFor(rows, 16, [&](int begin, int end) {
    std::vector<float> values(static_cast<std::size_t>(windows * kStride + kWindow), 0.0f);
    for (int j = begin; j < end; ++j) {
      valuesOf(j, values.data());
      float* const largest_of = of_rows.data() + j * row_windows;
      for (int i = 0; i < windows; ++i) {
        float largest = 0;
        for (int n = 0; n < kWindow; ++n) largest = std::max(largest, values[i * kStride + n]);
        largest_of[i] = largest;
      }
    }
  });
  std::vector<float> all(row_windows * window_rows, 0.0f);
  parallelFor(window_rows, 4, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      float* const largest = all.data() + j * row_windows;
      for (int row = j * kStride; row < std::min(j * kStride + kWindow, rows); ++row) {
        const float* const of_row = of_rows.data() + row * row_windows;
        for (int i = 0; i < windows; ++i) largest[i] = std::max(largest[i], of_row[i]);
      }
    }
  });
  return all;
}

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

/// Upper bounds of a surface above the ground in the cells north of a row of posts of both;
/// infinity where a post is void.
void differencesOfRow(const float* surface, const float* ground, int columns, float* highest_m) {
  constexpr float kRounding_m = 0.01f;
#pragma omp simd
  for (int i = 0; i < columns - 1; ++i) {
    const auto at = [&](int post) {
      const float above = surface[post] - ground[post];
      return above == above ? above + kRounding_m : HUGE_VALF;
    };
    const float west = std::max(at(i), at(i + columns)), east = std::max(at(i + 1), at(i + 1 + columns));
    highest_m[i] = std::max(west, east);
  }
}

bool isSameGrid(const TerrainRaster& a, const TerrainRaster& b) {
  return a.columns == b.columns && a.rows == b.rows && a.south_rad == b.south_rad &&
         a.west_rad == b.west_rad && a.posts_per_rad_lat == b.posts_per_rad_lat &&
         a.posts_per_rad_lon == b.posts_per_rad_lon && a.first_column == b.first_column &&
         a.last_column == b.last_column && a.first_row == b.first_row && a.last_row == b.last_row;
}

}  // namespace

TerrainBounds::TerrainBounds(const scenario::TerrainView& terrain) {
  constexpr int kMaxPosts = 1 << 15;  // of a row or column: positions within 1/256 post as float
  if (terrain.count == 0) return;
  const TerrainRaster& raster = terrain.rasters[0];
  if (raster.columns > kMaxPosts || raster.rows > kMaxPosts) return;
  // A lower bound of the earth's radii of curvature, and of the radius of a parallel.
  constexpr double kMinRadius_m = 6335e3;
  const double north_rad = raster.south_rad + (raster.rows - 1) / raster.posts_per_rad_lat;
  const double parallel_m = kMinRadius_m * std::min(std::cos(raster.south_rad), std::cos(north_rad));
  if (!(parallel_m > 0)) return;
  const auto per_post_lon = static_cast<float>(raster.posts_per_rad_lon / parallel_m);
  const auto per_post_lat = static_cast<float>(raster.posts_per_rad_lat / kMinRadius_m);

  const int columns = raster.columns - 1;  // of cells
  windows_ = windowsOf(columns);
  steepest_ = largestOfWindows(raster, [&](int j, float* slope) {
    const float* const posts = raster.heights_msl_m + static_cast<long long>(j) * raster.columns;
    slopesOfRow(posts, posts + raster.columns, columns, per_post_lon, per_post_lat, slope);
  });
  if (terrain.hasCover()) boundCover(terrain);
}

void TerrainBounds::boundCover(const scenario::TerrainView& terrain) {
  const TerrainRaster& raster = terrain.rasters[0];
  if (terrain.surface_count == 0) {  // a class may be anywhere
    highest_cover_m_.assign(steepest_.size(), ClassCovers(terrain.cover).highest_m());
  } else if (terrain.surface_count == 1 && isSameGrid(raster, terrain.surfaces[0])) {
    highest_cover_m_ = largestOfWindows(raster, [&](int j, float* highest_m) {
      const long long row = static_cast<long long>(j) * raster.columns;
      differencesOfRow(terrain.surfaces[0].heights_msl_m + row, raster.heights_msl_m + row, raster.columns,
                       highest_m);
    });
  }
}

}  // namespace emscape::emfield
