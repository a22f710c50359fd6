/// Kernels that cast rays, for any sampler. For .cu files.
#pragma once

#include <cuda_fp16.h>

#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/cast_block.h"

namespace emscape::render::cuda {

/// Samples fetched at a time: with few rays, and at the end of a launch, too few threads are left to hide the
/// latency of one. More registers per thread mean fewer threads.
template <class Compositor>
constexpr int kBatch = Compositor::kEndsItself ? 8 : 4;

/// The table in global memory.
class GlobalColors {
 public:
  static unsigned sharedBytes(const CastLaunch& /*launch*/) { return 0; }
  __device__ explicit GlobalColors(const CastLaunch& launch) : samples_(launch.task.transfer.samples) {}
  EMSCAPE_HD const Rgba& at(int index) const { return samples_[index]; }

 private:
  const Rgba* samples_;
};

/// The table in shared memory, as halves, whose 11 bits are sufficient for 8 bits of a picture.
class SharedColors {
 public:
  static unsigned sharedBytes(const CastLaunch& launch) {
    return static_cast<unsigned>(pairs(launch) * sizeof(uint4));
  }
  /// Begins to copy the table; waitForCopies() must follow.
  __device__ explicit SharedColors(const CastLaunch& launch) {
    const uint4* from = reinterpret_cast<const uint4*>(launch.half_colors);
    uint4* to = reinterpret_cast<uint4*>(table());
    for (int i = static_cast<int>(threadIdx.x); i < pairs(launch); i += static_cast<int>(blockDim.x))
      __pipeline_memcpy_async(to + i, from + i, sizeof(uint4));
    __pipeline_commit();
  }
  EMSCAPE_HD Rgba at([[maybe_unused]] int index) const {
#if defined(__CUDA_ARCH__)
    const HalfColor color = table()[index];
    const float2 rg = __half22float2(reinterpret_cast<const __half2&>(color.rg));
    const float2 ba = __half22float2(reinterpret_cast<const __half2&>(color.ba));
    return {rg.x, rg.y, ba.x, ba.y};
#else
    return {};
#endif
  }

 private:
  /// Entries are copied in pairs.
  EMSCAPE_HD static int pairs(const CastLaunch& launch) {
    return (launch.task.transfer.last + 2) / 2;
  }
  __device__ static HalfColor* table() {
    extern __shared__ uint4 colors[];
    return reinterpret_cast<HalfColor*>(colors);
  }
};

template <class RayCompositor, class Sampler, class SampleColors, bool kMayShade>
struct VolumeRay {
  using Compositor = RayCompositor;
  using Colors = SampleColors;
  static constexpr int kParts = kMayShade ? 1 : Compositor::kParts;
  static constexpr int kFetched = kMayShade ? 1 : kBatch<Compositor>;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& colors, int x, int y,
                              RayBounds bounds) {
    return launch.task.castVolume<Compositor, Sampler, kMayShade, kFetched>(x, y, bounds, colors,
                                                                            *launch.volume_highest_f);
  }
  __device__ static Compositor begin(const CastLaunch& launch) {
    return {launch.task.opaque_enough, launch.task.mida_gamma, *launch.volume_highest_f};
  }
  __device__ static bool castPart(const CastLaunch& launch, const RaySegments& segments, int part,
                                  const Colors& colors, Compositor& compositor) {
    return launch.task.castPart<Compositor, Sampler, kMayShade, kFetched>(segments, part, colors, compositor);
  }
};
template <class Sampler>
struct SurfaceRay {
  using Colors = GlobalColors;
  static constexpr int kParts = 1;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& /*colors*/, int x, int y,
                              RayBounds bounds) {
    return launch.task.castSurface<Sampler>(x, y, bounds);
  }
};

/// Hands out 0, 1, 2, ... to warps, all threads of which call it.
/// @param next   0 before the first and after the last number
/// @param count  total number of requests
__device__ inline unsigned nextNumber(unsigned* next, unsigned count) {
  unsigned number = 0;
  if (threadIdx.x % 32 == 0) {
    number = atomicAdd(next, 1U);
    if (number + 1 == count) *next = 0;
  }
  return __shfl_sync(~0U, number, 0);
}

/// One thread per ray. Each warp takes the next tile when it has finished one.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads) castRays(const __grid_constant__ CastLaunch launch) {
  const typename RayKind::Colors colors(launch);
  const unsigned lane = threadIdx.x % 32, warps = gridDim.x * kCastWarps, tiles = launch.tiles.count();
  waitForCopies();
  unsigned tile = threadIdx.x / 32 * gridDim.x + blockIdx.x;  // the first tile needs no request
  while (tile < tiles) {
    Pixel pixel;
    if (launch.tiles.pixelOf(tile, lane, pixel) && isToBeCast(launch, pixel)) {
      launch.layer.at(pixel.x, pixel.y) =
          toFloat4(RayKind::cast(launch, colors, pixel.x, pixel.y, boundsOf(launch, pixel)));
    }
    tile = warps + nextNumber(launch.next_tile, tiles);
  }
}

/// Shared memory per block of the largest table.
constexpr int kMaxSharedBytes = (kMaxHalfColors + 1) * static_cast<int>(sizeof(HalfColor));

/// Sets a kernel's limit of shared memory for the largest table. @return number of its concurrent blocks
template <class Launch>
unsigned residentBlocks(void (*kernel)(Launch)) {
  emscape::cuda::check(
      cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, kMaxSharedBytes),
      "cudaFuncSetAttribute");
  int device = 0, multiprocessors = 0, blocks = 0;
  emscape::cuda::check(cudaGetDevice(&device), "cudaGetDevice");
  emscape::cuda::check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
                       "cudaDeviceGetAttribute");
  emscape::cuda::check(
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, kCastThreads, kMaxSharedBytes),
      "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
  return static_cast<unsigned>(multiprocessors * std::max(blocks, 1));
}

template <class RayKind>
void start(const CastLaunch& launch, cudaStream_t stream) {
  const long long rays = launch.tiles.lattice.count();
  if (rays == 0) return;
  static const unsigned resident = residentBlocks(castRays<RayKind>);
  const auto blocks = static_cast<unsigned>(std::min<long long>((rays + 31) / 32, resident));
  castRays<RayKind><<<blocks, kCastThreads, RayKind::Colors::sharedBytes(launch), stream>>>(launch);
  emscape::cuda::checkLaunch("castRays");
}

/// @param launch  a CastLaunch, or another for which there is a start()
template <class Sampler, class Colors, bool kMayShade, class Launch>
void startVolume(const Launch& launch, CompositingMode mode, cudaStream_t stream) {
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
