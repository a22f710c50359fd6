#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {
namespace {

/// The layer as midpoints see it; see predictMidpoint().
struct KnownLayer {
  using Color = Rgba;
  const Layer& layer;
  ImageSize size;

  EMSCAPE_HD Rgba at(int x, int y) const {
    const float4 p = layer.at(x, y);
    return {p.x, p.y, p.z, p.w};
  }
};

/// Appends the pixels of those threads of a warp that have one: one place after the other, in one step.
__device__ void append(bool has_pixel, const Pixel& pixel, Pixel* queue, unsigned* queued) {
  const unsigned lanes = __ballot_sync(~0U, has_pixel);
  if (lanes == 0) return;
  const unsigned lane = threadIdx.x % 32;
  unsigned first = 0;
  if (lane == 0) first = atomicAdd(queued, static_cast<unsigned>(__popc(lanes)));
  first = __shfl_sync(~0U, first, 0);
  if (has_pixel) queue[first + static_cast<unsigned>(__popc(lanes & ((1U << lane) - 1)))] = pixel;
}

__global__ void __launch_bounds__(kTileThreads) predictPass(const PredictLaunch launch) {
  const ImageSize size = launch.size;
  const Pass& pass = launch.pass;
  const Place place = placeOfThread(pass.columns(size));
  const int y = pass.firstY() + place.row * pass.stepY();
  const int x = pass.firstX(y) + place.column * pass.stepX();
  bool must_be_cast = false;
  if (x < size.width && y < size.height) {
    const long long index = pixelIndex(size, x, y);
    std::uint8_t error_class = 0;
    if (!launch.inside[y].contains(x)) {
      launch.layer.at(x, y) = make_float4(0, 0, 0, 0);
    } else {
      Prediction<Rgba> prediction;
      must_be_cast = !predictMidpoint(KnownLayer{launch.layer, size}, pass, x, y, prediction) ||
                     !(prediction.error_levels <= launch.tolerance_levels);
      if (!must_be_cast) {
        launch.layer.at(x, y) = toFloat4(prediction.color);
        error_class = errorClassOf(prediction.error_levels);
      }
    }
    launch.classes[index] = error_class;
  }
  append(must_be_cast, {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}, launch.queue,
         launch.queued);
}

/// The class of this thread's pixel; 0: it has none, or one that was cast.
__device__ int classOfThread(const std::uint8_t* classes, ImageSize size, const Place& place) {
  if (place.column >= size.width || place.row >= size.height) return 0;
  return classes[pixelIndex(size, place.column, place.row)];
}

__global__ void __launch_bounds__(kTileThreads)
    countClasses(const std::uint8_t* classes, ImageSize size, ClassCounts* counts) {
  __shared__ unsigned found[kErrorClasses];
  if (threadIdx.x < kErrorClasses) found[threadIdx.x] = 0;
  __syncthreads();
  const int error_class = classOfThread(classes, size, placeOfThread(size.width));
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
  const Place place = placeOfThread(size.width);
  const int error_class = classOfThread(classes, size, place);
  const unsigned rank = error_class > 0 ? atomicAdd(&found[error_class], 1U) : 0;
  __syncthreads();
  if (threadIdx.x < kErrorClasses && found[threadIdx.x] > 0) {
    unsigned begin = atomicAdd(&counts->placed[threadIdx.x], found[threadIdx.x]);
    for (unsigned higher = threadIdx.x + 1; higher < kErrorClasses; ++higher) begin += counts->found[higher];
    first[threadIdx.x] = begin;
  }
  __syncthreads();
  if (error_class > 0) {
    list[first[error_class] + rank] = {static_cast<std::uint16_t>(place.column),
                                       static_cast<std::uint16_t>(place.row)};
  }
}

}  // namespace

void predictMidpoints(const PredictLaunch& launch, cudaStream_t stream) {
  const unsigned blocks = tileCount(launch.pass.columns(launch.size), launch.pass.rows(launch.size));
  predictPass<<<blocks, kTileThreads, 0, stream>>>(launch);
  emscape::cuda::checkLaunch("predictPass");
}

void listPredicted(const std::uint8_t* classes, ImageSize size, ClassCounts* counts, Pixel* list,
                   cudaStream_t stream) {
  const unsigned blocks = tileCount(size.width, size.height);
  countClasses<<<blocks, kTileThreads, 0, stream>>>(classes, size, counts);
  emscape::cuda::checkLaunch("countClasses");
  placePixels<<<blocks, kTileThreads, 0, stream>>>(classes, size, counts, list);
  emscape::cuda::checkLaunch("placePixels");
}

}  // namespace emscape::render::cuda
