#include "emfield/excess/surface_diffraction.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"
#include "emfield/excess/path_sectors.h"
#include "emfield/excess/sector_terrain.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "propagation/diffraction/bullington_lanes.h"

namespace emscape::emfield {
namespace {

using propagation::DiffractionModel;

constexpr int kBlock = SectorPosts::kBlock, kGroup = SectorPosts::kGroup;

/// Number of groups of kGroup that contain a number of blocks, or of groups.
int groupsOf(int count) {
  return (count + kGroup - 1) / kGroup;
}

/// Bounds of the blocks of a sector's paths. Heights are relative to the ground below the emitter; "lowered"
/// heights are minus the earth's bulge r^2 / (2 a). Arrays, also those of groups, are padded to whole groups.
struct SectorBounds {
  float base_msl_m = 0;
  float tx_m = 0;
  std::vector<float> lowered_m;         ///< largest lowered height of an obstacle
  std::vector<float> tx_slope;          ///< largest slope from the transmitter to a lowered obstacle
  std::vector<float> highest_tx_slope;  ///< the largest over this block and all before it
  /// The last block before this one that may hold the largest slope of those before this one; -1: none.
  std::vector<int> steep_before;
  /// The same of groups.
  std::vector<float> group_lowered_m, group_tx_slope;
};

/// The line fitted to the terrain in the middle of a sector, for paths that are not clear of the smooth earth
/// above their own ground; made when first needed.
struct SectorTrend {
  /// Per block: sums of the intervals that end at or before its first post.
  std::vector<propagation::TerrainSums> before;
  /// Per block: integral over twice the range of the differences of a path's heights from the middle's, from
  /// the emitter to beyond the block; at most.
  std::vector<float> differences_m2;
};

/// Values common to all paths.
struct Posts {
  DiffractionModel<float> model;
  const double* exact_range_m;
  const float *range_m, *part;
  int count;
  const float *first_m, *last_m;              ///< per block: range of its first and last obstacle
  const float *group_first_m, *group_last_m;  ///< per group
  /// Of the obstacles in groups (SectorPosts): the earth's bulge r^2 / (2 a), and 1 / r.
  const float *lowering_m, *per_range;
};

/// Work of one thread.
struct PathMemory {
  std::vector<float> height_m;  ///< of the posts of the blocks that were read
  std::vector<int> read_for;    ///< per block: number of the path for which it was read
  std::vector<float> rx_m;      ///< heights of the receivers, as inputs of the model
  std::vector<int> rx_block,
      nu_block;  ///< per height: the blocks that determined the loss of the previous path
  int tx_block = 0;
  bool is_unknown = false;  ///< a void was read
  SectorTrend trend;
  /// Paths of the sector that were searched, and of their receivers, path by path: nu and distance of the
  /// edge, and the loss.
  std::vector<const SectorPath*> searched;
  std::vector<float> nu, distance_m, loss_db;
};

/// A search for a maximum of the posts of a path.
struct Maximum {
  float value;
  int block;  ///< that holds it
};

/// The path to a column.
struct Path {
  float distance_m;
  int before;  ///< last post before the receivers
  int blocks;
  int number;
  float aside;  ///< in the sector, -1..1
};

/// Finds the maxima over the posts of a path.
class Search {
 public:
  Search(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds, PathMemory& memory,
         const Path& path)
      : posts_(posts), terrain_(terrain), bounds_(bounds), memory_(memory), path_(path) {}

  /// @param boundOf(lowered_m, tx_slope, first_m, last_m)  bound of valueOf over obstacles at those ranges
  /// @param valueOf(range_m, height_m)                     of an obstacle
  /// @param most  start of the search; receives the maximum
  template <class BoundOf, class ValueOf>
  void operator()(const BoundOf& boundOf, const ValueOf& valueOf, Maximum& most) const {
    const int guess = std::min(most.block, path_.blocks - 1);
    const float before_m = posts_.range_m[path_.before];
    const auto clipped = [before_m](float last_m) { return last_m < before_m ? last_m : before_m; };
    if (boundOf(bounds_.lowered_m[guess], bounds_.tx_slope[guess], posts_.first_m[guess],
                clipped(posts_.last_m[guess])) > most.value) {
      visit(guess, valueOf, most);
    }
    const auto visitBlock = [&](int block) {
      if (block != guess) visit(block, valueOf, most);
    };
    const auto visitGroup = [&](int group) {
      descend(group, path_.blocks, bounds_.lowered_m.data(), bounds_.tx_slope.data(), posts_.first_m,
              posts_.last_m, clipped, boundOf, most, visitBlock);
    };
    const int groups = groupsOf(path_.blocks);
    for (int of_groups = groupsOf(groups) - 1; of_groups >= 0; --of_groups) {
      descend(of_groups, groups, bounds_.group_lowered_m.data(), bounds_.group_tx_slope.data(),
              posts_.group_first_m, posts_.group_last_m, clipped, boundOf, most, visitGroup);
    }
  }

