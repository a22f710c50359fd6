#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"

namespace emscape::render::cuda {
namespace {

__global__ void brickLevels(SkipRule rule, volume::BricksView bricks, float* highest, float* levels,
                            float* volume_highest_f) {
  const long long brick = static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (brick >= bricks.dims.count()) return;
  const volume::ValueRange range = bricks.ranges[brick];
  const BrickLevel level = rule.of(range);
  highest[brick] = level.highest;
  levels[brick] = level.level;
  // Floats that are not negative are in the order of their bits.
  if (!range.empty()) {
    atomicMax(reinterpret_cast<int*>(volume_highest_f), __float_as_int(rule.table.normalized(range.max)));
  }
}

}  // namespace

void findLevels(const SkipRule& rule, const volume::BricksView& bricks, float* highest, float* levels,
                float* volume_highest_f, cudaStream_t stream) {
  constexpr long long kThreads = 256;
  const auto blocks = static_cast<unsigned>((bricks.dims.count() + kThreads - 1) / kThreads);
  brickLevels<<<blocks, kThreads, 0, stream>>>(rule, bricks, highest, levels, volume_highest_f);
  emscape::cuda::checkLaunch("brickLevels");
}

}  // namespace emscape::render::cuda
