#include "volume/nvdb/nanovdb_grid.h"

#include <gtest/gtest.h>

#include "emscape/volume/device_volume.h"
#include "tests/support/gpu.h"
#include "tests/volume/sample_volumes.h"
#include "volume/sparse/sparse_grid.h"

namespace emscape::volume {
namespace {

/// True if a sample in the air reads a voxel: it or a neighbour is not masked.
bool isReached(const DenseVolume& volume, int i, int j, int k) {
  const Dims& dims = volume.grid.dims;
  for (int w = std::max(k - 1, 0); w <= std::min(k + 1, dims.z - 1); ++w) {
    for (int v = std::max(j - 1, 0); v <= std::min(j + 1, dims.y - 1); ++v) {
      for (int u = std::max(i - 1, 0); u <= std::min(i + 1, dims.x - 1); ++u) {
        if (!volume.isMasked(u, v, w)) return true;
      }
    }
  }
  return false;
}

/// The value of a voxel, or of the first above it that is not masked; the topmost one is used if all are
/// masked.
float filledValue(const DenseVolume& volume, int i, int j, int k) {
  while (volume.isMasked(i, j, k) && k + 1 < volume.grid.dims.z) ++k;
  return volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
}

std::vector<SparseBlock> blocksOf(const nano::Handle& grid, const Dims& dims) {
  std::vector<SparseBlock> blocks;
  for (int z = 0; z < dims.z; z += 8) {
    for (int y = 0; y < dims.y; y += 8) {
      for (int x = 0; x < dims.x; x += 8) blocks.push_back(sparseBlockAt(grid.data(), x / 8, y / 8, z / 8));
    }
  }
  return blocks;
}

bool sameValue(float a, float b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

TEST(NanovdbGrid, SamplesEqualDenseVolume) {
  for (const DenseVolume& volume : {test::fieldVolume(), test::categoricalVolume(), test::plainVolume()}) {
    const nano::Handle grid = toNano(readyForSampling(volume), {});
    const Dims& dims = volume.grid.dims;
    const std::vector<SparseBlock> blocks = blocksOf(grid, dims);
    const SparseVoxels voxels(blocks.data(), dims);
    for (int k = 0; k < dims.z; ++k) {
      for (int j = 0; j < dims.y; ++j) {
        for (int i = 0; i < dims.x; ++i) {
          const float expected =
              isReached(volume, i, j, k) ? filledValue(volume, i, j, k) : volume.info.floor;
          ASSERT_TRUE(sameValue(voxels.at(i, j, k), expected))
              << volume.info.quantity << " " << i << " " << j << " " << k << ": " << voxels.at(i, j, k)
              << " instead of " << expected;
        }
      }
    }
  }
}

TEST(NanovdbGrid, VoxelsAtTheFloorTakeNoMemory) {
  DenseVolume volume = test::plainVolume({128, 128, 128});
  std::fill(volume.values.begin(), volume.values.end(), volume.info.floor);
  const std::size_t empty = toNano(readyForSampling(volume), {}).size();
  volume.values[static_cast<std::size_t>(volume.grid.index(64, 64, 64))] = volume.info.floor + 1;
  const std::size_t one_voxel = toNano(readyForSampling(volume), {}).size();
  EXPECT_LT(empty, 100000U);
  EXPECT_LT(one_voxel, volume.values.size() * sizeof(float) / 10);
}

TEST(CudaNanovdbGrid, EqualsUploadedGrid) {
  EMSCAPE_NEEDS_GPU();
  for (const DenseVolume& volume : {test::fieldVolume(), test::categoricalVolume(), test::plainVolume()}) {
    DeviceVolume device(volume.grid, VoxelPrecision::sparse32);
    device.upload(volume);
    const DenseVolume back = device.download();
    ASSERT_EQ(back.values.size(), volume.values.size());
    for (std::size_t n = 0; n < back.values.size(); ++n) {
      ASSERT_TRUE(sameValue(back.values[n], volume.values[n])) << volume.info.quantity << " " << n;
    }
    EXPECT_EQ(back.first_valid_k, volume.first_valid_k);
    EXPECT_GT(device.bytes(), 0U);
  }
}

}  // namespace
}  // namespace emscape::volume
