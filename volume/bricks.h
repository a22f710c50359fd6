/// The value range of each small block of a volume, so that a ray caster can skip invisible blocks.
#pragma once

#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/value_range.h"

namespace emscape::volume {

/// Voxels along a brick's edge, by default.
constexpr int kBrickEdge = 8;

/// The voxels of a brick and its apron along one axis.
struct VoxelInterval {
  int begin, end;
};
EMSCAPE_HD inline VoxelInterval withApron(int brick, int edge, int voxels) {
  const int begin = brick * edge - 1;
  const int end = (brick + 1) * edge + 1;
  return {begin > 0 ? begin : 0, end < voxels ? end : voxels};
}

/// Numbers of bricks of a volume.
inline Dims brickDims(const Dims& voxels, int edge) {
  const auto along = [edge](int count) { return (count + edge - 1) / edge; };
  return {along(voxels.x), along(voxels.y), along(voxels.z)};
}

/// Bricks as plain data for host and device; x fastest, then y, then z.
struct BricksView {
  const ValueRange* ranges = nullptr;
  Dims dims;     ///< numbers of bricks
  int edge = 0;  ///< voxels along a brick's edge

  EMSCAPE_HD ValueRange at(int x, int y, int z) const {
    return ranges[(static_cast<long long>(z) * dims.y + y) * dims.x + x];
  }
};

/// Min-max bricks of a volume. Brick (x, y, z) owns the voxels [x, x + 1) * edge and so on; its range is
/// taken with an apron of one voxel all around, so that every trilinear sample taken inside the box of its
/// voxels (which reaches half a voxel beyond their centres) is within [min, max]. NaN voxels are ignored.
/// Masked voxels count with their stored value; a brick is empty if all its voxels, including the apron, are
/// masked or NaN.
class Bricks {
 public:
  /// Computed in parallel. @param edge  voxels, >= 1; @throws Error (bad_input) for another edge
  explicit Bricks(const DenseVolume& volume, int edge = kBrickEdge);

  /// Recomputes the ranges from another volume; memory is reused if the dims allow.
  void update(const DenseVolume& volume);

  BricksView view() const { return {ranges_.data(), dims_, edge_}; }

 private:
  int edge_;
  Dims dims_;
  std::vector<ValueRange> ranges_;
};

}  // namespace emscape::volume