  /// Finds the largest slope from the transmitter.
  /// @param slopeOf(range_m, height_m)  of an obstacle
  /// @param most                        as above
  template <class SlopeOf>
  void findSteepest(const SlopeOf& slopeOf, Maximum& most) const {
    const int guess = std::min(most.block, path_.blocks - 1);
    visit(guess, slopeOf, most);
    for (int block = path_.blocks - 1; block >= 0 && bounds_.highest_tx_slope[block] > most.value;
         block = bounds_.steep_before[block]) {
      if (block != guess && bounds_.tx_slope[block] > most.value) visit(block, slopeOf, most);
    }
  }

 private:
  /// Visits those of kGroup blocks or groups whose bound exceeds the maximum, the farthest first.
  /// @param count  of all blocks or groups
  template <class Clipped, class BoundOf, class Visit>
  static void descend(int group, int count, const float* lowered_m, const float* tx_slope,
                      const float* first_m, const float* last_m, const Clipped& clipped,
                      const BoundOf& boundOf, const Maximum& most, const Visit& visitOne) {
    const int begin = group * kGroup;
    const float least = most.value;
    float bound[kGroup];
    unsigned exceeds = 0;  // bit i: the bound of i exceeds the maximum
#pragma omp simd reduction(| : exceeds)
    for (int i = 0; i < kGroup; ++i) {
      bound[i] =
          boundOf(lowered_m[begin + i], tx_slope[begin + i], first_m[begin + i], clipped(last_m[begin + i]));
      exceeds |= (bound[i] > least ? 1u : 0u) << i;
    }
    if (count - begin < kGroup) exceeds &= (1u << (count - begin)) - 1;
    while (exceeds != 0) {
      const int i = 31 - __builtin_clz(exceeds);
      exceeds &= ~(1u << i);
      if (bound[i] > most.value) visitOne(begin + i);
    }
  }

  template <class ValueOf>
  void visit(int block, const ValueOf& valueOf, Maximum& most) const {
    const int first = block * kBlock, count = std::min(kBlock, path_.before + 1 - first);
    const float* const height_m = heightsOf(block);
    const float* const range_m = posts_.range_m + first;
    const auto largestOf = [&](int begin, int end) {
      float largest = -HUGE_VALF;
#pragma omp simd reduction(max : largest)
      for (int i = begin; i < end; ++i) {
        const float value = valueOf(range_m[i], height_m[i]);
        largest = value > largest ? value : largest;
      }
      return largest;
    };
    const bool is_whole = first > 0 && count == kBlock;  // vectors of a known size
    const float largest = is_whole ? largestOf(0, kBlock) : largestOf(first == 0 ? 1 : 0, count);
    if (largest > most.value) most = {largest, block};
  }

  /// Posts of a block, relative to the base.
  const float* heightsOf(int block) const {
    const int first = block * kBlock;
    float* const height_m = memory_.height_m.data() + first;
    if (memory_.read_for[block] == path_.number) return height_m;
    memory_.read_for[block] = path_.number;
    const SectorChord& chord = terrain_.chordOf(block);
    const auto at = [s = path_.aside](const Parabola<float>* of) {
      Parabola<float> here;
      for (int n = 0; n < 3; ++n) here.c[n] = of[0].c[n] + s * (of[1].c[n] + s * of[2].c[n]);
      return here;
    };
    const Parabola<float> column = at(chord.column), row = at(chord.row);
    const float* const corner = chord.corner_msl_m;
    const float* const parts = posts_.part + first;
    const int row_posts = terrain_.rowPosts();
    const float base_msl_m = bounds_.base_msl_m;
    const int count = std::min(kBlock, path_.before + 1 - first);
    const auto read = [&](int end) {
#pragma omp simd
      for (int i = 0; i < end; ++i) {
        height_m[i] = bilinearHeight(corner, row_posts, column.at(parts[i]), row.at(parts[i])) - base_msl_m;
      }
    };
    if (count == kBlock) {
      read(kBlock);
    } else {
      read(count);
    }
    if (!(terrain_.slack_m()[block] < HUGE_VALF)) {
      for (int i = 0; i < count; ++i) memory_.is_unknown = memory_.is_unknown || std::isnan(height_m[i]);
    }
    return height_m;
  }

