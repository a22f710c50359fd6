#include <cuda_fp16.h>

#include "render/cuda/adaptive_frame.h"
#include "render/cuda/cast_rays.h"
#include "render/cuda/texture_samplers.h"

namespace emscape::render::cuda {
namespace {

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
