/// Finds the maxima over the posts of several paths, of which most are never read: bounds of blocks leave
/// few.
#pragma once

#include <algorithm>
#include <cmath>

#include "emfield/excess/path_posts.h"

namespace emscape::emfield {

/// Maxima over the posts of each path. A path at infinity is not searched.
struct PathMaxima {
  float value[kPathLanes];
  int block[kPathLanes];     ///< that holds it; -1: none exceeds the start
  int is_bound[kPathLanes];  ///< the true value may be less

  /// @param isSearched(lane), start(lane)
  template <class IsSearched, class Start>
  PathMaxima(const IsSearched& isSearched, const Start& start) {
    for (int l = 0; l < kPathLanes; ++l) {
      value[l] = isSearched(l) ? start(l) : HUGE_VALF;
      block[l] = -1;
      is_bound[l] = 0;
    }
  }
  bool isSearched(int lane) const { return value[lane] < HUGE_VALF; }
  bool areAny() const {
    float least = HUGE_VALF;
    for (const float of_path : value) least = of_path < least ? of_path : least;
    return least < HUGE_VALF;
  }
};

class PathSearch {
 public:
  PathSearch(const SectorObstacles& obstacles, const SectorTerrain& terrain, const SectorBounds& bounds,
             PathPosts& posts)
      : obstacles_(obstacles),
        terrain_(terrain),
        bounds_(bounds),
        posts_(posts),
        visited_in_(obstacles.blocks.first_m.size()) {}

  /// @tparam kBare  of the ground without the clutter that raises profiles
  /// @param boundOf(lane, lowered_m, tx_slope, first_m, last_m)  bound of valueOf over obstacles at those
  /// ranges
  /// @param valueOf(lane, range_m, height_m)  of an obstacle
  /// @param most    start of the search; receives the maxima
  /// @param guess   blocks that are visited first; receives those of the maxima
  /// @param settle  called after that; may leave out paths, which are set to infinity
  template <bool kBare = false, class BoundOf, class ValueOf, class Settle>
  void find(const BoundOf& boundOf, const ValueOf& valueOf, PathMaxima& most, int* guess,
            const Settle& settle) {
    ++number_;
    const int blocks = terrain_.blocks();
    const auto visitOnce = [&](int block) {
      if (visited_in_[block] == number_) return;
      visited_in_[block] = number_;
      if (mayExceed(block, boundOf, most)) visit<kBare>(block, boundOf, valueOf, most);
    };
    for (int l = 0; l < kPathLanes; ++l) {
      if (guess[l] < blocks) visitOnce(guess[l]);
    }
    settle();
    // Blocks that may hold a maximum, those with the highest bounds first.
    constexpr int kGroup = SectorPosts::kGroup;
    candidates_.clear();
    for (int of_groups = 0; of_groups < groupsOf(groupsOf(blocks)); ++of_groups) {
      float of_group[kGroup], of_block[kGroup];
      setMargins(of_groups * kGroup, bounds_.groups(), obstacles_.groups, boundOf, most, of_group);
      for (int g = 0; g < kGroup; ++g) {
        if (!(of_group[g] > 0)) continue;
        const int begin = (of_groups * kGroup + g) * kGroup;
        setMargins(begin, bounds_.blocks(), obstacles_.blocks, boundOf, most, of_block);
        for (int b = 0; b < kGroup; ++b) {
          if (of_block[b] > 0) candidates_.push_back({of_block[b], begin + b});
        }
      }
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.margin > b.margin; });
    for (const Candidate& candidate : candidates_) visitOnce(candidate.block);
    unsigned unknown = 0;
    for (int l = 0; l < kPathLanes; ++l) {
      if (!most.isSearched(l)) continue;
      if (most.block[l] >= 0) guess[l] = most.block[l];
      if (most.is_bound[l] != 0) unknown |= 1u << l;
    }
    if (unknown != 0) posts_.leave(unknown);
  }
  template <bool kBare = false, class BoundOf, class ValueOf>
  void find(const BoundOf& boundOf, const ValueOf& valueOf, PathMaxima& most, int* guess) {
    find<kBare>(boundOf, valueOf, most, guess, [] {});
  }

 private:
  struct Candidate {
    float margin;
    int block;
  };

