/// The voxels of a sparse volume, for sampling on a GPU. Plain data.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"

namespace emscape::volume {

/// A block of 8 x 8 x 8 voxels: a leaf of a NanoVDB grid, or one value for all of them.
struct alignas(16) SparseBlock {
  static constexpr int kEdgeBits = 3;

  const float* values = nullptr;  ///< of the leaf, z fastest; null: all are `constant`
  float constant = 0;
};

/// Number of blocks along an axis of `voxels`.
EMSCAPE_HD inline int blocksAlong(int voxels) {
  return (voxels + (1 << SparseBlock::kEdgeBits) - 1) >> SparseBlock::kEdgeBits;
}

/// All blocks of a volume, x fastest: a voxel needs two memory accesses instead of the four of the grid's
/// tree.
class SparseVoxels {
 public:
  EMSCAPE_HD SparseVoxels(const SparseBlock* blocks, const Dims& dims)
      : blocks_(blocks), columns_(blocksAlong(dims.x)), rows_(blocksAlong(dims.y)) {}

  EMSCAPE_HD float at(int i, int j, int k) const {
    constexpr int kBits = SparseBlock::kEdgeBits, kInside = (1 << kBits) - 1;
    const SparseBlock block = blocks_[((k >> kBits) * rows_ + (j >> kBits)) * columns_ + (i >> kBits)];
    if (block.values == nullptr) return block.constant;
    return block.values[(((i & kInside) << kBits | (j & kInside)) << kBits) | (k & kInside)];
  }

 private:
  const SparseBlock* blocks_;
  int columns_, rows_;
};

}  // namespace emscape::volume
