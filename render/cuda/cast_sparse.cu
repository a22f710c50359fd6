#include "render/cuda/adaptive_frame.h"
#include "render/cuda/cast_rays.h"
#include "render/cuda/grid_voxels.h"

namespace emscape::render::cuda {
namespace {

template <class Launch>
void startSparse(const Launch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  if (sampling == Sampling::sparse_nearest) {
    return startVolume<NearestSamplerOf<GridVoxels>, GlobalColors, false>(launch, mode, stream);
  }
  using Sampler = TrilinearSamplerOf<GridVoxels>;
  return launch.task.shading.shades_fog ? startVolume<Sampler, GlobalColors, true>(launch, mode, stream)
                                        : startVolume<Sampler, GlobalColors, false>(launch, mode, stream);
}

}  // namespace

void castSparse(const CastLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  startSparse(launch, mode, sampling, stream);
}

void castSparse(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  startSparse(launch, mode, sampling, stream);
}

}  // namespace emscape::render::cuda
