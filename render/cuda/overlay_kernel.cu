#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/picture/bytes_over.h"

namespace emscape::render::cuda {
namespace {

constexpr unsigned kThreads = 256;

/// @param cast, picture  bytes r g b a. @param behind, front  0xAARRGGBB
__global__ void __launch_bounds__(kThreads)
    putTogether(unsigned count, const std::uint32_t* __restrict__ behind,
                const std::uint32_t* __restrict__ cast, const std::uint32_t* __restrict__ front,
                std::uint32_t* __restrict__ picture) {
  const unsigned i = blockIdx.x * kThreads + threadIdx.x;
  if (i >= count) return;
  const std::uint32_t seen = bytesOver(redAndBlueSwapped(cast[i]), behind[i]);
  picture[i] = redAndBlueSwapped(bytesOver(front[i], seen));
}

}  // namespace

void composeOverlay(unsigned count, const std::uint32_t* behind, const uchar4* cast,
                    const std::uint32_t* front, uchar4* picture, cudaStream_t stream) {
  if (count == 0) return;
  putTogether<<<(count + kThreads - 1) / kThreads, kThreads, 0, stream>>>(
      count, behind, reinterpret_cast<const std::uint32_t*>(cast), front,
      reinterpret_cast<std::uint32_t*>(picture));
  emscape::cuda::checkLaunch("putTogether");
}

}  // namespace emscape::render::cuda
