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
  const auto rowOf = [row](int at_y) { return static_cast<std::size_t>(at_y) * row; };
  const std::size_t corners[] = {rowOf(y.below) + x.below, rowOf(y.below) + x.after, rowOf(y.after) + x.below,
                                 rowOf(y.after) + x.after};
  const auto mix = [&](float a, float b, float after_a, float after_b) {
    return between(between(a, b, x.weight), between(after_a, after_b, x.weight), y.weight);
  };
  float* const edge_m = task.shadow_edge_m;
  edge_m[c] = mix(edge_m[corners[0]], edge_m[corners[1]], edge_m[corners[2]], edge_m[corners[3]]);
  if (isnan(edge_m[c])) atomicAdd(&task.counts->unknown_columns, 1);
  if (task.codes == nullptr) return;
  const PartColumn a(grid, task.codes, corners[0]), b(grid, task.codes, corners[1]);
  const PartColumn after_a(grid, task.codes, corners[2]), after_b(grid, task.codes, corners[3]);
  ExcessCode* code = task.codes + c;
  for (int k = 0; k < grid.layers; ++k, code += grid.column_count)
    *code = codeBetween(mix(a(k), b(k), after_a(k), after_b(k)));
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
