#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/combine_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using scenario::PatternKind;

constexpr int kThreads = 128;
constexpr int kLayers = 4;

/// @tparam kAny  false: for passes that are plain (isPlain()), in fewer registers
template <PatternKind kind, bool kAny>
__global__ void __launch_bounds__(kThreads)
    radarKernel(const __grid_constant__ RadarPass pass, const std::uint16_t* first_valid_k) {
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (column >= pass.dims.x * pass.dims.y) return;
  const int begin = static_cast<int>(blockIdx.y) * kLayers;
  const int end = begin + kLayers < pass.dims.z ? begin + kLayers : pass.dims.z;
  const int first_valid = first_valid_k == nullptr ? 0 : first_valid_k[column];
  for (int k = begin > first_valid ? begin : first_valid; k < end; ++k) {
    addEcho<kind, kAny>(pass, static_cast<std::size_t>(column), k);
  }
}

}  // namespace

void addRadar(const RadarPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const dim3 blocks(static_cast<unsigned>((pass.dims.x * pass.dims.y + kThreads - 1) / kThreads),
                    static_cast<unsigned>((pass.dims.z + kLayers - 1) / kLayers));
  onPattern(pass.beam.pattern, [&](auto kind) {
    const auto kernel = isPlain(pass) ? radarKernel<kind, false> : radarKernel<kind, true>;
    kernel<<<blocks, kThreads, 0, stream>>>(pass, first_valid_k);
  });
  emscape::cuda::checkLaunch("radar");
}

}  // namespace emscape::emfield::cuda
