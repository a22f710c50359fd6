#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/interpolation_kernels.h"
#include "emfield/excess/interpolate_columns.h"

namespace emscape::emfield::cuda {
namespace {

constexpr int kThreads = 128;

/// A thread for each column, of the part or not.
__global__ void interpolateKernel(const DevicePartTask* tasks, const __grid_constant__ ExcessGrid grid,
                                  int row) {
  const auto c = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (c >= grid.column_count) return;
  const LinesAround x(static_cast<int>(c) % row, row, grid.part.step);
  const LinesAround y(static_cast<int>(c) / row, static_cast<int>(grid.column_count) / row, grid.part.step);
  if (x.is_line && y.is_line) return;
  const DevicePartTask& task = tasks[blockIdx.y];
  const auto mix = [&](const auto& valueAt) {
    const auto inRow = [&](int at_y) {
      const auto begin = static_cast<std::size_t>(at_y) * row;
      return between(valueAt(begin + x.below), valueAt(begin + x.after), x.weight);
    };
    return between(inRow(y.below), inRow(y.after), y.weight);
  };
  const float edge_m = mix([&](std::size_t column) { return task.shadow_edge_m[column]; });
  task.shadow_edge_m[c] = edge_m;
  if (isnan(edge_m)) atomicAdd(&task.counts->unknown_columns, 1);
  if (task.codes == nullptr) return;
  for (int k = 0; k < grid.layers; ++k) {
    task.codes[static_cast<std::size_t>(k) * grid.column_count + c] =
        codeBetween(mix([&](std::size_t column) { return partValue(grid, task.codes, column, k); }));
  }
}

}  // namespace

void interpolateColumns(const DevicePartTask* tasks, int count, const ExcessGrid& grid, int row,
                        cudaStream_t stream) {
  const dim3 blocks(static_cast<unsigned>((grid.column_count + kThreads - 1) / kThreads),
                    static_cast<unsigned>(count));
  interpolateKernel<<<blocks, kThreads, 0, stream>>>(tasks, grid, row);
  emscape::cuda::checkLaunch("interpolateColumns");
}

}  // namespace emscape::emfield::cuda
