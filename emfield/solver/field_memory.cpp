// Memory of the field on the host or on a GPU.

#include "emfield/solver/field_engine.h"

namespace emscape::emfield {

std::size_t postBytes(const scenario::TerrainView& terrain) {
  std::size_t posts = 0;
  for (int r = 0; r < terrain.count; ++r) {
    posts += static_cast<std::size_t>(terrain.rasters[r].columns) *
             static_cast<std::size_t>(terrain.rasters[r].rows);
  }
  return posts * sizeof(float);
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
