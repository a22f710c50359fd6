#include "emfield/excess/surface_horizon.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"
#include "emfield/excess/path_sectors.h"
#include "emfield/excess/sector_terrain.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

/// Bounds of the slopes from the station to the posts of a sector's paths, per block of posts.
struct SlopeBounds {
  std::vector<float> highest;  ///< no slope in the block is larger; infinity beside a void
  std::vector<int>
      steep_before;  ///< the last block before this one that may hold the steepest slope of those; -1: none
  std::vector<float> highest_so_far;  ///< the largest of this block and those before it
  std::vector<float>
      lowest_so_far;  ///< the steepest slope to the posts of this block and those before it is no smaller
};

/// Of the obstacles in groups (SectorPosts).
struct ObstacleTerms {
  HorizonGeometry<float> geometry;
  std::vector<RangeTerms<float>> terms;
  std::vector<float> per_m;  ///< bound of the change of slope with height
};

EMSCAPE_SIMD_CLONES void setSlopeBounds(const ObstacleTerms& obstacles, const SectorTerrain& terrain,
                                        SlopeBounds& bounds) {
  constexpr int kPosts = SectorPosts::kBlock, kBlocks = SectorPosts::kGroup;
  const HorizonGeometry<float> geometry = obstacles.geometry;
  const int blocks = terrain.blocks();
  float highest_so_far = -HUGE_VALF, lowest_so_far = -HUGE_VALF;
  int steep = -1;
  for (int first_block = 0; first_block < blocks; first_block += kBlocks) {
    float highest[kBlocks], lowest[kBlocks];
    std::fill_n(highest, kBlocks, -HUGE_VALF);
    std::fill_n(lowest, kBlocks, -HUGE_VALF);
    const float* const slack_m = terrain.acrossSlack_m() + first_block;
    for (int j = 0; j < kPosts; ++j) {
      const int first = first_block * kPosts + j * kBlocks;
      const float* const height_msl_m = terrain.height_msl_m() + first;
      const RangeTerms<float>* const terms = obstacles.terms.data() + first;
      const float* const per_m = obstacles.per_m.data() + first;
#pragma omp simd
      for (int n = 0; n < kBlocks; ++n) {
        const float slope = geometry.slopeTo(height_msl_m[n], terms[n]), between = slack_m[n] * per_m[n];
        highest[n] = slope + between > highest[n] ? slope + between : highest[n];
        lowest[n] = slope - between > lowest[n] ? slope - between : lowest[n];
      }
    }
    for (int n = 0; n < std::min(kBlocks, blocks - first_block); ++n) {
      const int block = first_block + n;
      while (steep >= 0 && bounds.highest[steep] < lowest_so_far) steep = bounds.steep_before[steep];
      bounds.steep_before[block] = steep;
      steep = block;
      highest_so_far = std::max(highest_so_far, highest[n]);
      lowest_so_far = std::max(lowest_so_far, lowest[n]);
      bounds.highest[block] = highest[n];
      bounds.highest_so_far[block] = highest_so_far;
      bounds.lowest_so_far[block] = lowest_so_far;
    }
  }
}

/// True if no height of a column, which ascend, is between two edges.
bool areAlike(const ExcessGrid& grid, float lower_m, float upper_m) {
  const float *const end = grid.t_m + grid.layers, *const above = std::lower_bound(grid.t_m, end, lower_m);
  return above == end || *above >= upper_m;
}

/// A range that contains the steepest slope to the posts of a path.
struct SlopeRange {
  float low, high;
};

/// The columns of one sector at a time.
class SectorShadows {
 public:
  SectorShadows(const ShadowTask& task, const ExcessGrid& grid, const ObstacleTerms& obstacles,
                std::vector<char>& is_left, float* edges_m)
      : task_(task),
        grid_(grid),
        obstacles_(obstacles),
        is_left_(is_left),
        edges_m_(edges_m),
        heights_m_(static_cast<std::size_t>(task.ground.range_count)) {}