  const Posts& posts_;
  const SectorTerrain& terrain_;
  const SectorBounds& bounds_;
  PathMemory& memory_;
  const Path& path_;
};

/// Finds nu of Bullington's edge for receivers clear of the smooth earth, lowest first.
/// @param rx_m  heights, relative to the base
inline void findEdges(const Posts& posts, const SectorBounds& bounds, const Path& path, const Search& search,
                      const float* rx_m, int count, PathMemory& memory, float* nu_of) {
  const float d = path.distance_m, tx_m = bounds.tx_m;
  const float k = posts.model.half_curvature, bulge = k * d;
  const int last = path.blocks - 1;
  // The known part of the steepest post, which is only searched for if it may be above the line of sight.
  float steepest = bounds.highest_tx_slope[last];
  bool is_found = false;
  for (int n = 0; n < count; ++n) {
    const float rx = rx_m[n], slope = (rx - tx_m) / d;
    if (!is_found && steepest + bulge >= slope) {
      Maximum most{-HUGE_VALF, memory.tx_block};
      search.findSteepest(
          [=](float range, float height) { return (height - k * range * range - tx_m) * (1 / range); }, most);
      memory.tx_block = most.block;
      steepest = most.value;
      is_found = true;
    }
    float nu;
    if (steepest + bulge >= slope) {
      Maximum most{-HUGE_VALF, memory.rx_block[n]};
      search(
          [=](float lowered, float, float first_m, float last_m) {
            const float above = lowered + bulge * d - rx;
            return above / (d - (above > 0 ? last_m : first_m)) - bulge;
          },
          [=](float range, float height) { return (height - rx) * (1 / (d - range)) + k * range; }, most);
      memory.rx_block[n] = most.block;
      nu = propagation::bullingtonEdgeNu(posts.model, d, slope, steepest + bulge, most.value);
    } else {
      const float factor2 = 2 * d / posts.model.earth.wavelength_m, rise = bulge - slope, half = d / 2;
      Maximum most{propagation::kKnifeEdgeClear<float>, memory.nu_block[n]};
      search(
          [=](float lowered, float, float first_m, float last_m) {
            const float above = lowered - tx_m + rise * (rise > 0 ? last_m : first_m);
            const float widest = half < first_m ? first_m : half > last_m ? last_m : half;
            const float below = above * std::sqrt(factor2 / (widest * (d - widest)));
            return above >= 0 ? HUGE_VALF : below;
          },
          [=](float range, float height) {
            const float beyond = d - range;
            return (height - tx_m + k * range * beyond - slope * range) *
                   std::sqrt(factor2 / (range * beyond));
          },
          most);
      memory.nu_block[n] = most.block;
      nu = most.value;
      if (nu <= propagation::kKnifeEdgeClear<float>) {  // and so are those above
        for (; n < count; ++n) nu_of[n] = nu;
        return;
      }
    }
    nu_of[n] = nu;
  }
}

/// Computes bounds of the blocks of a sector from the heights in its middle.
EMSCAPE_SIMD_CLONES void setBounds(const Posts& posts, const SectorTerrain& terrain, float tx_msl_m,
                                   SectorBounds& bounds) {
  const float base = terrain.base_msl_m(), tx = posts.model.raised_m(tx_msl_m - base, 0);
  bounds.base_msl_m = base;
  bounds.tx_m = tx;
  const int blocks = terrain.blocks(), groups = groupsOf(blocks);
  float least[kGroup];
  float max_slope = -HUGE_VALF, min_slope = -HUGE_VALF;  // bounds of the largest slope so far
  int steep = -1;  // the last block that may hold the largest slope so far
  for (int g = 0; g < groups; ++g) {
    const int begin = g * kGroup;
    const float* const slack_m = terrain.slack_m() + begin;
    float *const lowered = bounds.lowered_m.data() + begin, *const steepest = bounds.tx_slope.data() + begin;
#pragma omp simd
    for (int n = 0; n < kGroup; ++n) lowered[n] = steepest[n] = least[n] = -HUGE_VALF;
    for (int j = 0; j < kBlock; ++j) {
      const int first = (g * kBlock + j) * kGroup;
      const float* const height_msl_m = terrain.height_msl_m() + first;
      const float *const lowering_m = posts.lowering_m + first, *const per_range = posts.per_range + first;
#pragma omp simd
      for (int n = 0; n < kGroup; ++n) {
        const float here = height_msl_m[n] - base - lowering_m[n];
        const float slope = (here - tx) * per_range[n], between = slack_m[n] * per_range[n];
        lowered[n] = here > lowered[n] ? here : lowered[n];
        steepest[n] = slope + between > steepest[n] ? slope + between : steepest[n];
        least[n] = slope - between > least[n] ? slope - between : least[n];
      }
    }
    float group_lowered = -HUGE_VALF, group_steepest = -HUGE_VALF;
    const int count = std::min(kGroup, blocks - begin);
    for (int n = 0; n < kGroup; ++n) {
      lowered[n] = n < count ? lowered[n] + slack_m[n] : -HUGE_VALF;
      steepest[n] = n < count ? steepest[n] : -HUGE_VALF;
      group_lowered = std::max(group_lowered, lowered[n]);
      group_steepest = std::max(group_steepest, steepest[n]);
    }
    bounds.group_lowered_m[g] = group_lowered;
    bounds.group_tx_slope[g] = group_steepest;
    for (int n = 0; n < count; ++n) {
      const int block = begin + n;
      while (steep >= 0 && bounds.tx_slope[steep] < min_slope) steep = bounds.steep_before[steep];
      bounds.steep_before[block] = steep;
      steep = block;
      max_slope = std::max(max_slope, steepest[n]);
      min_slope = std::max(min_slope, least[n]);
      bounds.highest_tx_slope[block] = max_slope;
    }
  }
  for (int g = groups; g < groupsOf(groups) * kGroup; ++g) {
    bounds.group_lowered_m[g] = bounds.group_tx_slope[g] = -HUGE_VALF;
  }
}

/// Height in the middle of the sector, relative to the base.
inline double middleHeight_m(const SectorTerrain& terrain, const SectorBounds& bounds, int post) {
  if (post == 0) return 0;
  return static_cast<double>(terrain.height_msl_m()[SectorPosts::inGroups(post)] - bounds.base_msl_m);
}

void setTrend(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds,
              SectorTrend& trend) {
  propagation::TerrainSums sums;
  double before_m = 0, height_before_m = 0, differences_m2 = 0;
  for (int post = 0; post < terrain.posts(); ++post) {
    const double range_m = posts.exact_range_m[post];
    const double height_m = middleHeight_m(terrain, bounds, post);
    sums.add(before_m, height_before_m, range_m, height_m);
    before_m = range_m;
    height_before_m = height_m;
    if (post % kBlock != 0) continue;
    const int beyond = std::min(post + kBlock, posts.count - 1);
    const double length_m = posts.exact_range_m[beyond] - posts.exact_range_m[std::max(post - 1, 0)];
    differences_m2 += 2 * length_m * static_cast<double>(terrain.slack_m()[post / kBlock]);
    trend.before.push_back(sums);
    trend.differences_m2.push_back(static_cast<float>(differences_m2));
  }
}

/// True if the smooth earth has no loss for a receiver and those above: see LaneColumn::isClearOfEarth().
inline bool isClearOfEarth(const Posts& posts, const SectorTerrain& terrain, const SectorBounds& bounds,
                           const SectorPath& to, const Path& path, float rx_m, SectorTrend& trend) {
  const DiffractionModel<float>& model = posts.model;
  const float ground_m = to.ground_msl_m - bounds.base_msl_m;
  const auto isClear = [&](float tx, float rx) {
    return isClearThroughout(model.earth, path.distance_m, sightLine(model.earth, path.distance_m, tx, rx));
  };
  if (isClear(bounds.tx_m, rx_m - ground_m)) return true;
  if (trend.before.empty()) setTrend(posts, terrain, bounds, trend);
  const int block = path.before / kBlock;
  propagation::TerrainSums sums = trend.before[block];
  double before_m = posts.exact_range_m[block * kBlock];
  double height_before_m = middleHeight_m(terrain, bounds, block * kBlock);
  const auto add = [&](double range_m, double height_m) {
    sums.add(before_m, height_before_m, range_m, height_m);
    before_m = range_m;
    height_before_m = height_m;
  };
  for (int post = block * kBlock + 1; post <= path.before; ++post) {
    add(posts.exact_range_m[post], middleHeight_m(terrain, bounds, post));
  }
  add(to.distance_m, static_cast<double>(ground_m));
  // The weight of a height in either end of the line is at most twice that in the mean height.
  const float most_m = 2 * trend.differences_m2[block] / path.distance_m;
  propagation::TerrainTrend<float> highest{};
  highest.start_msl_m = static_cast<float>(sums.start_m(to.distance_m)) + most_m;
  highest.end_msl_m = static_cast<float>(sums.end_m(to.distance_m)) + most_m;
  highest.rx_ground_msl_m = ground_m;
  const auto least = effectiveHeights(highest, bounds.tx_m, rx_m);
  return isClear(least.tx_m, least.rx_m);
}

/// The paths of one sector.
struct SectorTask {
  const ExcessTask<propagation::DiffractionExcess>& task;
  const SectorPath *begin, *end;
  double half_width_rad;
  const ExcessOutput& out;
  char* is_left;
};

/// Sets the excess of the paths that were searched.
inline void setLosses(const SectorTask& sector, PathMemory& memory) {
  const ExcessGrid& grid = sector.task.grid;
  const int receivers = static_cast<int>(memory.searched.size()) * grid.layers;
  const float *const nu = memory.nu.data(), *const distance_m = memory.distance_m.data();
  float* const loss_db = memory.loss_db.data();
#pragma omp simd
  for (int i = 0; i < receivers; ++i) {
    loss_db[i] = propagation::bullingtonLossInLoopDb(nu[i], distance_m[i]);
  }
  float* of_path_db = loss_db;
  for (const SectorPath* const to : memory.searched) {
    const auto column = static_cast<std::size_t>(to->column);
    if (sector.task.terminal.isSet()) {
      for (int n = 0; n < grid.layers; ++n) {
        const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
        of_path_db[n] = sector.task.terminal.withLossDb(of_path_db[n], static_cast<float>(to->distance_m),
                                                        height_msl_m - to->ground_msl_m);
      }
    }
    if (!sector.task.air.isClear()) {
      const propagation::AirColumn above(sector.task.air, static_cast<float>(to->distance_m));
      for (int n = 0; n < grid.layers; ++n) {
        of_path_db[n] += above.lossDb(static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n])));
      }
    }
    for (int n = 0; n < grid.layers; ++n) {
      sector.out.excess.set(n * grid.column_count + column, of_path_db[n]);
    }
    sector.is_left[column] = 0;
    of_path_db += grid.layers;
  }
}

