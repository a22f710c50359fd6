/// What the blocks of all kernels that cast have in common. For .cu files.
#pragma once

#include <cuda_pipeline.h>

#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Threads of a block, one block a multiprocessor. Warps take pixels independently of each other.
constexpr int kCastThreads = 768;
constexpr unsigned kCastWarps = kCastThreads / 32;

/// A barrier after which what the block's threads copy to shared memory, by __pipeline_memcpy_async() too, is
/// there.
__device__ inline void waitForCopies() {
  __pipeline_wait_prior(0);
  __syncthreads();
}

/// Where the samples of a pixel's ray begin and end.
__device__ inline RayBounds boundsOf(const CastLaunch& launch, const Pixel& pixel) {
  RayBounds bounds;
  if (launch.limits == nullptr) return bounds;
  const long long index = pixelIndex(launch.task.camera.size, pixel.x, pixel.y);
  bounds.end = launch.limits[index];
  if (launch.begins != nullptr) bounds.begin = launch.begins[index];
  return bounds;
}

}  // namespace emscape::render::cuda
