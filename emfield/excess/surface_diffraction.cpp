#include "emfield/excess/surface_diffraction.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/math/simd.h"
#include "emfield/excess/path_search.h"
#include "emfield/excess/path_sectors.h"
#include "emscape/base/parallel.h"
#include "propagation/diffraction/bullington_lanes.h"

namespace emscape::emfield {
namespace {

using propagation::DiffractionModel;
using DiffractionTask = ExcessTask<propagation::DiffractionExcess>;

/// The receivers of some paths, by heights, and what a thread remembers of the paths before: the blocks that
/// held their maxima.
struct SectorMemory {
  explicit SectorMemory(int layers) : receivers(layers) {}

  struct Receivers {
    float rx_m[kPathLanes];  ///< heights, as inputs of the model
    float nu[kPathLanes];
    int rx_block[kPathLanes] = {}, nu_block[kPathLanes] = {};
  };
  std::vector<Receivers> receivers;  ///< lowest first
  int tx_block[kPathLanes] = {}, highest_block[kPathLanes] = {}, plain_tx_block[kPathLanes] = {},
      plain_rx_block[kPathLanes] = {};
};

/// Paths that are searched together. Heights are relative to the ground below the emitter.
class PathGroup {
 public:
  PathGroup(const SectorObstacles& obstacles, SectorBounds& bounds, PathSearch& search, SectorMemory& memory)
      : model_(obstacles.model), bounds_(bounds), search_(search), memory_(memory) {}

  PathLanes paths;
  const SectorPath* to[kPathLanes];
  int blocks[kPathLanes];

  /// Leaves the paths for which the smooth earth may have a loss. It has none by the ground below the
  /// antennas, or by the line fitted to the terrain, which obstacles above the line of sight lower (P.526-15
  /// eq. (63) to (66)); all without the earth's bulge, and of the ground without clutter.
  void leaveThoseInEarth() {
    const float tx_m = bounds_.tx_m();
    TerrainTrend trends[kPathLanes];
    int is_open[kPathLanes], are_open = 0;
    for (int l = 0; l < kPathLanes; ++l) {
      const float above_m = memory_.receivers[0].rx_m[l] - (to[l]->ground_msl_m - bounds_.base_msl_m());
      is_open[l] = paths.is_left[l] == 0 && !isClear(l, {tx_m, above_m});
      if (is_open[l] == 0) continue;
      trends[l] = bounds_.highestTrend(*to[l], paths.before[l]);
      are_open = 1;
    }
    for (std::size_t n = 0; n < memory_.receivers.size() && are_open != 0; ++n) {
      const float* const rx_m = memory_.receivers[n].rx_m;
      for (int l = 0; l < kPathLanes; ++l) {  // clear, and so are those above
        is_open[l] = is_open[l] != 0 && paths.is_left[l] == 0 &&
                     !isClear(l, effectiveHeights(trends[l], tx_m, rx_m[l]));
      }
      leaveThoseNotLowered(trends, rx_m, is_open);
      are_open = std::any_of(is_open, is_open + kPathLanes, [](int is) { return is != 0; }) ? 1 : 0;
    }
  }

