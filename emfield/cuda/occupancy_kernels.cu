#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/combine_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using scenario::PatternKind;

constexpr int kThreads = 128;

template <PatternKind kind>
__global__ void __launch_bounds__(kThreads)
    occupancyKernel(const __grid_constant__ OccupancyPass pass, const std::uint16_t* first_valid_k) {
  const int column = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int k = static_cast<int>(blockIdx.y);
  if (column >= pass.dims.x * pass.dims.y) return;
  if (first_valid_k != nullptr && k < first_valid_k[column]) return;
  const std::size_t voxel = static_cast<std::size_t>(k) * pass.dims.x * pass.dims.y + column;
  const float share = occupancyAt<kind>(pass, voxel, static_cast<std::size_t>(column), pass.t_m[k]);
  pass.accumulator[voxel] = withOccupancy(share, pass.accumulator[voxel]);
}

}  // namespace

void addOccupancy(const OccupancyPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const dim3 blocks(static_cast<unsigned>((pass.dims.x * pass.dims.y + kThreads - 1) / kThreads),
                    static_cast<unsigned>(pass.dims.z));
  onPattern(pass.beam.pattern,
            [&](auto kind) { occupancyKernel<kind><<<blocks, kThreads, 0, stream>>>(pass, first_valid_k); });
  emscape::cuda::checkLaunch("occupancy");
}

}  // namespace emscape::emfield::cuda
