/// The voxels of a sparse volume in a GPU's texture memory. Plain data.
#pragma once

#include <cstdint>

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "volume/sparse/sparse_block.h"

namespace emscape::volume {

/// The values around a block of 8 x 8 x 8 voxels: a tile of the atlas, or one value.
struct alignas(8) SparseTile {
  static constexpr std::int32_t kNone = -1;

  std::int32_t place = kNone;  ///< in the atlas; see SparseTiles
  float constant = 0;          ///< without a tile: of all positions whose lower voxels are in the block
};

/// The tiles of all blocks, x fastest. A tile holds the voxels of its block and the next ones along each
/// axis, so that every position with its lower voxels in the block is interpolated within it.
class SparseTiles {
 public:
  static constexpr int kTexels = (1 << SparseBlock::kEdgeBits) + 1;  ///< along each axis
  /// A place has 10 bits for each axis.
  static constexpr int kMaxAlong = 1 << 10;

  EMSCAPE_HD SparseTiles(const SparseTile* tiles, const Dims& dims)
      : tiles_(tiles), columns_(blocksAlong(dims.x)), rows_(blocksAlong(dims.y)) {}

  /// The tile of a voxel.
  EMSCAPE_HD SparseTile at(int i, int j, int k) const {
    constexpr int kBits = SparseBlock::kEdgeBits;
    return tiles_[((k >> kBits) * rows_ + (j >> kBits)) * columns_ + (i >> kBits)];
  }
  /// The first texel of a tile along an axis: 0, 1 or 2 for x, y or z.
  EMSCAPE_HD static int firstTexel(std::int32_t place, int axis) {
    return (place >> (10 * axis) & (kMaxAlong - 1)) * kTexels;
  }
  /// Index in a block, along an axis.
  EMSCAPE_HD static int inBlock(int voxel) { return voxel & ((1 << SparseBlock::kEdgeBits) - 1); }

 private:
  const SparseTile* tiles_;
  int columns_, rows_;
};

}  // namespace emscape::volume