EMSCAPE_SIMD_CLONES void fillSector(const SectorTask& sector, const Posts& all_posts,
                                    const SectorTerrain& terrain, const SectorBounds& bounds,
                                    PathMemory& memory) {
  constexpr int kMinPosts = 16;  // shorter paths are read as fast
  const Posts posts = all_posts;
  const ExcessGrid& grid = sector.task.grid;
  const DiffractionModel<float>& model = posts.model;
  const float per_rad = static_cast<float>(1 / sector.half_width_rad);
  const auto layers = static_cast<std::size_t>(grid.layers);
  const std::size_t receivers = static_cast<std::size_t>(sector.end - sector.begin) * layers;
  memory.searched.clear();
  memory.trend.before.clear();
  memory.trend.differences_m2.clear();
  for (std::vector<float>* const array : {&memory.nu, &memory.distance_m, &memory.loss_db}) {
    if (array->size() < receivers) array->resize(receivers);
  }
  Path path{};
  for (const SectorPath* to = sector.begin; to < sector.end; ++to) {
    path.distance_m = static_cast<float>(to->distance_m);
    path.before = sector.task.ground.lastBefore(to->distance_m);
    path.blocks = path.before / kBlock + 1;
    path.aside = to->aside_rad * per_rad;
    ++path.number;
    if (path.before < kMinPosts || path.before >= terrain.posts()) continue;
    const float ground_m = to->ground_msl_m - bounds.base_msl_m;
    for (int n = 0; n < grid.layers; ++n) {
      const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
      const float here_m = sector.task.modelHeight_m(to->distance_m, height_msl_m);
      memory.rx_m[n] = model.raised_m(here_m - bounds.base_msl_m, ground_m);
    }
    if (!isClearOfEarth(posts, terrain, bounds, *to, path, memory.rx_m[0], memory.trend)) continue;
    memory.is_unknown = false;
    const std::size_t first = memory.searched.size() * layers;
    findEdges(posts, bounds, path, Search(posts, terrain, bounds, memory, path), memory.rx_m.data(),
              grid.layers, memory, memory.nu.data() + first);
    if (memory.is_unknown) continue;
    memory.searched.push_back(to);
    std::fill_n(memory.distance_m.begin() + static_cast<std::ptrdiff_t>(first), layers, path.distance_m);
  }
  setLosses(sector, memory);
}