  /// Sets nu of Bullington's edge for receivers clear of the smooth earth.
  void findEdges() {
    const float tx_m = bounds_.tx_m(), k = model_.half_curvature;
    const float* const d = paths.distance_m;
    float steepest[kPathLanes], bulge[kPathLanes], slope[kPathLanes];
    for (int l = 0; l < kPathLanes; ++l) {
      bulge[l] = k * d[l];
      slope[l] = (memory_.receivers[0].rx_m[l] - tx_m) / d[l];
      steepest[l] = bounds_.highestTxSlope(blocks[l] - 1);
    }
    // The steepest post is only searched for if it may be above the line of sight.
    const auto isBelow = [&](int l) { return steepest[l] + bulge[l] >= slope[l]; };
    const auto isSought = [&](int l) { return paths.is_left[l] == 0 && isBelow(l); };
    PathMaxima tx(isSought, [](int) { return -HUGE_VALF; });
    if (tx.areAny()) {
      search_.find(
          [](int, float, float tx_slope, float, float) { return tx_slope; },
          [=](int, float range, float height) { return (height - k * range * range - tx_m) * (1 / range); },
          tx, memory_.tx_block);
      for (int l = 0; l < kPathLanes; ++l) steepest[l] = isSought(l) ? tx.value[l] : steepest[l];
    }
    float nu_below[kPathLanes];  // of the receiver below: once clear, and so are those above
    std::fill_n(nu_below, kPathLanes, HUGE_VALF);
    for (SectorMemory::Receivers& at : memory_.receivers) {
      const float* const rx_m = at.rx_m;
      for (int l = 0; l < kPathLanes; ++l) slope[l] = (rx_m[l] - tx_m) / d[l];
      PathMaxima rx(isSought, [](int) { return -HUGE_VALF; });
      if (rx.areAny()) {
        search_.find(
            [=, &bulge](int l, float lowered, float, float first_m, float last_m) {
              const float above = lowered + bulge[l] * d[l] - rx_m[l];
              return above / (d[l] - (above > 0 ? last_m : first_m)) - bulge[l];
            },
            [=](int l, float range, float height) {
              return (height - rx_m[l]) * (1 / (d[l] - range)) + k * range;
            },
            rx, at.rx_block);
      }
      constexpr float kClear = propagation::kKnifeEdgeClear<float>;
      PathMaxima nu([&](int l) { return paths.is_left[l] == 0 && !isBelow(l) && nu_below[l] > kClear; },
                    [](int) { return kClear; });
      if (nu.areAny()) findNearest(slope, nu, at.nu_block);
      for (int l = 0; l < kPathLanes; ++l) {
        at.nu[l] = isBelow(l) ? propagation::bullingtonEdgeNu(model_, d[l], slope[l], steepest[l] + bulge[l],
                                                              rx.value[l])
                              : std::min(nu.value[l], nu_below[l]);
        nu_below[l] = at.nu[l];
      }
    }
  }

 private:
  using TerrainTrend = propagation::TerrainTrend<float>;
  using Heights = propagation::EffectiveHeights<float>;

  /// The largest nu, if none is above the line of sight.
  void findNearest(const float* slope, PathMaxima& nu, int* guess) {
    const float tx_m = bounds_.tx_m(), k = model_.half_curvature, wavelength_m = model_.earth.wavelength_m;
    const float* const d = paths.distance_m;
    search_.find(
        [=](int l, float lowered, float, float first_m, float last_m) {
          const float rise = k * d[l] - slope[l], half = d[l] / 2;
          const float above = lowered - tx_m + rise * (rise > 0 ? last_m : first_m);
          const float widest = half < first_m ? first_m : half > last_m ? last_m : half;
          const float below = above * std::sqrt(2 * d[l] / wavelength_m / (widest * (d[l] - widest)));
          return above >= 0 ? HUGE_VALF : below;
        },
        [=](int l, float range, float height) {
          const float beyond = d[l] - range;
          return (height - tx_m + k * range * beyond - slope[l] * range) *
                 std::sqrt(2 * d[l] / wavelength_m / (range * beyond));
        },
        nu, guess);
  }

