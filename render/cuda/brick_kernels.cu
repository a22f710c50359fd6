#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"

namespace emscape::render::cuda {
namespace {

__global__ void brickLevels(SkipRule rule, volume::BricksView bricks, float* highest, float* levels,
                            BrickSummary* summary) {
  const long long brick = static_cast<long long>(blockIdx.x) * blockDim.x + threadIdx.x;
  bool skippable = false;
  if (brick < bricks.dims.count()) {
    const volume::ValueRange range = bricks.ranges[brick];
    const BrickLevel level = rule.of(range);
    highest[brick] = level.highest;
    levels[brick] = level.level;
    skippable = level.level < SkipView::kNever;
    // Non-negative floats have the same order as their bits.
    if (!range.empty()) {
      atomicMax(reinterpret_cast<int*>(&summary->highest_f),
                __float_as_int(rule.table.normalized(range.max)));
    }
  }
  const int found = __syncthreads_count(skippable);
  if (threadIdx.x == 0 && found > 0) atomicAdd(&summary->skippable, static_cast<unsigned>(found));
}

}  // namespace

void findLevels(const SkipRule& rule, const volume::BricksView& bricks, float* highest, float* levels,
                BrickSummary* summary, cudaStream_t stream) {
  constexpr long long kThreads = 256;
  const auto blocks = static_cast<unsigned>((bricks.dims.count() + kThreads - 1) / kThreads);
  brickLevels<<<blocks, kThreads, 0, stream>>>(rule, bricks, highest, levels, summary);
  emscape::cuda::checkLaunch("brickLevels");
}

}  // namespace emscape::render::cuda
