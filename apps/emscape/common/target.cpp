#include "apps/emscape/common/target.h"

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
          "How a GPU keeps the volume: in 32 bit; in 16 bit, half the memory and 11 significant bits; or "
          "sparse, a NanoVDB grid without voxels at the floor")
      ->check(CLI::IsMember({"float", "half", "sparse"}));
}

}  // namespace emscape::app
