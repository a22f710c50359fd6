#include "emfield/excess/surface_diffraction.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math/simd.h"
#include "emfield/excess/path_search.h"
#include "emfield/excess/path_sectors.h"
#include "emscape/base/parallel.h"
#include "propagation/diffraction/bullington_lanes.h"

namespace emscape::emfield {
namespace {

using propagation::DiffractionModel;
using DiffractionTask = ExcessTask<propagation::DiffractionExcess>;

/// Work of one thread on a sector.
struct SectorMemory {
  std::vector<float> rx_m;  ///< heights of a path's receivers, as inputs of the model
  /// Per height: the blocks that determined the loss of the previous path.
  std::vector<int> rx_block, nu_block;
  int tx_block = 0, highest_block = 0;
  /// Paths that were searched, and of their receivers, path by path: nu and distance of the edge, and the
  /// loss.
  std::vector<const SectorPath*> searched;
  std::vector<float> nu, distance_m, loss_db;
};

/// Finds nu of Bullington's edge for receivers clear of the smooth earth, lowest first.
inline void findEdges(const DiffractionModel<float>& model, const SectorBounds& bounds,
                      const PathToRead& path, const PathSearch& search, int count, SectorMemory& memory,
                      float* nu_of) {
  const float d = path.distance_m, tx_m = bounds.tx_m();
  const float k = model.half_curvature, bulge = k * d;
  // The known part of the steepest post, which is only searched for if it may be above the line of sight.
  float steepest = bounds.highestTxSlope(path.blocks - 1);
  bool is_found = false;
  for (int n = 0; n < count; ++n) {
    const float rx = memory.rx_m[n], slope = (rx - tx_m) / d;
    if (!is_found && steepest + bulge >= slope) {
      Maximum most{-HUGE_VALF, memory.tx_block};
      search([](float, float tx_slope, float, float) { return tx_slope; },
             [=](float range, float height) { return (height - k * range * range - tx_m) * (1 / range); },
             most);
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
      nu = propagation::bullingtonEdgeNu(model, d, slope, steepest + bulge, most.value);
    } else {
      const float factor2 = 2 * d / model.earth.wavelength_m, rise = bulge - slope, half = d / 2;
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

/// Whether the smooth earth has no loss for the receivers of a path.
struct EarthBelowPath {
  const SectorObstacles& obstacles;
  SectorBounds& bounds;
  const SectorPath& to;
  const PathToRead& path;
  const PathSearch& search;

  /// By the ground below the antennas, or by the line fitted to the terrain, which obstacles above the line
  /// of sight lower (P.526-15 eq. (63) to (66)); all without the earth's bulge.
  /// @param rx_m           heights, lowest first
  /// @param highest_block  that held the highest obstacle of the previous path
  bool isFreeOfLoss(const std::vector<float>& rx_m, int& highest_block) const {
    const float tx_m = bounds.tx_m(), ground_m = to.ground_msl_m - bounds.base_msl_m();
    if (isClear({tx_m, rx_m[0] - ground_m})) return true;
    const TerrainTrend trend = bounds.highestTrend(to, path.before);
    for (const float rx : rx_m) {
      if (isClear(effectiveHeights(trend, tx_m, rx))) return true;  // and those above
      if (!isLowered(trend, rx, highest_block)) return false;
    }
    return true;
  }

 private:
  using TerrainTrend = propagation::TerrainTrend<float>;
  using Heights = propagation::EffectiveHeights<float>;

  bool isClear(const Heights& heights) const {
    return isClearThroughout(obstacles.model.earth, path.distance_m, heights.tx_m, heights.rx_m);
  }
  bool isLowered(const TerrainTrend& trend, float rx_m, int& highest_block) const {
    const float k = obstacles.model.half_curvature, d = path.distance_m, tx_m = bounds.tx_m();
    const float slope = (rx_m - tx_m) / d;
    const auto heightOf = [=](float range, float height) { return height - tx_m - slope * range; };
    Maximum highest{0, std::min(highest_block, path.blocks - 1)};
    highest.value = std::max(highest.value, search.leastOf(highest.block, heightOf));
    if (isClearHoweverShared(trend, rx_m, highest.value)) return true;
    search(
        [=](float lowered, float, float first_m, float last_m) {
          return lowered + k * last_m * last_m - tx_m - slope * (slope > 0 ? first_m : last_m);
        },
        heightOf, highest);
    highest_block = highest.block;
    if (!(highest.value > 0)) return false;
    if (isClearHoweverShared(trend, rx_m, highest.value)) return true;
    Maximum tx_slope{slope, highest.block}, rx_slope{-slope, highest.block};
    search([=](float, float lowered_slope, float, float last_m) { return lowered_slope + k * last_m; },
           [=](float range, float height) { return (height - tx_m) * (1 / range); }, tx_slope);
    search(
        [=](float lowered, float, float first_m, float last_m) {
          const float above = lowered + k * last_m * last_m - rx_m;
          return above / (d - (above > 0 ? last_m : first_m));
        },
        [=](float range, float height) { return (height - rx_m) * (1 / (d - range)); }, rx_slope);
    TerrainTrend lowered = trend;
    lowered.highest_m = highest.value;
    lowered.tx_angle = tx_slope.value - slope;
    lowered.rx_angle = rx_slope.value + slope;
    return isClear(effectiveHeights(lowered, tx_m, rx_m));
  }
  /// True if an obstacle lowers the line enough however that is shared between its ends. What is left where
  /// the line comes below both antennas' ground raises them together; by which of them more, the sum and the
  /// product of their heights are least where one has all of it.
  bool isClearHoweverShared(const TerrainTrend& trend, float rx_m, float highest_m) const {
    const Heights least = effectiveHeights(trend, bounds.tx_m(), rx_m);
    const float more_m = highest_m - std::max(trend.start_msl_m, 0.0f) -
                         std::max(trend.end_msl_m - trend.rx_ground_msl_m, 0.0f);
    return more_m > 0 && isClear({least.tx_m + more_m, least.rx_m}) &&
           isClear({least.tx_m, least.rx_m + more_m});
  }
};

/// The paths of one sector.
struct SectorTask {
  const DiffractionTask& task;
  const SectorPath *begin, *end;
  double half_width_rad;
  const ExcessOutput& out;
  char* is_left;
};

/// Sets the excess of the paths that were searched.
inline void setLosses(const SectorTask& sector, SectorMemory& memory) {
  const DiffractionTask& task = sector.task;
  const ExcessGrid& grid = task.grid;
  const int receivers = static_cast<int>(memory.searched.size()) * grid.layers;
  const float *const nu = memory.nu.data(), *const distance_m = memory.distance_m.data();
  float* loss_db = memory.loss_db.data();
#pragma omp simd
  for (int i = 0; i < receivers; ++i) {
    loss_db[i] = propagation::bullingtonLossInLoopDb(nu[i], distance_m[i]);
  }
  for (const SectorPath* const to : memory.searched) {
    const auto column = static_cast<std::size_t>(to->column);
    const PathEnds ends(task.air, task.terminal, static_cast<float>(to->distance_m), to->ground_msl_m);
    for (int n = 0; n < grid.layers; ++n, ++loss_db) {
      const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
      sector.out.excess.set(n * grid.column_count + column, ends.added(*loss_db, height_msl_m));
    }
    sector.is_left[column] = 0;
  }
}

EMSCAPE_SIMD_CLONES void fillSector(const SectorTask& sector, const SectorObstacles& obstacles,
                                    const SectorTerrain& terrain, SectorBounds& bounds, PathPosts& posts,
                                    SectorMemory& memory) {
  constexpr int kMinPosts = 16;  // shorter paths are read as fast
  const ExcessGrid& grid = sector.task.grid;
  const auto per_rad = static_cast<float>(1 / sector.half_width_rad);
  const auto layers = static_cast<std::size_t>(grid.layers);
  const std::size_t receivers = static_cast<std::size_t>(sector.end - sector.begin) * layers;
  memory.searched.clear();
  for (std::vector<float>* const array : {&memory.nu, &memory.distance_m, &memory.loss_db}) {
    if (array->size() < receivers) array->resize(receivers);
  }
  const PathSearch search(obstacles, terrain, bounds, posts);
  for (const SectorPath* to = sector.begin; to < sector.end; ++to) {
    PathToRead path{};
    path.exact_distance_m = to->distance_m;
    path.distance_m = static_cast<float>(to->distance_m);
    path.before = sector.task.ground.lastBefore(to->distance_m);
    path.last_m = path.distance_m * static_cast<float>(propagation::kBeforeReceivers);
    path.aside = to->aside_rad * per_rad;
    if (path.before < kMinPosts || path.before + 1 >= terrain.posts()) continue;
    const bool is_beyond = path.last_m > obstacles.posts.farthest_m()[path.before];
    path.blocks = (path.before + (is_beyond ? 1 : 0)) / SectorPosts::kBlock + 1;
    for (int n = 0; n < grid.layers; ++n) {
      const auto height_msl_m = static_cast<float>(to->base_msl_m + static_cast<double>(grid.t_m[n]));
      const float here_m = sector.task.modelHeight_m(to->distance_m, height_msl_m);
      memory.rx_m[n] =
          obstacles.model.raised_m(here_m - bounds.base_msl_m(), to->ground_msl_m - bounds.base_msl_m());
    }
    posts.begin(path);
    const EarthBelowPath earth{obstacles, bounds, *to, path, search};
    if (!earth.isFreeOfLoss(memory.rx_m, memory.highest_block)) continue;
    const std::size_t first = memory.searched.size() * layers;
    findEdges(obstacles.model, bounds, path, search, grid.layers, memory, memory.nu.data() + first);
    if (posts.isLeft()) continue;
    memory.searched.push_back(to);
    std::fill_n(memory.distance_m.begin() + static_cast<std::ptrdiff_t>(first), layers, path.distance_m);
  }
  setLosses(sector, memory);
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
  const SectorObstacles obstacles(task.model.model, task.model.tx_msl_m, sector_posts, task.ground,
                                  cover ? bounds.highestCoverOfAll_m() : 0);
  parallelFor(sectors.count(), 16, [&](int begin, int end) {
    SectorTerrain terrain(task.station, task.ground, bounds, sector_posts);
    SectorBounds of_sector(obstacles, terrain);
    PathPosts posts(obstacles, terrain, cover ? &*cover : nullptr,
                    std::fabs(task.station.geodesy.station.up.z));
    SectorMemory memory;
    memory.rx_m.resize(task.grid.layers);
    for (auto* const block : {&memory.rx_block, &memory.nu_block}) block->resize(task.grid.layers);
    for (int sector = begin; sector < end; ++sector) {
      const double farthest_m = sectors.farthest_m(sector);
      if (farthest_m == 0) continue;
      terrain.read(sectors.middle(sector), sectors.halfWidth_rad(sector),
                   std::min(task.ground.lastBefore(farthest_m) + 2, task.ground.range_count));
      if (terrain.blocks() == 0) continue;
      of_sector.set();
      fillSector({task, sectors.begin(sector), sectors.end(sector), sectors.halfWidth_rad(sector), out,
                  is_left.data()},
                 obstacles, terrain, of_sector, posts, memory);
    }
  });
  return is_left;
}

}  // namespace emscape::emfield
