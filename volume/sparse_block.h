/// The voxels of a sparse volume as a GPU samples them. Plain data.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"

namespace emscape::volume {

/// A block of 8 x 8 x 8 voxels: a leaf of a NanoVDB grid, or what the grid says of all of them.
struct alignas(16) SparseBlock {
  static constexpr int kEdgeBits = 3;

  const float* values = nullptr;  ///< of the leaf, z fastest; null: all are `constant`
  float constant = 0;
};

/// All blocks of a volume, x fastest: each voxel is two steps away, where the grid's tree takes four.
class SparseVoxels {
 public:
  EMSCAPE_HD SparseVoxels(const SparseBlock* blocks, const Dims& dims)
      : blocks_(blocks), columns_(along(dims.x)), rows_(along(dims.y)) {}

  EMSCAPE_HD float at(int i, int j, int k) const {
    constexpr int kBits = SparseBlock::kEdgeBits, kInside = (1 << kBits) - 1;
    const SparseBlock block = blocks_[((k >> kBits) * rows_ + (j >> kBits)) * columns_ + (i >> kBits)];
    if (block.values == nullptr) return block.constant;
    return block.values[(((i & kInside) << kBits | (j & kInside)) << kBits) | (k & kInside)];
  }

 private:
  EMSCAPE_HD static int along(int voxels) {
    return (voxels + (1 << SparseBlock::kEdgeBits) - 1) >> SparseBlock::kEdgeBits;
  }

  const SparseBlock* blocks_;
  int columns_, rows_;
};

}  // namespace emscape::volume
