#include "emscape/volume/device_volume.h"

#include <algorithm>

#include "volume/bricks.h"

namespace emscape::volume {

std::size_t deviceBytes(const Dims& dims, VoxelPrecision precision) {
  const auto voxels = static_cast<std::size_t>(dims.count());
  const auto columns = static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
  const std::size_t bricks = static_cast<std::size_t>(brickDims(dims, kBrickEdge).count());
  const std::size_t voxel_bytes = precision == VoxelPrecision::float32   ? 4
                                  : precision == VoxelPrecision::float16 ? 2
                                                                         : 0;
  return voxels * voxel_bytes + columns * sizeof(std::int32_t) + bricks * sizeof(ValueRange);
}

std::shared_ptr<DeviceVolume> DeviceVolumeRing::next(const Grid& grid, VoxelPrecision precision) {
  const auto unfit = [&](const std::shared_ptr<DeviceVolume>& volume) {
    return volume->grid() != grid || volume->precision() != precision;
  };
  volumes_.erase(std::remove_if(volumes_.begin(), volumes_.end(), unfit), volumes_.end());
  for (const auto& volume : volumes_) {
    if (volume.use_count() == 1) return volume;
  }
  return volumes_.emplace_back(std::make_shared<DeviceVolume>(grid, precision));
}

}  // namespace emscape::volume
