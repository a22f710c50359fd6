/// Voxels of a NanoVDB grid in a GPU's memory. For .cu files.
#pragma once

#include "base/host_device.h"
#include "volume/nanovdb_wrapper.h"

namespace emscape::volume {

/// Remembers the nodes that it came through: for voxels that lie close together. One thread uses it.
class SparseVoxels {
 public:
  /// @param grid  of floats
  EMSCAPE_HD explicit SparseVoxels(const void* grid)
      : accessor_(static_cast<const nano::FloatGrid*>(grid)->getAccessor()) {}

  EMSCAPE_HD float at(int i, int j, int k) const { return accessor_.getValue(nano::Coord(i, j, k)); }

 private:
  nano::FloatGrid::AccessorType accessor_;
};

}  // namespace emscape::volume
