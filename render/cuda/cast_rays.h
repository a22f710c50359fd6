/// Rays as kernels cast them, whatever they sample. For .cu files.
#pragma once

#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Samples fetched at a time: with few rays, and at the end of a launch, too few threads are left to hide the
/// wait for one. More registers a thread mean fewer threads.
template <class Compositor>
constexpr int kBatch = Compositor::kEndsItself ? 8 : 4;

/// Threads of a block. Their warps take pixels independently of each other.
constexpr int kCastThreads = 256;

/// The table where it lies.
class GlobalColors {
 public:
  static unsigned sharedBytes(const CastLaunch& /*launch*/) { return 0; }
  __device__ explicit GlobalColors(const CastLaunch& launch) : samples_(launch.task.transfer.samples) {}
  EMSCAPE_HD const Rgba& at(int index) const { return samples_[index]; }

 private:
  const Rgba* samples_;
};

template <class RayCompositor, class Sampler, class SampleColors, bool kMayShade>
struct VolumeRay {
  using Compositor = RayCompositor;
  using Colors = SampleColors;
  static constexpr int kParts = kMayShade ? 1 : Compositor::kParts;
  static constexpr int kFetched = kMayShade ? 1 : kBatch<Compositor>;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& colors, int x, int y, double limit) {
    return launch.task.castVolume<Compositor, Sampler, kMayShade, kFetched>(x, y, limit, colors,
                                                                            *launch.volume_highest_f);
  }
  __device__ static Compositor begin(const CastLaunch& launch) {
    return {launch.task.opaque_enough, launch.task.mida_gamma, *launch.volume_highest_f};
  }
  __device__ static bool castPart(const CastLaunch& launch, const RayPieces& pieces, int part,
                                  const Colors& colors, Compositor& compositor) {
    return launch.task.castPart<Compositor, Sampler, kMayShade, kFetched>(pieces, part, colors, compositor);
  }
};
template <class Sampler>
struct SurfaceRay {
  using Colors = GlobalColors;
  static constexpr int kParts = 1;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& /*colors*/, int x, int y,
                              double limit) {
    return launch.task.castSurface<Sampler>(x, y, limit);
  }
};

/// Pixels of a launch in portions for a warp: rectangles of a lattice, pieces of a list.
/// @param kWidth, kHeight  of a rectangle; their product is the size of a piece
template <int kWidth, int kHeight>
class WarpTiles {
 public:
  static constexpr unsigned kPixels = kWidth * kHeight;

  __device__ explicit WarpTiles(const PixelSet& pixels) : pixels_(pixels) {}

  __device__ unsigned count() const {
    if (pixels_.list != nullptr) return (listEnd() - pixels_.first + kPixels - 1) / kPixels;
    return static_cast<unsigned>(columns()) * static_cast<unsigned>(rows());
  }
  /// @param n  of the tile's pixels, 0..kPixels - 1. @return false: there is none
  __device__ bool pixel(unsigned tile, unsigned n, Pixel& pixel) const {
    if (pixels_.list != nullptr) {
      const unsigned place = pixels_.first + tile * kPixels + n;
      if (place >= listEnd()) return false;
      pixel = pixels_.list[place];
      return true;
    }
    const Lattice& lattice = pixels_.lattice;
    const int column = static_cast<int>(tile) % columns() * kWidth + static_cast<int>(n) % kWidth;
    const int row = middleOut(static_cast<int>(tile) / columns()) * kHeight + static_cast<int>(n) / kWidth;
    if (column >= lattice.columns || row >= lattice.rows) return false;
    pixel = {static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
             static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
    return true;
  }

 private:
  __device__ unsigned listEnd() const {
    return pixels_.length != nullptr && *pixels_.length < pixels_.end ? *pixels_.length : pixels_.end;
  }
  __device__ int columns() const { return (pixels_.lattice.columns + kWidth - 1) / kWidth; }
  __device__ int rows() const { return (pixels_.lattice.rows + kHeight - 1) / kHeight; }
  /// Rows from the middle to the edges: the longest rays, which mostly are there, begin first, so that a
  /// launch ends with short ones.
  __device__ int middleOut(int n) const { return (rows() - 1) / 2 + (n % 2 == 1 ? (n + 1) / 2 : -(n / 2)); }

  const PixelSet& pixels_;
};

/// Portions of a launch, given to warps as they ask. All of them ask until there is none left.
class TileQueue {
 public:
  __device__ TileQueue(unsigned* next, unsigned tiles) : next_(next), tiles_(tiles) {}

  /// @return false: none is left
  __device__ bool take(unsigned lane, unsigned& tile) const {
    if (lane == 0) {
      tile = atomicAdd(next_, 1U);
      // The last one to ask leaves the counter as it found it.
      if (tile == tiles_ + gridDim.x * (blockDim.x / 32) - 1) *next_ = 0;
    }
    tile = __shfl_sync(~0U, tile, 0);
    return tile < tiles_;
  }