/// Number of sectors: none wider than a part of the post spacing, and not too many for the number of paths.
int sectorsOf(const ExcessTask<propagation::DiffractionExcess>& task) {
  constexpr double kWidth_posts = 1.5;
  constexpr std::size_t kPathsPerSector = 32;
  const GroundPosts& ground = task.ground;
  const double farthest_m = ground.ranges_m[ground.range_count - 1];
  const double step_m = farthest_m - ground.ranges_m[ground.range_count - 2];
  const double widest_rad = kWidth_posts * step_m / farthest_m;
  return static_cast<int>(
      std::min(8 / widest_rad, static_cast<double>(task.grid.column_count / kPathsPerSector)));
}

}  // namespace

std::vector<char> fillSurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task,
                                         const TerrainBounds& bounds, const ExcessOutput& out) {
  constexpr int kMinSectors = 360;
  std::vector<char> is_left(task.grid.column_count, 1);
  const SectorPosts sector_posts(task.station, task.ground);
  if (!sector_posts.isUsable() || sectorsOf(task) < kMinSectors) return is_left;
  const PathSectors sectors(task.station, task.grid, sectorsOf(task));

  const int blocks = sector_posts.blocks(), groups = groupsOf(blocks);
  std::vector<float> group_first_m, group_last_m, first_m, last_m;
  first_m.assign(sector_posts.first_m(), sector_posts.first_m() + blocks);
  last_m.assign(sector_posts.last_m(), sector_posts.last_m() + blocks);
  first_m.resize(groups * kGroup, first_m.back());
  last_m.resize(groups * kGroup, last_m.back());
  for (int g = 0; g < groups; ++g) {
    group_first_m.push_back(first_m[g * kGroup]);
    group_last_m.push_back(last_m[(g + 1) * kGroup - 1]);
  }
  const int padded_groups = groupsOf(groups) * kGroup;
  group_first_m.resize(padded_groups, group_first_m.back());
  group_last_m.resize(padded_groups, group_last_m.back());
  std::vector<float> lowering_m, per_range;
  for (const int post : sector_posts.postsInGroups()) {
    const float range_m = sector_posts.range_m()[post];
    lowering_m.push_back(task.model.model.half_curvature * range_m * range_m);
    per_range.push_back(1 / range_m);
  }
  const int count = task.ground.range_count;
  const Posts posts{
      task.model.model, task.ground.ranges_m, sector_posts.range_m(), sector_posts.part(), count,
      first_m.data(),   last_m.data(),        group_first_m.data(),   group_last_m.data(), lowering_m.data(),
      per_range.data()};
  parallelFor(sectors.count(), 16, [&](int begin, int end) {
    SectorTerrain terrain(task.station, task.ground, bounds, sector_posts);
    SectorBounds of_sector;
    for (auto* const array : {&of_sector.lowered_m, &of_sector.tx_slope, &of_sector.highest_tx_slope}) {
      array->resize(groups * kGroup);
    }
    of_sector.steep_before.resize(groups * kGroup);
    of_sector.group_lowered_m.resize(padded_groups);
    of_sector.group_tx_slope.resize(padded_groups);
    PathMemory memory;
    memory.height_m.resize(blocks * kBlock);
    memory.rx_m.resize(task.grid.layers);
    memory.rx_block.resize(task.grid.layers);
    memory.nu_block.resize(task.grid.layers);
    for (int sector = begin; sector < end; ++sector) {
      double farthest_m = 0;
      for (const SectorPath* to = sectors.begin(sector); to < sectors.end(sector); ++to) {
        farthest_m = std::max(farthest_m, to->distance_m);
      }
      if (farthest_m == 0) continue;
      terrain.read(sectors.middle(sector), sectors.halfWidth_rad(sector),
                   task.ground.lastBefore(farthest_m) + 1);
      if (terrain.blocks() == 0) continue;
      setBounds(posts, terrain, task.model.tx_msl_m, of_sector);
      memory.read_for.assign(blocks, 0);
      fillSector({task, sectors.begin(sector), sectors.end(sector), sectors.halfWidth_rad(sector), out,
                  is_left.data()},
                 posts, terrain, of_sector, memory);
    }
  });
  return is_left;
}

}  // namespace emscape::emfield
