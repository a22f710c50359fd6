#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {
namespace {

/// The class of this thread's pixel (x, y); 0: there is none, or it was cast.
__device__ int classOfThread(const std::uint8_t* classes, ImageSize size, int& x, int& y) {
  return pixelOfThread(size, x, y) ? classes[pixelIndex(size, x, y)] : 0;
}

__global__ void __launch_bounds__(kTileThreads)
    countClasses(const std::uint8_t* classes, ImageSize size, ClassCounts* counts) {
  __shared__ unsigned found[kErrorClasses];
  if (threadIdx.x < kErrorClasses) found[threadIdx.x] = 0;
  __syncthreads();
  int x = 0, y = 0;
  const int error_class = classOfThread(classes, size, x, y);
  if (error_class > 0) atomicAdd(&found[error_class], 1U);
  __syncthreads();
  if (threadIdx.x < kErrorClasses && found[threadIdx.x] > 0) {
    atomicAdd(&counts->found[threadIdx.x], found[threadIdx.x]);
  }
}

__global__ void __launch_bounds__(kTileThreads)
    placePixels(const std::uint8_t* classes, ImageSize size, ClassCounts* counts, Pixel* list) {
  __shared__ unsigned found[kErrorClasses];
  __shared__ unsigned first[kErrorClasses];
  if (threadIdx.x < kErrorClasses) found[threadIdx.x] = 0;
  __syncthreads();
  int x = 0, y = 0;
  const int error_class = classOfThread(classes, size, x, y);
  const unsigned rank = error_class > 0 ? atomicAdd(&found[error_class], 1U) : 0;
  __syncthreads();
  if (threadIdx.x < kErrorClasses && found[threadIdx.x] > 0) {
    unsigned begin = atomicAdd(&counts->placed[threadIdx.x], found[threadIdx.x]);
    for (unsigned higher = threadIdx.x + 1; higher < kErrorClasses; ++higher) begin += counts->found[higher];
    first[threadIdx.x] = begin;
  }
  __syncthreads();
  if (error_class > 0) {
    list[first[error_class] + rank] = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
  }
}

}  // namespace

void listPredicted(const std::uint8_t* classes, ImageSize size, ClassCounts* counts, Pixel* list,
                   cudaStream_t stream) {
  const unsigned blocks = tileCount(size);
  countClasses<<<blocks, kTileThreads, 0, stream>>>(classes, size, counts);
  emscape::cuda::checkLaunch("countClasses");
  placePixels<<<blocks, kTileThreads, 0, stream>>>(classes, size, counts, list);
  emscape::cuda::checkLaunch("placePixels");
}

}  // namespace emscape::render::cuda
