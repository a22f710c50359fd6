#include "apps/common/target.h"

namespace emscape::app {

volume::VoxelPrecision precisionOf(const std::string& device_volume) {
  if (device_volume == "half") return volume::VoxelPrecision::float16;
  if (device_volume == "sparse") return volume::VoxelPrecision::sparse32;
  return volume::VoxelPrecision::float32;
}

void addDeviceVolumeOption(CLI::App& command, std::string& device_volume) {
  command
      .add_option(
          "--device-volume", device_volume,
          "How a GPU stores the volume: float, 32 bit; half, 16 bit: half the memory, 11 significant bits; "
          "sparse: without voxels at the floor")
      ->check(CLI::IsMember({"float", "half", "sparse"}));
}

}  // namespace emscape::app