  void find(const SectorPath& to, float aside, const SectorTerrain& terrain, const SlopeBounds& bounds) {
    constexpr int kMinPosts = 16;  // shorter paths are read as fast
    const int before = task_.ground.lastBefore(to.distance_m), last = before / SectorPosts::kBlock;
    if (before < kMinPosts || before >= terrain.posts() || bounds.highest_so_far[last] == HUGE_VALF) return;
    const auto column = static_cast<std::size_t>(to.column);
    const float base_msl_m = grid_.columns[column].height_msl_m[0];
    const RangeTerms<float> terms = obstacles_.geometry.termsAt(to.distance_m);
    const auto edgeOf = [&](float slope) {
      return task_.edgeHeight_m(slope, to.distance_m, terms) - base_msl_m;
    };
    const auto isDecided = [&](const SlopeRange& range) {
      edges_m_[column] = edgeOf(range.high);
      return areAlike(grid_, edgeOf(range.low), edges_m_[column]);
    };
    is_left_[column] = 0;
    // The last block may be beyond the column.
    SlopeRange range{bounds.lowest_so_far[last - 1], bounds.highest_so_far[last]};
    if (isDecided(range)) return;
    range = {range.low, -HUGE_VALF};
    int first_block = last, last_block = 0;
    for (int block = last; block >= 0 && bounds.highest_so_far[block] >= range.low;
         block = bounds.steep_before[block]) {
      if (bounds.highest[block] < range.low) continue;
      visit(block, before, aside, terrain, range);
      first_block = block;
      last_block = std::max(last_block, block);
    }
    if (isDecided(range)) return;
    const int first = std::max(first_block * SectorPosts::kBlock, 1);
    const int end = std::min((last_block + 1) * SectorPosts::kBlock, before + 1);
    readPostsCpu(task_.station, task_.ground, grid_.coordinatesOf(task_.station, column, 0), first, end,
                 heights_m_.data());
    edges_m_[column] = edgeOf(
        grazingSlopeCpu(task_.geometry(), heights_m_.data() + first, task_.terms + first, end - first));
  }

 private:
  /// Widens a range by the slopes to the posts of a block.
  void visit(int block, int before, float aside, const SectorTerrain& terrain, SlopeRange& range) const {
    constexpr int kPosts = SectorPosts::kBlock;
    constexpr float kError_m = 0.1f;  // of heights at the sector's positions, which are within centimetres
    const int first = block * kPosts;
    float heights_m[kPosts];
    terrain.readBlock(block, aside, heights_m);
    for (int i = std::max(first, 1); i < std::min(first + kPosts, before + 1); ++i) {
      const float slope = obstacles_.geometry.slopeTo(heights_m[i - first], task_.terms[i]);
      const float error = kError_m * obstacles_.per_m[SectorPosts::inGroups(i)];
      range.low = std::max(range.low, slope - error);
      range.high = std::max(range.high, slope + error);
    }
  }

  const ShadowTask& task_;
  const ExcessGrid& grid_;
  const ObstacleTerms& obstacles_;
  std::vector<char>& is_left_;
  float* edges_m_;
  std::vector<float> heights_m_;
};

}  // namespace

std::vector<char> findSurfaceShadows(const ShadowTask& task, const ExcessGrid& grid,
                                     const TerrainBounds& bounds, float* edges_m) {
  std::vector<char> is_left(grid.column_count, 1);
  const SectorPosts posts(task.station, task.ground);
  const int sector_count = PathSectors::countFor(task.ground, grid.column_count);
  if (!posts.isUsable() || sector_count == 0) return is_left;
  const PathSectors sectors(task.station, grid, sector_count);
  ObstacleTerms obstacles{task.geometry(), {}, {}};
  for (const int post : posts.postsInGroups()) {
    constexpr float kMore = 1.02f;  // of heights of +-40 km
    obstacles.terms.push_back(task.terms[post]);
    obstacles.per_m.push_back(kMore / (task.terms[post].sine * obstacles.geometry.effective_earth_radius_m));
  }
  for (std::size_t c = 0; c < grid.column_count; ++c) {
    if (!grid.isWithoutGround(c)) continue;
    edges_m[c] = NAN;  // without reading the path, whose last posts are seldom known
    is_left[c] = 0;
  }
  parallelFor(sectors.count(), 16, [&](int begin, int end) {
    SectorTerrain terrain(task.station, task.ground, bounds, posts);
    SlopeBounds slopes;
    slopes.steep_before.resize(static_cast<std::size_t>(posts.blocks()));
    for (auto* const array : {&slopes.highest, &slopes.highest_so_far, &slopes.lowest_so_far}) {
      array->resize(static_cast<std::size_t>(posts.blocks()));
    }
    SectorShadows shadows(task, grid, obstacles, is_left, edges_m);
    for (int sector = begin; sector < end; ++sector) {
      checkpoint();
      const double farthest_m = sectors.farthest_m(sector);
      if (farthest_m == 0) continue;
      const double half_width_rad = sectors.halfWidth_rad(sector);
      terrain.read(sectors.middle(sector), half_width_rad, task.ground.lastBefore(farthest_m) + 1);
      if (terrain.blocks() == 0) continue;
      setSlopeBounds(obstacles, terrain, slopes);
      for (const SectorPath* to = sectors.begin(sector); to < sectors.end(sector); ++to) {
        shadows.find(*to, static_cast<float>(to->aside_rad / half_width_rad), terrain, slopes);
      }
    }
  });
  return is_left;
}

}  // namespace emscape::emfield
