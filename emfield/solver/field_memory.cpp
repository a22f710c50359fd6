// Memory of the field on the host or on a GPU.

#include "emfield/solver/field_engine.h"

namespace emscape::emfield {

std::size_t postBytes(const scenario::TerrainView& terrain) {
  const auto posts = [](const scenario::TerrainRaster* rasters, int count) {
    std::size_t sum = 0;
    for (int r = 0; r < count; ++r)
      sum += static_cast<std::size_t>(rasters[r].columns) * static_cast<std::size_t>(rasters[r].rows);
    return sum;
  };
  return (posts(terrain.rasters, terrain.count) + posts(terrain.surfaces, terrain.surface_count)) *
             sizeof(float) +
         static_cast<std::size_t>(terrain.cover.columns) * static_cast<std::size_t>(terrain.cover.rows);
}

std::size_t cpuEngineBytes(const FieldSetup& setup, std::size_t slot_bytes) {
  const auto voxels = static_cast<std::size_t>(setup.grid.dims.count());
  std::size_t bytes = slot_bytes;
  for (const ChannelPlan& plan : setup.channel_plans) {
    const std::size_t accumulators = hasSecond(plan.reduction) ? 2 : 1;
    // sums of all and of the static_count emitters; one displayed volume and one being written
    bytes += (2 * accumulators + 2) * voxels * sizeof(float);
  }
  return bytes;
}

std::size_t cudaEngineBytes(const FieldSetup& setup, std::size_t slot_bytes,
                            volume::VoxelPrecision precision) {
  const auto voxels = static_cast<std::size_t>(setup.grid.dims.count());
  std::size_t bytes = slot_bytes;
  for (const ChannelPlan& plan : setup.channel_plans) {
    const std::size_t accumulators = hasSecond(plan.reduction) ? 2 : 1;
    // sums of all and of the static_count emitters; one displayed volume and one being written
    bytes += 2 * voxels * accumulators * sizeof(float) + 2 * volume::deviceBytes(setup.grid.dims, precision);
  }
  if (setup.terrain != nullptr) bytes += postBytes(setup.terrain->view());
  return bytes + kDeviceScratchBytes;
}

}  // namespace emscape::emfield
