/// Access to the blocks of a NanoVDB grid, for host and device.
#pragma once

#include "volume/sparse/nanovdb_wrapper.h"
#include "volume/sparse/sparse_block.h"

namespace emscape::volume {

/// The block (x, y, z) of a grid of floats; it points into the grid.
EMSCAPE_HD inline SparseBlock sparseBlockAt(const void* grid, int x, int y, int z) {
  constexpr int kBits = SparseBlock::kEdgeBits;
  const nano::Coord first(x << kBits, y << kBits, z << kBits);
  const auto& root = static_cast<const nano::FloatGrid*>(grid)->tree().root();
  const auto* leaf = root.probeLeaf(first);
  if (leaf != nullptr) return {leaf->data()->mValues, 0};
  return {nullptr, root.getValue(first)};
}

}  // namespace emscape::volume