  bool isClear(int l, const Heights& heights) const {
    return isClearThroughout(model_.earth, paths.distance_m[l], heights.tx_m, heights.rx_m);
  }
  /// Leaves the open paths for which obstacles do not lower the line fitted to the terrain enough.
  void leaveThoseNotLowered(const TerrainTrend* trends, const float* rx_m, const int* is_open) {
    const float k = model_.half_curvature, tx_m = bounds_.tx_m();
    const float* const d = paths.distance_m;
    float slope[kPathLanes], highest_m[kPathLanes];
    for (int l = 0; l < kPathLanes; ++l) slope[l] = (rx_m[l] - tx_m) / d[l];
    PathMaxima highest([=](int l) { return is_open[l] != 0; }, [](int) { return 0.0f; });
    if (!highest.areAny()) return;
    // The highest obstacle alone suffices for most: then nothing else is searched.
    const auto settle = [&] {
      for (int l = 0; l < kPathLanes; ++l) {
        if (!highest.isSearched(l)) continue;
        highest_m[l] = highest.value[l];
        if (highest.is_bound[l] == 0 && isClearHoweverShared(l, trends[l], rx_m[l], highest_m[l]))
          highest.value[l] = HUGE_VALF;
      }
    };
    search_.find<true>(
        [=, &slope](int l, float lowered, float, float first_m, float last_m) {
          return lowered + k * last_m * last_m - tx_m - slope[l] * (slope[l] > 0 ? first_m : last_m);
        },
        [=, &slope](int l, float range, float height) { return height - tx_m - slope[l] * range; }, highest,
        memory_.highest_block, settle);
    settle();
    const auto isSearched = [&](int l) { return highest.isSearched(l) && highest_m[l] > 0; };
    PathMaxima tx(isSearched, [&](int l) { return slope[l]; });
    PathMaxima rx(isSearched, [&](int l) { return -slope[l]; });
    if (tx.areAny()) {
      search_.find<true>(
          [=](int, float, float lowered_slope, float, float last_m) { return lowered_slope + k * last_m; },
          [=](int, float range, float height) { return (height - tx_m) * (1 / range); }, tx,
          memory_.plain_tx_block);
      search_.find<true>(
          [=](int l, float lowered, float, float first_m, float last_m) {
            const float above = lowered + k * last_m * last_m - rx_m[l];
            return above / (d[l] - (above > 0 ? last_m : first_m));
          },
          [=](int l, float range, float height) { return (height - rx_m[l]) * (1 / (d[l] - range)); }, rx,
          memory_.plain_rx_block);
    }
    for (int l = 0; l < kPathLanes; ++l) {
      if (!highest.isSearched(l)) continue;
      TerrainTrend lowered = trends[l];
      lowered.highest_m = highest_m[l];
      lowered.tx_angle = tx.value[l] - slope[l];
      lowered.rx_angle = rx.value[l] + slope[l];
      if (!isSearched(l) || !isClear(l, effectiveHeights(lowered, tx_m, rx_m[l]))) paths.is_left[l] = 1;
    }
  }
  /// True if an obstacle lowers the line enough however that is shared between its ends. What is left where
  /// the line comes below both antennas' ground raises them together; by which of them more, the sum and the
  /// product of their heights are least where one has all of it.
  bool isClearHoweverShared(int l, const TerrainTrend& trend, float rx_m, float highest_m) const {
    const Heights least = effectiveHeights(trend, bounds_.tx_m(), rx_m);
    const float more_m = highest_m - std::max(trend.start_msl_m, 0.0f) -
                         std::max(trend.end_msl_m - trend.rx_ground_msl_m, 0.0f);
    return more_m > 0 && isClear(l, {least.tx_m + more_m, least.rx_m}) &&
           isClear(l, {least.tx_m, least.rx_m + more_m});
  }

