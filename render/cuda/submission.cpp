#include "render/cuda/submission.h"

#include "base/cuda/cuda_memory.h"

namespace emscape::render::cuda {

void Submission::start(const char* name, const void* kernel, const LaunchShape& shape,
                       const std::vector<const void*>& parameters) const {
  cudaLaunchAttribute attribute{};
  if (shape.kind == LaunchKind::together) {
    attribute.id = cudaLaunchAttributeCooperative;
    attribute.val.cooperative = 1;
  } else {
    attribute.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    attribute.val.programmaticStreamSerializationAllowed = 1;
  }
  cudaLaunchConfig_t config{};
  config.gridDim = shape.grid;
  config.blockDim = shape.block;
  config.dynamicSmemBytes = shape.shared_bytes;
  config.stream = stream_;
  config.attrs = &attribute;
  config.numAttrs = shape.kind == LaunchKind::plain ? 0 : 1;
  std::vector<void*> places;
  for (const void* parameter : parameters) places.push_back(const_cast<void*>(parameter));
  // What goes wrong is told by checkLaunch(), with the kernel's name.
  static_cast<void>(cudaLaunchKernelExC(&config, kernel, places.data()));
  emscape::cuda::checkLaunch(name);
}

}  // namespace emscape::render::cuda
