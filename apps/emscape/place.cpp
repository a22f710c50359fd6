#include "apps/emscape/place.h"

namespace emscape::app {
namespace {

volume::VoxelPrecision precisionOf(const std::string& device_volume) {
  return device_volume == "half" ? volume::VoxelPrecision::float16 : volume::VoxelPrecision::float32;
}

}  // namespace

emfield::FieldOptions Place::fieldOptions() const {
  emfield::FieldOptions options;
  options.backend = choice.backend;
  options.device_precision = precisionOf(device_volume);
  return options;
}

render::RendererOptions Place::rendererOptions() const {
  render::RendererOptions options;
  options.backend = choice.backend;
  options.precision = precisionOf(device_volume);
  return options;
}

void addDeviceVolumeOption(CLI::App& command, std::string& device_volume) {
  command
      .add_option("--device-volume", device_volume,
                  "How a GPU keeps the volume: in 32 bit, or in 16 bit: half the memory, "
                  "11 significant bits")
      ->check(CLI::IsMember({"float", "half"}));
}

}  // namespace emscape::app
