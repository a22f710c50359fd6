#include "render/cuda/adaptive_frame.h"
#include "render/cuda/cast_rays.h"
#include "render/cuda/grid_voxels.h"

namespace emscape::render::cuda {
namespace {

template <class Launch>
void startSparse(const Launch& launch, CompositingMode mode, Sampling sampling, const Submission& to) {
  if (sampling == Sampling::sparse_nearest) {
    return startVolume<NearestSamplerOf<GridVoxels>, GlobalColors, false>(launch, mode, to);
  }
  using Sampler = TrilinearSamplerOf<GridVoxels>;
  return launch.task.shading.shades_fog ? startVolume<Sampler, GlobalColors, true>(launch, mode, to)
                                        : startVolume<Sampler, GlobalColors, false>(launch, mode, to);
}

}  // namespace

void castSparse(const CastLaunch& launch, CompositingMode mode, Sampling sampling, const Submission& to) {
  startSparse(launch, mode, sampling, to);
}

void castSparse(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, const Submission& to) {
  startSparse(launch, mode, sampling, to);
}

}  // namespace emscape::render::cuda
