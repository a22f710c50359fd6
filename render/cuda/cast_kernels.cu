#include "render/cuda/adaptive_frame.h"
#include "render/cuda/cast_rays.h"
#include "render/cuda/texture_samplers.h"

namespace emscape::render::cuda {
namespace {

__global__ void __launch_bounds__(kTileThreads)
    groundRays(const __grid_constant__ RaycastTask task, const bool* only, float* distances, float4* colors,
               bool* is_surface) {
  const ImageSize size = task.camera.size;
  int x = 0, y = 0;
  if (!pixelOfThread(size, x, y)) return;
  const long long index = pixelIndex(size, x, y);
  if (only != nullptr && !only[index]) return;
  const GroundHit hit = task.groundAt(x, y);
  distances[index] = hit.found ? static_cast<float>(hit.distance) : INFINITY;
  if (hit.found) colors[index] = toFloat4(hit.color);
  is_surface[index] = hit.is_surface;
}

template <class Launch>
void startSampling(const Launch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  const bool shades = launch.task.shading.shades_fog;
  switch (sampling) {
    case Sampling::sparse:
    case Sampling::sparse_accurate:
    case Sampling::sparse_nearest:
      return castSparse(launch, mode, sampling, stream);
    case Sampling::nearest:
      return startVolume<NearestTextureSampler, GlobalColors, false>(launch, mode, stream);
    case Sampling::accurate:
      return shades ? startVolume<AccurateSampler, GlobalColors, true>(launch, mode, stream)
                    : startVolume<AccurateSampler, GlobalColors, false>(launch, mode, stream);
    case Sampling::filtered:
      break;
  }
  return shades ? startVolume<FilteredSampler, SharedColors, true>(launch, mode, stream)
                : startVolume<FilteredSampler, SharedColors, false>(launch, mode, stream);
}

}  // namespace

void castPixels(const CastLaunch& launch, CompositingMode mode, Sampling sampling, cudaStream_t stream) {
  startSampling(launch, mode, sampling, stream);
}

void castAdaptive(const AdaptiveLaunch& launch, CompositingMode mode, Sampling sampling,
                  cudaStream_t stream) {
  startSampling(launch, mode, sampling, stream);
}

void castGround(const RaycastTask& task, const bool* only, float* distances, float4* colors, bool* is_surface,
                cudaStream_t stream) {
  const ImageSize size = task.camera.size;
  groundRays<<<tileCount(size), kTileThreads, 0, stream>>>(task, only, distances, colors, is_surface);
  emscape::cuda::checkLaunch("groundRays");
}

}  // namespace emscape::render::cuda
