#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"
#include "render/patterns/edges.h"
#include "render/patterns/interpolation.h"

namespace emscape::render::cuda {
namespace {

__global__ void __launch_bounds__(kTileThreads)
    contrasts(ImageSize size, const uchar4* __restrict__ picture, std::uint8_t* found, unsigned* counts) {
  constexpr int kContrasts = 256;
  static_assert(kTileThreads == kContrasts, "one thread per number");
  __shared__ unsigned of_block[kContrasts];
  of_block[threadIdx.x] = 0;
  __syncthreads();
  int x = 0, y = 0;
  if (pixelOfThread(size, x, y)) {
    const int contrast = contrast_levels(size, x, y, [&](int at_x, int at_y) {
      return reinterpret_cast<const std::uint8_t*>(picture + pixelIndex(size, at_x, at_y));
    });
    found[pixelIndex(size, x, y)] = static_cast<std::uint8_t>(contrast);
    atomicAdd(&of_block[contrast], 1U);
  }
  __syncthreads();
  if (of_block[threadIdx.x] > 0) atomicAdd(&counts[threadIdx.x], of_block[threadIdx.x]);
}

__global__ void __launch_bounds__(kTileThreads)
    mark(ImageSize size, const std::uint8_t* contrasts, int least, bool* is_edge) {
  int x = 0, y = 0;
  if (!pixelOfThread(size, x, y)) return;
  const long long index = pixelIndex(size, x, y);
  is_edge[index] = contrasts[index] >= least;
}

__global__ void __launch_bounds__(kTileThreads)
    addRay(const __grid_constant__ Layers layers, const bool* is_edge, bool is_first, float4* means) {
  int x = 0, y = 0;
  if (!pixelOfThread(layers.size, x, y)) return;
  const long long index = pixelIndex(layers.size, x, y);
  if (!is_edge[index]) return;
  Rgba color = toRgba(layers.volume.at(x, y));
  if (layers.ground_distances != nullptr && layers.ground_distances[index] < INFINITY)
    color = over(color, toRgba(layers.ground_colors[index]));
  means[index] = toFloat4(addScaled(color, 1.0F / kEdgeRays, is_first ? Rgba{} : toRgba(means[index])));
}

__global__ void __launch_bounds__(kTileThreads)
    put(ImageSize size, const bool* is_edge, const float4* means, float4* picture, uchar4* picture8) {
  int x = 0, y = 0;
  if (!pixelOfThread(size, x, y)) return;
  const long long index = pixelIndex(size, x, y);
  if (!is_edge[index]) return;
  const float4 mean = means[index];
  if (picture != nullptr) picture[index] = mean;
  if (picture8 != nullptr)
    picture8[index] = make_uchar4(quantized(mean.x), quantized(mean.y), quantized(mean.z), quantized(mean.w));
}

}  // namespace

void findContrasts(ImageSize size, const uchar4* picture, std::uint8_t* found, unsigned* counts,
                   cudaStream_t stream) {
  contrasts<<<tileCount(size), kTileThreads, 0, stream>>>(size, picture, found, counts);
  emscape::cuda::checkLaunch("contrasts");
}

void markEdges(ImageSize size, const std::uint8_t* contrasts, int least, bool* is_edge, cudaStream_t stream) {
  mark<<<tileCount(size), kTileThreads, 0, stream>>>(size, contrasts, least, is_edge);
  emscape::cuda::checkLaunch("mark");
}

void addEdgeRay(const Layers& layers, const bool* is_edge, bool is_first, float4* means,
                cudaStream_t stream) {
  addRay<<<tileCount(layers.size), kTileThreads, 0, stream>>>(layers, is_edge, is_first, means);
  emscape::cuda::checkLaunch("addRay");
}

void putEdges(ImageSize size, const bool* is_edge, const float4* means, float4* picture, uchar4* picture8,
              cudaStream_t stream) {
  put<<<tileCount(size), kTileThreads, 0, stream>>>(size, is_edge, means, picture, picture8);
  emscape::cuda::checkLaunch("put");
}

}  // namespace emscape::render::cuda
