#include "emfield/excess/sector_bounds.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

constexpr int kBlock = SectorPosts::kBlock, kGroup = SectorPosts::kGroup;

/// Sets the bounds of blocks. @param tx_m  relative to the base
EMSCAPE_SIMD_CLONES void boundBlocks(const SectorObstacles& obstacles, const SectorTerrain& terrain,
                                     float tx_m, ObstacleBounds& bounds) {
  const float base = terrain.base_msl_m();
  for (int begin = 0; begin < terrain.blocks(); begin += kGroup) {
    const float *const slack_m = terrain.slack_m() + begin, *const cover_m = terrain.cover_m() + begin;
    float *const lowered = bounds.lowered_m.data() + begin, *const steepest = bounds.tx_slope.data() + begin;
    std::fill_n(lowered, kGroup, -HUGE_VALF);
    std::fill_n(steepest, kGroup, -HUGE_VALF);
    for (int j = 0; j < kBlock; ++j) {
      const int first = begin * kBlock + j * kGroup;
      const float* const height_msl_m = terrain.height_msl_m() + first;
      const float* const lowering_m = obstacles.lowering_m.data() + first;
      const float* const has_clutter = obstacles.has_clutter.data() + first;
      const float* const per_nearest = obstacles.per_nearest.data() + first;
      const float* const per_farthest = obstacles.per_farthest.data() + first;
#pragma omp simd
      for (int n = 0; n < kGroup; ++n) {
        const float raised_m = has_clutter[n] > 0 ? cover_m[n] : 0.0f;
        const float here = height_msl_m[n] - base - lowering_m[n] + slack_m[n] + raised_m;
        const float above = here - tx_m, slope = above * (above > 0 ? per_nearest[n] : per_farthest[n]);
        lowered[n] = here > lowered[n] ? here : lowered[n];
        steepest[n] = slope > steepest[n] ? slope : steepest[n];
      }
    }
  }
}

}  // namespace

SectorObstacles::SectorObstacles(const propagation::DiffractionModel<float>& of_model, float of_tx_msl_m,
                                 const SectorPosts& of_posts, const GroundPosts& of_ground)
    : model(of_model), tx_msl_m(of_tx_msl_m), posts(of_posts), ground(of_ground) {
  blocks.first_m.assign(posts.first_m(), posts.first_m() + posts.blocks());
  blocks.last_m.assign(posts.last_m(), posts.last_m() + posts.blocks());
  const auto pad = [](ObstacleRanges& ranges) {
    const std::size_t padded = groupsOf(static_cast<int>(ranges.first_m.size())) * kGroup;
    for (auto* const range_m : {&ranges.first_m, &ranges.last_m}) range_m->resize(padded, range_m->back());
  };
  pad(blocks);
  for (std::size_t begin = 0; begin < blocks.first_m.size(); begin += kGroup) {
    groups.first_m.push_back(blocks.first_m[begin]);
    groups.last_m.push_back(blocks.last_m[begin + kGroup - 1]);
  }
  pad(groups);
  for (const int post : posts.postsInGroups()) {
    const float nearest_m = posts.nearest_m()[post], farthest_m = posts.farthest_m()[post];
    lowering_m.push_back(model.half_curvature * nearest_m * nearest_m);
    per_nearest.push_back(1 / nearest_m);
    per_farthest.push_back(1 / farthest_m);
    has_clutter.push_back(static_cast<double>(farthest_m) > kClutterFree_m ? 1.0f : 0.0f);
  }
}

SectorBounds::SectorBounds(const SectorObstacles& obstacles, const SectorTerrain& terrain)
    : obstacles_(obstacles), terrain_(terrain), highest_tx_slope_(obstacles.blocks.first_m.size()) {
  for (auto* const bounds : {&blocks_.lowered_m, &blocks_.tx_slope})
    bounds->resize(obstacles.blocks.first_m.size());
  for (auto* const bounds : {&groups_.lowered_m, &groups_.tx_slope})
    bounds->resize(obstacles.groups.first_m.size());
}

void SectorBounds::set() {
  tx_m_ = propagation::DiffractionModel<float>::raised_m(obstacles_.tx_msl_m - base_msl_m(), 0);
  sums_.clear();
  boundBlocks(obstacles_, terrain_, tx_m_, blocks_);
  const int blocks = terrain_.blocks();
  float steepest = -HUGE_VALF;
  for (int block = 0; block < blocks; ++block) {
    steepest = std::max(steepest, blocks_.tx_slope[block]);
    highest_tx_slope_[block] = steepest;
  }
  for (const auto& [of_blocks, of_groups] :
       {std::pair(&blocks_.lowered_m, &groups_.lowered_m), std::pair(&blocks_.tx_slope, &groups_.tx_slope)}) {
    std::fill(of_blocks->begin() + blocks, of_blocks->begin() + groupsOf(blocks) * kGroup, -HUGE_VALF);
    std::fill(of_groups->begin(), of_groups->end(), -HUGE_VALF);
    for (int group = 0; group < groupsOf(blocks); ++group) {
      const auto begin = of_blocks->begin() + group * kGroup;
      (*of_groups)[group] = *std::max_element(begin, begin + kGroup);
    }
  }
}

EMSCAPE_SIMD_CLONES void SectorBounds::setTrend() {
  const double* const ranges_m = obstacles_.ground.ranges_m;
  propagation::TerrainSums sums;
  double height_before_m = 0, differences_m2 = 0;
  differences_m2_.clear();
  for (int post = 0; post < terrain_.posts(); ++post) {
    const float above_m = terrain_.height_msl_m()[SectorPosts::inGroups(post)] - base_msl_m();
    const double height_m = post > 0 ? static_cast<double>(above_m) : 0;
    sums.add(ranges_m[std::max(post - 1, 0)], height_before_m, ranges_m[post], height_m);
    sums_.push_back(sums);
    height_before_m = height_m;
    if (post % kBlock != 0) continue;
    const int beyond = std::min(post + kBlock, obstacles_.posts.count() - 1);
    const double length_m = ranges_m[beyond] - ranges_m[std::max(post - 1, 0)];
    differences_m2 += 2 * length_m * static_cast<double>(terrain_.acrossSlack_m()[post / kBlock]);
    differences_m2_.push_back(differences_m2);
  }
}

EMSCAPE_SIMD_CLONES propagation::TerrainTrend<float> SectorBounds::highestTrend(const SectorPath& to,
                                                                                int before) {
  if (sums_.empty()) setTrend();
  const float ground_m = to.ground_msl_m - base_msl_m();
  propagation::TerrainSums sums = sums_[before];
  const float before_m = terrain_.height_msl_m()[SectorPosts::inGroups(before)] - base_msl_m();
  sums.add(obstacles_.ground.ranges_m[before], static_cast<double>(before_m), to.distance_m,
           static_cast<double>(ground_m));
  // The weight of a height in either end of the line is at most twice that in the mean height.
  const float most_m =
      2 * static_cast<float>(differences_m2_[before / kBlock]) / static_cast<float>(to.distance_m);
  return propagation::clearTrend(static_cast<float>(sums.start_m(to.distance_m)) + most_m,
                                 static_cast<float>(sums.end_m(to.distance_m)) + most_m, ground_m);
}

}  // namespace emscape::emfield
