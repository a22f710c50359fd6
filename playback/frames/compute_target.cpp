#include "emscape/playback/frames/compute_target.h"

namespace emscape::playback {

emfield::FieldOptions ComputeTarget::fieldOptions() const {
  emfield::FieldOptions options;
  options.backend = choice.backend;
  // Kernels write the field, which requires storage for every voxel.
  if (precision == volume::VoxelPrecision::float16) options.device_precision = precision;
  return options;
}

render::RendererOptions ComputeTarget::rendererOptions() const {
  render::RendererOptions options;
  options.backend = choice.backend;
  options.precision = precision;
  return options;
}

}  // namespace emscape::playback
