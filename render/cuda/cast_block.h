/// Block size, barrier and ray bounds of all kernels that cast. For .cu files.
#pragma once

#include <cuda_pipeline.h>

#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Threads of a block, one block per multiprocessor. Warps process pixels independently of each other.
constexpr int kCastThreads = 768;
constexpr unsigned kCastWarps = kCastThreads / 32;

/// A barrier: all copies of the block's threads to shared memory, by __pipeline_memcpy_async() too, are
/// complete.
__device__ inline void waitForCopies() {
  __pipeline_wait_prior(0);
  __syncthreads();
}

__device__ inline bool isToBeCast(const CastLaunch& launch, const Pixel& pixel) {
  return launch.predicted == nullptr ||
         launch.predicted[pixelIndex(launch.task.camera.size, pixel.x, pixel.y)];
}

/// Beginning and end of the samples on a pixel's ray.
__device__ inline RayBounds boundsOf(const CastLaunch& launch, const Pixel& pixel) {
  RayBounds bounds;
  if (launch.limits == nullptr) return bounds;
  const long long index = pixelIndex(launch.task.camera.size, pixel.x, pixel.y);
  bounds.end = launch.limits[index];
  if (launch.begins != nullptr) bounds.begin = launch.begins[index];
  return bounds;
}

}  // namespace emscape::render::cuda