 private:
  unsigned* next_;
  unsigned tiles_;
};

__device__ inline double limitOf(const CastLaunch& launch, long long index) {
  return launch.limits != nullptr ? launch.limits[index] : 1e300;
}

/// A thread a ray.
template <class RayOf>
__global__ void __launch_bounds__(kCastThreads) castRays(const __grid_constant__ CastLaunch launch) {
  const typename RayOf::Colors colors(launch);
  const WarpTiles<8, 4> tiles(launch.pixels);
  const TileQueue queue(launch.next_tile, tiles.count());
  const unsigned lane = threadIdx.x % 32;
  unsigned tile = 0;
  while (queue.take(lane, tile)) {
    Pixel pixel;
    if (!tiles.pixel(tile, lane, pixel)) continue;
    const long long index = pixelIndex(launch.task.camera.size, pixel.x, pixel.y);
    launch.layer[index] = toFloat4(RayOf::cast(launch, colors, pixel.x, pixel.y, limitOf(launch, index)));
  }
}

/// As many threads a ray as it has parts: for launches of so few rays that most of the GPU would wait for the
/// longest. The pixels are those that castRays() makes.
template <class RayOf>
__global__ void __launch_bounds__(kCastThreads) castRaysInParts(const __grid_constant__ CastLaunch launch) {
  using Compositor = typename RayOf::Compositor;
  constexpr unsigned kParts = Compositor::kParts;
  constexpr unsigned kRays = 32 / kParts;
  __shared__ alignas(Compositor) unsigned char memory[kCastThreads * sizeof(Compositor)];
  Compositor* const composited = reinterpret_cast<Compositor*>(memory) + threadIdx.x / kParts * kParts;
  const typename RayOf::Colors colors(launch);
  const WarpTiles<2, kRays / 2> tiles(launch.pixels);
  const TileQueue queue(launch.next_tile, tiles.count());
  const unsigned lane = threadIdx.x % 32;
  const int part = static_cast<int>(lane % kParts);
  unsigned tile = 0;
  while (queue.take(lane, tile)) {
    Pixel pixel;
    const bool has_pixel = tiles.pixel(tile, lane / kParts, pixel);
    const long long index = pixelIndex(launch.task.camera.size, pixel.x, pixel.y);
    const RayPieces pieces = launch.task.piecesOf(pixel.x, pixel.y, has_pixel ? limitOf(launch, index) : 0.0);
    Compositor own = RayOf::begin(launch);
    if (pieces.count > 0) RayOf::castPart(launch, pieces, part, colors, own);
    composited[part] = own;
    __syncwarp();
    if (part == 0 && has_pixel) {
      Compositor compositor = RayOf::begin(launch);
      LookAhead ahead(launch.task.skip, launch.task.volume, pieces);
      for (int n = 0; n < static_cast<int>(kParts); ++n) {
        Compositor joined = compositor;
        joined.join(composited[n]);
        if (joined.done(ahead, 0)) {
          Compositor last = compositor.behind();
          RayOf::castPart(launch, pieces, n, colors, last);
          compositor.join(last);
          break;
        }
        compositor = joined;
      }
      launch.layer[index] = toFloat4(compositor.result(launch.task.transfer));
    }
    __syncwarp();
  }
}

/// Blocks of a kernel that run at a time.
inline unsigned residentBlocks(void (*kernel)(CastLaunch), unsigned shared_bytes) {
  int device = 0, multiprocessors = 0, blocks = 0;
  emscape::cuda::check(cudaGetDevice(&device), "cudaGetDevice");
  emscape::cuda::check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
                       "cudaDeviceGetAttribute");
  emscape::cuda::check(
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, kCastThreads, shared_bytes),
      "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
  return static_cast<unsigned>(multiprocessors * std::max(blocks, 1));
}

/// @param warps  that find something to do
inline void launchKernel(void (*kernel)(CastLaunch), const char* name, const CastLaunch& launch,
                         long long warps, unsigned resident, unsigned shared_bytes, cudaStream_t stream) {
  if (warps == 0) return;
  const auto blocks = static_cast<unsigned>(std::min<long long>(warps, resident));
  kernel<<<blocks, kCastThreads, shared_bytes, stream>>>(launch);
  emscape::cuda::checkLaunch(name);
}

template <class RayOf>
void start(const CastLaunch& launch, cudaStream_t stream) {
  const PixelSet& pixels = launch.pixels;
  const long long rays = pixels.list != nullptr ? pixels.end - pixels.first : pixels.lattice.count();
  const unsigned shared_bytes = RayOf::Colors::sharedBytes(launch);
  if constexpr (RayOf::kParts > 1) {
    if (launch.few_rays) {
      static const unsigned resident = residentBlocks(castRaysInParts<RayOf>, shared_bytes);
      constexpr long long kRays = 32 / RayOf::kParts;
      return launchKernel(castRaysInParts<RayOf>, "castRaysInParts", launch, (rays + kRays - 1) / kRays,
                          resident, shared_bytes, stream);
    }
  }
  static const unsigned resident = residentBlocks(castRays<RayOf>, shared_bytes);
  launchKernel(castRays<RayOf>, "castRays", launch, (rays + 31) / 32, resident, shared_bytes, stream);
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
