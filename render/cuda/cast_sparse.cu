#include "render/cuda/adaptive_frame.h"
#include "render/cuda/cast_rays.h"
#include "render/cuda/texture_samplers.h"

namespace emscape::render::cuda {
namespace {

template <class Launch>
void startSparse(const Launch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  const bool shades = launch.task.shading.shades_fog;
  switch (sampling) {
    case Sampling::sparse_nearest:
      return startVolume<NearestTileSampler, GlobalColors, false>(launch, mode, stream);
    case Sampling::sparse_accurate:
      return shades ? startVolume<AccurateTileSampler, GlobalColors, true>(launch, mode, stream)
                    : startVolume<AccurateTileSampler, GlobalColors, false>(launch, mode, stream);
    case Sampling::sparse:
    case Sampling::nearest:  // these are cast by castPixels()
    case Sampling::accurate:
    case Sampling::filtered:
      break;
  }
  return shades ? startVolume<FilteredTileSampler, SharedColors, true>(launch, mode, stream)
                : startVolume<FilteredTileSampler, SharedColors, false>(launch, mode, stream);
}

}  // namespace

void castSparse(const CastLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  startSparse(launch, mode, sampling, stream);
}

void castSparse(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  startSparse(launch, mode, sampling, stream);
}

}  // namespace emscape::render::cuda