  /// By how much the bounds of kGroup blocks or groups exceed the maximum of some path; not positive: of
  /// none.
  template <class BoundOf>
  void setMargins(int begin, const ObstacleBounds& bounds, const ObstacleRanges& ranges,
                  const BoundOf& boundOf, const PathMaxima& most, float* margin) const {
    constexpr int kGroup = SectorPosts::kGroup;
    const float *const lowered_m = bounds.lowered_m.data() + begin, *const tx_slope =
                                                                        bounds.tx_slope.data() + begin;
    const float *const first_m = ranges.first_m.data() + begin, *const last_m = ranges.last_m.data() + begin;
    std::fill_n(margin, kGroup, 0.0f);
    for (int l = 0; l < kPathLanes; ++l) {
      if (!most.isSearched(l)) continue;
      const float farthest_m = posts_.paths().last_m[l], value = most.value[l];
#pragma omp simd
      for (int i = 0; i < kGroup; ++i) {
        const float end_m = last_m[i] < farthest_m ? last_m[i] : farthest_m;
        const float over = boundOf(l, lowered_m[i], tx_slope[i], first_m[i], end_m) - value;
        const float here = first_m[i] < farthest_m ? over : 0.0f;
        margin[i] = here > margin[i] ? here : margin[i];
      }
    }
  }
  template <class BoundOf>
  bool mayExceed(int block, const BoundOf& boundOf, const PathMaxima& most) const {
    const float lowered_m = bounds_.blocks().lowered_m[block], tx_slope = bounds_.blocks().tx_slope[block];
    const float first_m = obstacles_.blocks.first_m[block], last_m = obstacles_.blocks.last_m[block];
    const float* const farthest_m = posts_.paths().last_m;
    int is_any = 0;
#pragma omp simd reduction(| : is_any)
    for (int l = 0; l < kPathLanes; ++l) {
      const float end_m = last_m < farthest_m[l] ? last_m : farthest_m[l];
      const bool exceeds = boundOf(l, lowered_m, tx_slope, first_m, end_m) > most.value[l];
      is_any |= exceeds & (first_m < farthest_m[l]);
    }
    return is_any != 0;
  }

  template <bool kBare, class BoundOf, class ValueOf>
  void visit(int block, const BoundOf& boundOf, const ValueOf& valueOf, PathMaxima& most) {
    posts_.read(block);
    const int count = posts_.count();
    for (int n = 0; n < count; ++n) visitPost<kBare>(n, block, valueOf, most);
    if (!posts_.areRaised()) return;
    // Posts for clutter are many, and each may be those of few paths: bounded at their own ranges first.
    const float lowered_m = bounds_.blocks().lowered_m[block], tx_slope = bounds_.blocks().tx_slope[block];
    const auto mayExceedAt = [&](const float* at_m) {
      int is_any = 0;
#pragma omp simd reduction(| : is_any)
      for (int l = 0; l < kPathLanes; ++l) {
        const bool exceeds = boundOf(l, lowered_m, tx_slope, at_m[l], at_m[l]) > most.value[l];
        is_any |= exceeds & (at_m[l] < HUGE_VALF);
      }
      return is_any != 0;
    };
    posts_.readClutterPosts(block, mayExceedAt, [&](int n) { visitPost<kBare>(n, block, valueOf, most); });
  }
  template <bool kBare, class ValueOf>
  void visitPost(int n, int block, const ValueOf& valueOf, PathMaxima& most) {
    const PathPosts::Slot& slot = posts_[n];
    unsigned doubtful = 0;
    if (!kBare && posts_.areRaised()) {
      const float cover_m = terrain_.cover_m()[block];
      unsigned raised = 0;
#pragma omp simd reduction(| : raised)
      for (int l = 0; l < kPathLanes; ++l) {
        const float highest = valueOf(l, slot.range_m[l], slot.height_m[l] + cover_m);
        raised |= (highest > most.value[l] ? 1u : 0u) << l;
      }
      if (raised == 0) return;
      if (!(cover_m < HUGE_VALF)) posts_.leave(raised);
      doubtful = posts_.raise(n, raised);
    }
#pragma omp simd
    for (int l = 0; l < kPathLanes; ++l) {
      const float value = valueOf(l, slot.range_m[l], slot.height_m[l]);
      const bool is_more = value > most.value[l];
      most.value[l] = is_more ? value : most.value[l];
      most.block[l] = is_more ? block : most.block[l];
      most.is_bound[l] = is_more ? static_cast<int>(doubtful >> l & 1) : most.is_bound[l];
    }
  }

  const SectorObstacles& obstacles_;
  const SectorTerrain& terrain_;
  const SectorBounds& bounds_;
  PathPosts& posts_;
  int number_ = 0;  ///< of the search
  std::vector<Candidate> candidates_;
  std::vector<int> visited_in_;  ///< per block: number of the last search that came to it
};

}  // namespace emscape::emfield
