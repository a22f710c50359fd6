/// Rays as kernels cast them, whatever they sample. For .cu files.
#pragma once

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Samples fetched at a time: at the end of a launch, and where few rays are cast, too few threads are left
/// to hide the wait for one.
constexpr int kBatch = 4;

/// The table where it lies.
class GlobalColors {
 public:
  static unsigned sharedBytes(const CastLaunch& /*launch*/) { return 0; }
  __device__ explicit GlobalColors(const CastLaunch& launch) : samples_(launch.task.transfer.samples) {}
  EMSCAPE_HD const Rgba& at(int index) const { return samples_[index]; }

 private:
  const Rgba* samples_;
};

template <class Compositor, class Sampler, class SampleColors, bool kMayShade>
struct VolumeRay {
  using Colors = SampleColors;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& colors, int x, int y, double limit) {
    return launch.task.castVolume < Compositor, Sampler, kMayShade,
           kMayShade ? 1 : kBatch > (x, y, limit, colors, *launch.volume_highest_f);
  }
};
template <class Sampler>
struct SurfaceRay {
  using Colors = GlobalColors;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& /*colors*/, int x, int y,
                              double limit) {
    return launch.task.castSurface<Sampler>(x, y, limit);
  }
};

/// The pixel of this thread. @return false: it has none
__device__ inline bool pixelOfThread(const PixelSet& pixels, Pixel& pixel) {
  if (pixels.list != nullptr) {
    const unsigned n = pixels.first + blockIdx.x * kTileThreads + threadIdx.x;
    const unsigned length = pixels.length != nullptr ? *pixels.length : pixels.end;
    if (n >= pixels.end || n >= length) return false;
    pixel = pixels.list[n];
    return true;
  }
  const Lattice& lattice = pixels.lattice;
  const Place place = placeOfThread(lattice.columns);
  if (place.column >= lattice.columns || place.row >= lattice.rows) return false;
  pixel = {static_cast<std::uint16_t>(lattice.first_x + place.column * lattice.step_x),
           static_cast<std::uint16_t>(lattice.first_y + place.row * lattice.step_y)};
  return true;
}

template <class RayOf>
__global__ void __launch_bounds__(kTileThreads) castRays(const __grid_constant__ CastLaunch launch) {
  const PixelSet& pixels = launch.pixels;
  if (pixels.length != nullptr && pixels.first + blockIdx.x * kTileThreads >= *pixels.length) return;
  const typename RayOf::Colors colors(launch);
  Pixel pixel;
  if (!pixelOfThread(pixels, pixel)) return;
  const long long index = pixelIndex(launch.task.camera.size, pixel.x, pixel.y);
  const double limit = launch.limits != nullptr ? launch.limits[index] : 1e300;
  launch.layer[index] = toFloat4(RayOf::cast(launch, colors, pixel.x, pixel.y, limit));
}

template <class RayOf>
void start(const CastLaunch& launch, cudaStream_t stream) {
  const PixelSet& pixels = launch.pixels;
  const unsigned blocks = pixels.list != nullptr
                              ? (pixels.end - pixels.first + kTileThreads - 1) / kTileThreads
                              : tileCount(pixels.lattice.columns, pixels.lattice.rows);
  if (blocks == 0) return;
  castRays<RayOf><<<blocks, kTileThreads, RayOf::Colors::sharedBytes(launch), stream>>>(launch);
  emscape::cuda::checkLaunch("castRays");
}

template <class Sampler, class Colors, bool kMayShade>
void startVolume(const CastLaunch& launch, CompositingMode mode, cudaStream_t stream) {
  switch (mode) {
    case CompositingMode::mida:
      return start<VolumeRay<MidaCompositor, Sampler, Colors, kMayShade>>(launch, stream);
    case CompositingMode::mip:
      return start<VolumeRay<MipCompositor, Sampler, GlobalColors, false>>(launch, stream);
    case CompositingMode::iso:
      return start<SurfaceRay<Sampler>>(launch, stream);
    case CompositingMode::dvr:
      break;
  }
  return start<VolumeRay<DvrCompositor, Sampler, Colors, kMayShade>>(launch, stream);
}

}  // namespace emscape::render::cuda
