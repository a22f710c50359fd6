/// Bounds of the obstacles on the paths of one sector, for `diffraction` over a surface.
///
/// Heights are relative to the ground below the emitter; "lowered" heights are minus the earth's bulge
/// r^2 / (2 a). Arrays of blocks, and of groups of kGroup blocks, are padded to whole groups.
#pragma once

#include <vector>

#include "emfield/excess/sector_terrain.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::emfield {

/// Number of groups of SectorPosts::kGroup that contain a number of blocks, or of groups.
inline int groupsOf(int count) {
  return (count + SectorPosts::kGroup - 1) / SectorPosts::kGroup;
}

/// Ranges of the obstacles of each block, or group.
struct ObstacleRanges {
  std::vector<float> first_m, last_m;
};

/// Values common to all sectors of a station. Immutable once made.
struct SectorObstacles {
  propagation::DiffractionModel<float> model;
  float tx_msl_m;
  const SectorPosts& posts;
  const GroundPosts& ground;
  ObstacleRanges blocks, groups;
  /// In groups (SectorPosts), of the ranges that a post stands for: the least bulge of the earth r^2 / (2 a),
  /// and 1 / r of the nearest and the farthest.
  std::vector<float> lowering_m, per_nearest, per_farthest;
  std::vector<float> has_clutter;  ///< in groups: 1, or 0 near the emitter

  SectorObstacles(const propagation::DiffractionModel<float>& of_model, float of_tx_msl_m,
                  const SectorPosts& of_posts, const GroundPosts& of_ground);
};

/// The same of each block, or group, of a sector.
struct ObstacleBounds {
  std::vector<float> lowered_m;  ///< largest lowered height of an obstacle
  std::vector<float> tx_slope;   ///< largest slope from the transmitter to a lowered obstacle
};

/// The bounds of one sector at a time.
class SectorBounds {
 public:
  /// Both must outlive this object.
  SectorBounds(const SectorObstacles& obstacles, const SectorTerrain& terrain);

  /// Computes the bounds from the heights in the middle of the terrain's sector.
  void set();

  float base_msl_m() const { return terrain_.base_msl_m(); }
  float tx_m() const { return tx_m_; }
  const ObstacleBounds& blocks() const { return blocks_; }
  const ObstacleBounds& groups() const { return groups_; }
  /// Largest tx_slope of a block and all before it.
  float highestTxSlope(int block) const { return highest_tx_slope_[block]; }

  /// The line fitted to the bare terrain of a path is nowhere above this one, from the middle of the sector;
  /// no obstacle is known to be above the line of sight.
  /// @param before  last regular post before the receivers
  propagation::TerrainTrend<float> highestTrend(const SectorPath& to, int before);

 private:
  void setTrend();

  const SectorObstacles& obstacles_;
  const SectorTerrain& terrain_;
  float tx_m_ = 0;
  ObstacleBounds blocks_, groups_;
  std::vector<float> highest_tx_slope_;
  /// Of the middle's posts, made when first needed: sums of the intervals up to each post; and per block the
  /// largest integral, over twice the range, of the differences of a path's heights from the middle's, from
  /// the emitter to beyond the block.
  std::vector<propagation::TerrainSums> sums_;
  std::vector<double> differences_m2_;
};

}  // namespace emscape::emfield
