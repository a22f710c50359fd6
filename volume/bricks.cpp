#include "volume/bricks.h"

#include <algorithm>
#include <limits>
#include <string>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

namespace emscape::volume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr ValueRange kEmpty{kInfinity, -kInfinity};

/// Smallest and largest value of each x over the voxel rows of y and z. Elementwise, so that the compiler can
/// vectorise it; NaN fails both comparisons.
void foldRows(const DenseVolume& volume, VoxelInterval y, VoxelInterval z, std::vector<float>& least,
              std::vector<float>& greatest) {
  const int voxels = volume.grid.dims.x;
  least.assign(static_cast<std::size_t>(voxels), kInfinity);
  greatest.assign(static_cast<std::size_t>(voxels), -kInfinity);
  float* low = least.data();
  float* high = greatest.data();
  for (int k = z.begin; k < z.end; ++k) {
    for (int j = y.begin; j < y.end; ++j) {
      const float* row = volume.values.data() + volume.grid.index(0, j, k);
      for (int i = 0; i < voxels; ++i) {
        low[i] = row[i] < low[i] ? row[i] : low[i];
        high[i] = row[i] > high[i] ? row[i] : high[i];
      }
    }
  }
}

/// True if every voxel of the columns of x and y below z_end is masked.
bool allMasked(const DenseVolume& volume, VoxelInterval x, VoxelInterval y, int z_end) {
  if (volume.first_valid_k.empty()) return false;
  for (int j = y.begin; j < y.end; ++j) {
    for (int i = x.begin; i < x.end; ++i) {
      if (!volume.isMasked(i, j, z_end - 1)) return false;
    }
  }
  return true;
}

}  // namespace

Bricks::Bricks(const DenseVolume& volume, int edge) : edge_(edge) {
  if (edge < 1)
    throw Error(ErrorCode::bad_input, "brick edge " + std::to_string(edge) + ": must be at least 1 voxel");
  update(volume);
}

void Bricks::update(const DenseVolume& volume) {
  const Dims& voxels = volume.grid.dims;
  dims_ = brickDims(voxels, edge_);
  ranges_.resize(static_cast<std::size_t>(dims_.count()));
  parallelFor(dims_.y * dims_.z, 4, [&](int begin, int end) {
    std::vector<float> least, greatest;
    for (int row = begin; row < end; ++row) {
      const VoxelInterval y = withApron(row % dims_.y, edge_, voxels.y);
      const VoxelInterval z = withApron(row / dims_.y, edge_, voxels.z);
      foldRows(volume, y, z, least, greatest);
      for (int brick = 0; brick < dims_.x; ++brick) {
        const VoxelInterval x = withApron(brick, edge_, voxels.x);
        ValueRange range = kEmpty;
        if (!allMasked(volume, x, y, z.end)) {
          range.min = *std::min_element(least.begin() + x.begin, least.begin() + x.end);
          range.max = *std::max_element(greatest.begin() + x.begin, greatest.begin() + x.end);
        }
        ranges_[static_cast<std::size_t>(row) * dims_.x + brick] = range;
      }
    }
  });
}

}  // namespace emscape::volume
