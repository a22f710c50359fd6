#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"
#include "render/cuda/texture_samplers.h"

namespace emscape::render::cuda {
namespace {

template <class Sampler>
__global__ void __launch_bounds__(kTileThreads)
    cutRays(const __grid_constant__ RaycastTask task, const bool* only,
            const __grid_constant__ CutLayer layer) {
  const ImageSize size = task.camera.size;
  int x = 0, y = 0;
  if (!pixelOfThread(size, x, y)) return;
  const long long index = pixelIndex(size, x, y);
  if (only != nullptr && !only[index]) return;
  const bool has_ground = layer.ground_distances != nullptr;
  const float ground = has_ground ? layer.ground_distances[index] : INFINITY;
  const CutRay ray = task.cutRay<Sampler>(x, y, ground);
  layer.begins[index] = ray.bounds.begin;
  layer.limits[index] = ray.bounds.end;
  if (ray.section.a > 0.0F) {
    layer.distances[index] = ray.bounds.end;
    layer.colors[index] = toFloat4(ray.section);
  } else {
    layer.distances[index] = ground;
    if (ground < INFINITY) layer.colors[index] = layer.ground_colors[index];
  }
}

template <class Sampler>
__global__ void __launch_bounds__(kTileThreads)
    mapGround(const __grid_constant__ RaycastTask task, const bool* only,
              const __grid_constant__ MapLayer layer) {
  const ImageSize size = task.camera.size;
  int x = 0, y = 0;
  if (!pixelOfThread(size, x, y)) return;
  const long long index = pixelIndex(size, x, y);
  if (only != nullptr && !only[index]) return;
  const float distance = layer.distances[index];
  if (!(distance < INFINITY)) return;
  const Rgba ground = toRgba(layer.colors[index]);
  layer.mapped[index] =
      toFloat4(layer.is_surface[index] ? task.mapColor<Sampler>(x, y, distance, ground) : ground);
}

template <class Sampler>
void start(const RaycastTask& task, const bool* only, const CutLayer& layer, cudaStream_t stream) {
  const ImageSize size = task.camera.size;
  cutRays<Sampler><<<tileCount(size), kTileThreads, 0, stream>>>(task, only, layer);
  emscape::cuda::checkLaunch("cutRays");
}

template <class Sampler>
void start(const RaycastTask& task, const bool* only, const MapLayer& layer, cudaStream_t stream) {
  const ImageSize size = task.camera.size;
  mapGround<Sampler><<<tileCount(size), kTileThreads, 0, stream>>>(task, only, layer);
  emscape::cuda::checkLaunch("mapGround");
}

/// Starts the kernel of a layer with the sampler that is as accurate as the CPU's.
template <class Layer>
void startAccurate(const RaycastTask& task, Sampling sampling, const bool* only, const Layer& layer,
                   cudaStream_t stream) {
  switch (sampling) {
    case Sampling::sparse:
    case Sampling::sparse_accurate:
      return start<AccurateTileSampler>(task, only, layer, stream);
    case Sampling::sparse_nearest:
      return start<NearestTileSampler>(task, only, layer, stream);
    case Sampling::nearest:
      return start<NearestTextureSampler>(task, only, layer, stream);
    case Sampling::filtered:
    case Sampling::accurate:
      break;
  }
  return start<AccurateSampler>(task, only, layer, stream);
}

}  // namespace

void castCut(const RaycastTask& task, Sampling sampling, const bool* only, const CutLayer& layer,
             cudaStream_t stream) {
  startAccurate(task, sampling, only, layer, stream);
}

void castMap(const RaycastTask& task, Sampling sampling, const bool* only, const MapLayer& layer,
             cudaStream_t stream) {
  startAccurate(task, sampling, only, layer, stream);
}

}  // namespace emscape::render::cuda
