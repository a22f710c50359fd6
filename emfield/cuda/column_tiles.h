/// Assignment of columns to the threads of a kernel, and their reports; for nvcc.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>

#include "emfield/cuda/excess_kernels.h"
#include "emscape/base/error.h"

namespace emscape::emfield::cuda {

constexpr int kColumnThreads = 128;

/// @throws Error (device)
[[noreturn]] inline void throwTooSmall(std::size_t bytes_each, std::size_t bytes) {
  throw Error(ErrorCode::device, "GPU: " + std::to_string(kColumnThreads) + " columns at a time need " +
                                     std::to_string(kColumnThreads * bytes_each) + " bytes, of " +
                                     std::to_string(bytes));
}

/// Called once per column, by one thread at a time.
__device__ inline void markUnknown(const ExcessOutputs& to, int column) {
  if (isnan(to.out.shadow_edge_m[column])) return;
  to.out.markUnknown(static_cast<std::size_t>(column));
  atomicAdd(&to.counts->unknown_columns, 1);
}

__device__ inline void note(const ExcessOutputs& to, int column, unsigned warnings) {
  if ((warnings & propagation::kMissingTerrain) != 0) markUnknown(to, column);
  if ((warnings & ~propagation::kMissingTerrain) != 0)
    atomicOr(&to.counts->warnings, warnings & ~propagation::kMissingTerrain);
}

/// Columns of a block and of each of its warps: square, because they share more data than those of a row.
constexpr int kTileX = 16, kTileY = 8, kWarpX = 8, kWarpY = 4;
static_assert(kTileX * kTileY == kColumnThreads);

/// Tiles of kTileX x kTileY columns: over a grid's rows, of all tasks. Of a part of the columns
/// (ExcessGrid::part, without `known`) those of the part alone.
class Tiles {
 public:
  /// @param row  columns along x
  Tiles(const ExcessGrid& grid, int row, int tasks)
      : step_(grid.part.step), row_(row), rows_(static_cast<int>(grid.column_count) / row) {
    along_x_ = (linesOf(row_) + kTileX - 1) / kTileX;
    along_y_ = (linesOf(rows_) + kTileY - 1) / kTileY;
    count_ = along_x_ * along_y_ * tasks;
  }
  int count() const { return count_; }
  /// Calls f(task, column, thread), each thread for some columns.
  template <class Function>
  __device__ void eachColumn(const Function& f) const {
    const int lane = static_cast<int>(threadIdx.x) % 32, warp = static_cast<int>(threadIdx.x) / 32;
    constexpr int kWarpsX = kTileX / kWarpX;
    const int in_tile_x = warp % kWarpsX * kWarpX + lane % kWarpX;
    const int in_tile_y = warp / kWarpsX * kWarpY + lane / kWarpX;
    const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    for (int tile = static_cast<int>(blockIdx.x); tile < count_; tile += static_cast<int>(gridDim.x)) {
      const int x = tile % along_x_ * kTileX + in_tile_x;
      const int y = tile / along_x_ % along_y_ * kTileY + in_tile_y;
      if (x >= linesOf(row_) || y >= linesOf(rows_)) continue;
      f(tile / (along_x_ * along_y_), min(y * step_, rows_ - 1) * row_ + min(x * step_, row_ - 1), thread);
    }
  }

 private:
  /// Every step-th of some columns and the last one.
  EMSCAPE_HD int linesOf(int columns) const { return (columns - 1 + step_ - 1) / step_ + 1; }

  int step_, row_, rows_, along_x_, along_y_, count_;
};

}  // namespace emscape::emfield::cuda
