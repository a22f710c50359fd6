/// Finds the maxima over the posts of a path, of which most are never read: bounds of blocks leave few.
#pragma once

#include <algorithm>
#include <cmath>

#include "emfield/excess/path_posts.h"

namespace emscape::emfield {

/// A search for a maximum of the posts of a path.
struct Maximum {
  float value;
  int block;              ///< that holds it, or a guess
  bool is_bound = false;  ///< the true value may be less
};

class PathSearch {
 public:
  PathSearch(const SectorObstacles& obstacles, const SectorTerrain& terrain, const SectorBounds& bounds,
             PathPosts& posts)
      : obstacles_(obstacles), terrain_(terrain), bounds_(bounds), posts_(posts) {}

  /// @param boundOf(lowered_m, tx_slope, first_m, last_m)  bound of valueOf over obstacles at those ranges
  /// @param valueOf(range_m, height_m)                     of an obstacle
  /// @param most  start of the search; receives the maximum
  template <class BoundOf, class ValueOf>
  void operator()(const BoundOf& boundOf, const ValueOf& valueOf, Maximum& most) const {
    const int count = posts_.path().blocks, guess = std::min(most.block, count - 1);
    const ObstacleBounds& blocks = bounds_.blocks();
    const float last_m = std::min(obstacles_.blocks.last_m[guess], posts_.path().last_m);
    if (boundOf(blocks.lowered_m[guess], blocks.tx_slope[guess], obstacles_.blocks.first_m[guess], last_m) >
        most.value)
      visit(guess, valueOf, most);
    const auto visitGroup = [&](int group) {
      descend(group, count, blocks, obstacles_.blocks, boundOf, most, [&](int block) {
        if (block != guess) visit(block, valueOf, most);
      });
    };
    const int groups = groupsOf(count);
    for (int of_groups = groupsOf(groups) - 1; of_groups >= 0; --of_groups)
      descend(of_groups, groups, bounds_.groups(), obstacles_.groups, boundOf, most, visitGroup);
    if (most.is_bound) posts_.leave();
  }

  /// A lower bound, from the posts of one block without their clutter.
  template <class ValueOf>
  float leastOf(int block, const ValueOf& valueOf) const {
    posts_.read(block);
    if (posts_.areRaised() && posts_.isRaised(block)) return -HUGE_VALF;
    const float *const range_m = posts_.range_m(block), *const height_m = posts_.height_m(block);
    float largest = -HUGE_VALF;
#pragma omp simd reduction(max : largest)
    for (int i = 0; i < PathPosts::kCrossings; ++i) {
      const float value = valueOf(range_m[i], height_m[i]);
      largest = value > largest ? value : largest;
    }
    return largest;
  }

  /// The same among the posts of one block.
  template <class ValueOf>
  void visit(int block, const ValueOf& valueOf, Maximum& most) const {
    constexpr int kCrossings = PathPosts::kCrossings, kOfBlock = PathPosts::kOfBlock;
    constexpr float kRounding = 1e-5f;
    posts_.read(block);
    if (posts_.areRaised()) {
      posts_.eachClutterPost(block, [&](const PathPosts::ClutterPost& post) {
        const float value = valueOf(post.range_m, post.height_m);
        if (value > most.value) most = {value, block, post.is_doubtful};
      });
    }
    const float *const range_m = posts_.range_m(block), *const height_m = posts_.height_m(block);
    const auto largestOf = [&](int begin, int end, float raised_m) {
      float largest = -HUGE_VALF;
#pragma omp simd reduction(max : largest)
      for (int i = begin; i < end; ++i) {
        const float value = valueOf(range_m[i], height_m[i] + raised_m);
        largest = value > largest ? value : largest;
      }
      return largest;
    };
    const auto largestOfAll = [&](float raised_m) {
      const float largest = largestOf(0, kCrossings, raised_m);
      if (posts_.used(block) == kCrossings) return largest;
      return std::max(largest, largestOf(kCrossings, kOfBlock, raised_m));
    };
    if (posts_.areRaised() && !posts_.isRaised(block)) {
      const float cover_m = terrain_.cover_m()[block];
      if (!(largestOfAll(cover_m) > most.value)) return;
      if (!(cover_m < HUGE_VALF)) posts_.leave();
      posts_.raise(block);
    }
    const float largest = largestOfAll(0);
    if (!(largest > most.value)) return;
    bool is_bound = false;
    for (unsigned left = posts_.areRaised() ? posts_.doubtful(block) : 0; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      is_bound = is_bound || valueOf(range_m[i], height_m[i]) >= largest - kRounding * std::fabs(largest);
    }
    most = {largest, block, is_bound};
  }

 private:
  /// Visits those of kGroup blocks or groups whose bound exceeds the maximum, the farthest first.
  /// @param count  of all blocks or groups
  template <class BoundOf, class Visit>
  void descend(int group, int count, const ObstacleBounds& bounds, const ObstacleRanges& ranges,
               const BoundOf& boundOf, const Maximum& most, const Visit& visitOne) const {
    constexpr int kGroup = SectorPosts::kGroup;
    const int begin = group * kGroup;
    const float *const lowered_m = bounds.lowered_m.data() + begin, *const tx_slope =
                                                                        bounds.tx_slope.data() + begin;
    const float *const first_m = ranges.first_m.data() + begin, *const last_m = ranges.last_m.data() + begin;
    const float least = most.value, farthest_m = posts_.path().last_m;
    float bound[kGroup];
    unsigned exceeds = 0;  // bit i: the bound of i exceeds the maximum
#pragma omp simd reduction(| : exceeds)
    for (int i = 0; i < kGroup; ++i) {
      bound[i] =
          boundOf(lowered_m[i], tx_slope[i], first_m[i], last_m[i] < farthest_m ? last_m[i] : farthest_m);
      exceeds |= (bound[i] > least ? 1u : 0u) << i;
    }
    if (count - begin < kGroup) exceeds &= (1u << (count - begin)) - 1;
    while (exceeds != 0) {
      const int i = 31 - __builtin_clz(exceeds);
      exceeds &= ~(1u << i);
      if (bound[i] > most.value) visitOne(begin + i);
    }
  }

  const SectorObstacles& obstacles_;
  const SectorTerrain& terrain_;
  const SectorBounds& bounds_;
  PathPosts& posts_;
};

}  // namespace emscape::emfield
