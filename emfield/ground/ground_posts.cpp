#include "emfield/ground/ground_posts.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {

double postSpacing_m(const scenario::Terrain* terrain) {
  constexpr double kOfSmoothEarth_m = 500;
  return terrain != nullptr ? terrain->postSpacing_m() : kOfSmoothEarth_m;
}

std::vector<double> postRanges(double farthest_m, double post_spacing_m) {
  constexpr double kMinStep_m = 2, kGrowth = 0.1;
  std::vector<double> ranges{0};
  while (ranges.back() < farthest_m) {
    const double step_m = std::min(post_spacing_m / 2, std::max(kMinStep_m, kGrowth * ranges.back()));
    ranges.push_back(ranges.back() + step_m);
  }
  return ranges;
}

GroundPosts groundPosts(const scenario::Terrain* terrain, const std::vector<double>& ranges_m) {
  GroundPosts ground;
  ground.is_smooth = terrain == nullptr;
  if (terrain != nullptr) ground.terrain = terrain->view();
  ground.ranges_m = ranges_m.data();
  ground.range_count = static_cast<int>(ranges_m.size());
  if (terrain != nullptr) {
    constexpr double kNear = 3, kMaxPerPost = 3;  // spacings of the terrain
    const double near_m = kNear * terrain->postSpacing_m();
    ground.near_count =
        static_cast<int>(std::lower_bound(ranges_m.begin(), ranges_m.end(), near_m) - ranges_m.begin());
    ground.crossings_per_m = kMaxPerPost / terrain->postSpacing_m();
  }
  constexpr double kMirrored_m = 500, kMirrored = 3;  // spacings
  const auto postAt = [&](double range_m) {
    return static_cast<int>(std::lower_bound(ranges_m.begin(), ranges_m.end(), range_m) - ranges_m.begin());
  };
  ground.clutter_first = std::min(postAt(kClutterFree_m), ground.range_count - 1);
  ground.clutter_end = std::clamp(postAt(std::min(kMirrored_m, kMirrored * postSpacing_m(terrain))),
                                  ground.clutter_first, ground.clutter_first + kMostClutterPosts - 2);
  return ground;
}

float highestPost_m(const scenario::TerrainView& terrain) {
  if (terrain.count != 1) return HUGE_VALF;
  const scenario::TerrainRaster& raster = terrain.rasters[0];
  // Posts beyond the limits of look-ups are not read.
  const int first_row = static_cast<int>(raster.first_row), first = static_cast<int>(raster.first_column);
  const int rows = static_cast<int>(std::ceil(raster.last_row)) + 1 - first_row;
  const int last = static_cast<int>(std::ceil(raster.last_column));
  std::vector<float> of_rows(static_cast<std::size_t>(rows), -HUGE_VALF);
  parallelFor(rows, 64, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      float& highest = of_rows[static_cast<std::size_t>(row)];
      const float* const posts_msl_m =
          raster.heights_msl_m + static_cast<long long>(first_row + row) * raster.columns;
      for (int i = first; i <= last; ++i)  // a void counts as infinite
        highest = posts_msl_m[i] <= highest    ? highest
                  : std::isnan(posts_msl_m[i]) ? HUGE_VALF
                                               : posts_msl_m[i];
    }
  });
  return *std::max_element(of_rows.begin(), of_rows.end());
}

std::vector<float> highestOfTiles(const scenario::TerrainRaster& raster, int& columns) {
  constexpr int kCells = HighestOfTiles::kCells;
  columns = (raster.columns - 2) / kCells + 1;
  const int rows = (raster.rows - 2) / kCells + 1;
  std::vector<float> highest_m(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                               -HUGE_VALF);
  parallelFor(rows, 8, [&](int begin, int end) {
    for (int tile_row = begin; tile_row < end; ++tile_row) {
      float* const of_row =
          highest_m.data() + static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(columns);
      const int last_row = std::min((tile_row + 1) * kCells, raster.rows - 1);
      for (int row = tile_row * kCells; row <= last_row; ++row) {
        const float* const posts_msl_m = raster.heights_msl_m + static_cast<long long>(row) * raster.columns;
        for (int tile = 0; tile < columns; ++tile) {
          const int last = std::min((tile + 1) * kCells, raster.columns - 1);
          for (int i = tile * kCells; i <= last; ++i)
            of_row[tile] = std::isnan(posts_msl_m[i]) ? HUGE_VALF : std::max(of_row[tile], posts_msl_m[i]);
        }
      }
    }
  });
  return highest_m;
}

}  // namespace emscape::emfield
