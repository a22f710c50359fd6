/// The model `diffraction` over a surface on the CPU: most posts of a path are never read.
///
/// Every pixel of a map has a path of its own, but the obstacle that decides is on a few of its posts. Bounds
/// of the terrain (TerrainBounds) tell which parts of the path can hold it; only these are read. The losses
/// are those of DiffractionColumn, from the same posts by the same formulas.
#pragma once

#include <vector>

#include "emfield/fill_excess.h"
#include "emfield/terrain_bounds.h"
#include "propagation/diffraction/excess.h"

namespace emscape::emfield {

/// One emitter. Threads may share it, each with a Memory of its own.
class SurfaceDiffraction {
 public:
  static constexpr int kBlock = 16;  ///< posts per part of a path

  /// Memory of one thread, with the blocks that decided on the last path: those of the next are near them.
  struct Memory {
    std::vector<float> per_block;  ///< kBlockNumbers arrays of one element per block
    std::vector<int> of_block;  ///< per block: its window of the bounds; then per block: whether it was read
    std::vector<float> height_m;  ///< of the posts of the blocks that were read
    int tx_block = 0;
    std::vector<int> rx_block, nu_block;  ///< one per height
  };

  /// @param task, bounds  must outlive this object
  SurfaceDiffraction(const ExcessTask<propagation::DiffractionExcess>& task, const TerrainBounds& bounds);

  Memory makeMemory() const;
  /// Fills scratch.excess_db for a column.
  /// @return false if the column asks for all posts of its path: it is near the emitter, not clear of the
  /// smooth earth, or its path not entirely in one raster without voids
  bool fillColumn(std::size_t c, const ExcessScratch& scratch, Memory& memory) const;

 private:
  void boundRays();

  const ExcessTask<propagation::DiffractionExcess>& task_;
  const TerrainBounds& bounds_;
  std::vector<float> range_m_;                           ///< of the posts
  std::vector<double> begin_m_;                          ///< range at which each block begins
  std::vector<float> first_m_, last_m_, first_bulge_m_;  ///< of each block's first and last obstacle
  /// Rays at even azimuths around the emitter: upper bounds of the slopes from the emitter to the obstacles
  /// of each block along any path no farther from the ray than half way to the next. Empty: none.
  std::vector<float> ray_bounds_;
  int rays_ = 0;
};

}  // namespace emscape::emfield