  const DiffractionModel<float>& model_;
  SectorBounds& bounds_;
  PathSearch& search_;
  SectorMemory& memory_;
};

/// The paths of one sector.
struct SectorTask {
  const DiffractionTask& task;
  const SectorPath *begin, *end;
  double half_width_rad;
  const ExcessOutput& out;
  char* is_left;
};

/// Sets the excess of the paths that are not left.
inline void setLosses(const SectorTask& sector, const PathGroup& group, int count,
                      const SectorMemory& memory) {
  const DiffractionTask& task = sector.task;
  const ExcessGrid& grid = task.grid;
  for (int n = 0; n < grid.layers; ++n) {
    const float *const nu = memory.receivers[n].nu, *const distance_m = group.paths.distance_m;
    float loss_db[kPathLanes];
#pragma omp simd
    for (int l = 0; l < kPathLanes; ++l) {
      loss_db[l] = propagation::bullingtonLossInLoopDb(nu[l], distance_m[l]);
    }
    for (int l = 0; l < count; ++l) {
      if (group.paths.is_left[l] != 0) continue;
      const SectorPath& to = *group.to[l];
      const auto column = static_cast<std::size_t>(to.column);
      const PathEnds ends(task.air, task.terminal, distance_m[l], to.ground_msl_m);
      const auto height_msl_m = static_cast<float>(to.base_msl_m + static_cast<double>(grid.t_m[n]));
      sector.out.excess.set(n * grid.column_count + column, ends.added(loss_db[l], height_msl_m));
      sector.is_left[column] = 0;
    }
  }
}

EMSCAPE_SIMD_CLONES void fillSector(const SectorTask& sector, const SectorObstacles& obstacles,
                                    const SectorTerrain& terrain, SectorBounds& bounds, PathPosts& posts,
                                    PathSearch& search, SectorMemory& memory) {
  constexpr int kMinPosts = 16;  // shorter paths are read as fast
  const ExcessGrid& grid = sector.task.grid;
  const auto per_rad = static_cast<float>(1 / sector.half_width_rad);
  PathGroup group(obstacles, bounds, search, memory);
  for (const SectorPath* next = sector.begin; next < sector.end;) {
    PathLanes& paths = group.paths;
    int count = 0;
    for (; next < sector.end && count < kPathLanes; ++next) {
      const int before = sector.task.ground.lastBefore(next->distance_m);
      if (before < kMinPosts || before + 1 >= terrain.posts()) continue;
      const auto distance_m = static_cast<float>(next->distance_m);
      const float last_m = distance_m * static_cast<float>(propagation::kBeforeReceivers);
      const bool is_beyond = last_m > obstacles.posts.farthest_m()[before];
      const int begin = count++, end = begin == 0 ? kPathLanes : count;  // the first one in all lanes
      for (int l = begin; l < end; ++l) {
        group.to[l] = next;
        group.blocks[l] = (before + (is_beyond ? 1 : 0)) / SectorPosts::kBlock + 1;
        paths.before[l] = before;
        paths.exact_distance_m[l] = next->distance_m;
        paths.distance_m[l] = distance_m;
        paths.last_m[l] = last_m;
        paths.aside[l] = next->aside_rad * per_rad;
        paths.is_left[l] = l == begin ? 0 : 1;
      }
      for (int n = 0; n < grid.layers; ++n) {
        const auto height_msl_m = static_cast<float>(next->base_msl_m + static_cast<double>(grid.t_m[n]));
        const float here_m = sector.task.modelHeight_m(next->distance_m, height_msl_m);
        std::fill(
            memory.receivers[n].rx_m + begin, memory.receivers[n].rx_m + end,
            obstacles.model.raised_m(here_m - bounds.base_msl_m(), next->ground_msl_m - bounds.base_msl_m()));
      }
    }
    if (count == 0) break;
    posts.begin(paths);
    group.leaveThoseInEarth();
    group.findEdges();
    setLosses(sector, group, count, memory);
  }
}

}  // namespace

std::vector<char> fillSurfaceDiffraction(const DiffractionTask& task, const TerrainBounds& bounds,
                                         const ExcessOutput& out) {
  std::vector<char> is_left(task.grid.column_count, 1);
  const SectorPosts sector_posts(task.station, task.ground);
  const int sector_count = PathSectors::countFor(task.ground, task.grid.column_count);
  if (!sector_posts.isUsable() || sector_count == 0) return is_left;
  const PathSectors sectors(task.station, task.grid, sector_count);
  std::optional<BlockCover> cover;
  if (task.ground.is_raised) cover.emplace(task.ground.terrain);
  const SectorObstacles obstacles(task.model.model, task.model.tx_msl_m, sector_posts, task.ground);
  parallelFor(sectors.count(), 16, [&](int begin, int end) {
    SectorTerrain terrain(task.station, task.ground, bounds, sector_posts);
    SectorBounds of_sector(obstacles, terrain);
    PathPosts posts(obstacles, terrain, cover ? &*cover : nullptr,
                    std::fabs(task.station.geodesy.station.up.z));
    PathSearch search(obstacles, terrain, of_sector, posts);
    SectorMemory memory(task.grid.layers);
    for (int sector = begin; sector < end; ++sector) {
      const double farthest_m = sectors.farthest_m(sector);
      if (farthest_m == 0) continue;
      terrain.read(sectors.middle(sector), sectors.halfWidth_rad(sector),
                   std::min(task.ground.lastBefore(farthest_m) + 2, task.ground.range_count));
      if (terrain.blocks() == 0) continue;
      of_sector.set();
      fillSector({task, sectors.begin(sector), sectors.end(sector), sectors.halfWidth_rad(sector), out,
                  is_left.data()},
                 obstacles, terrain, of_sector, posts, search, memory);
    }
  });
  return is_left;
}

}  // namespace emscape::emfield
