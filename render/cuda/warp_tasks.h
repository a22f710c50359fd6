/// How the warps of a launch share out its pixels. For .cu files.
#pragma once

#include "render/cuda/kernels.h"
#include "render/cuda/task_order.h"

namespace emscape::render::cuda {

/// Portions of a launch, given to warps as they ask. All of them ask until there is none left.
class TileQueue {
 public:
  /// @param next  0, as it is after the last one has asked
  __device__ TileQueue(unsigned* next, unsigned tiles)
      : next_(next), tiles_(tiles), own_(threadIdx.x / 32 * gridDim.x + blockIdx.x) {}

  /// @return false: none is left
  __device__ bool take(unsigned lane, unsigned& tile) {
    tile = own_;  // the first one needs no asking
    if (asks_) {
      if (lane == 0) {
        const unsigned asked = atomicAdd(next_, 1U);
        if (asked + 1 == tiles_) *next_ = 0;  // as many ask as there are tiles
        tile = asked + gridDim.x * (blockDim.x / 32);
      }
      tile = __shfl_sync(~0U, tile, 0);
    }
    asks_ = true;
    return tile < tiles_;
  }

 private:
  unsigned* next_;
  unsigned tiles_;
  unsigned own_;
  bool asks_ = false;
};

/// What a warp is to cast, for one of its threads.
struct WarpTask {
  Pixel pixel;
  bool has_pixel = false;
  bool in_halves = false;  ///< of the whole warp: each ray by two threads, 16 apart
};

/// Which pixels a warp casts, in which order. Of a lattice the tasks with the longest rays come first, so
/// that a launch ends with short ones and no warp is left with a long one; rays so long that a warp would
/// need a good part of the launch's time are cast in halves.
/// @param kMayHalve  whether rays can be cast in halves
template <bool kMayHalve>
class WarpTasks {
 public:
  /// All threads of a block call it. What they have begun to copy to shared memory is there after it.
  __device__ explicit WarpTasks(const CastLaunch& launch)
      : pixels_(launch.pixels), grid_(launch.pixels.lattice) {
    if (isList()) {
      waitForCopies();
    } else {
      OrderFinder<kMayHalve>(launch, grid_, order()).find();
    }
  }

  /// How many numbers there are, with a tile, or half of one, each. Early ones carry tiles that show nothing
  /// too: their rays are set up while others wait for samples, and no numbers are handed out for them.
  __device__ unsigned count() const {
    if (isList()) return (pixels_.end - pixels_.first + 31) / 32;
    return max(order().shown, order().carriers);
  }
  /// Tasks of a number.
  __device__ unsigned tasksOf(unsigned number) const {
    return isList() || number >= order().carriers ? 1 : 1 + order().carried;
  }
  /// @param n  0..tasksOf(number) - 1
  __device__ WarpTask of(unsigned number, unsigned n, unsigned lane) const {
    WarpTask task;
    if (isList()) {
      const unsigned place = pixels_.first + number * 32 + lane;
      task.has_pixel = place < pixels_.end;
      if (task.has_pixel) task.pixel = pixels_.list[place];
      return task;
    }
    const unsigned tile = n == 0 ? number : order().shown + number * order().carried + n - 1;
    if (n == 0 ? tile >= order().shown : tile >= order().all) return task;
    const unsigned entry = order().entries[tile / grid_.tilesOfCell()];
    const int in_cell = static_cast<int>(tile % grid_.tilesOfCell());
    const int cell = static_cast<int>(entry / kPortions);
    const unsigned portion = entry % kPortions;
    task.in_halves = portion != kWhole;
    // Threads that follow each other sample close together: the texture unit takes four of them at once.
    int x = static_cast<int>(lane) % grid_.tile_width;
    int y = static_cast<int>(lane) / grid_.tile_width;
    if (task.in_halves) {
      x = static_cast<int>(lane % 4);
      y = static_cast<int>(lane % 16 / 4);
      if (portion == kSecondHalf) (grid_.tile_width == 8 ? x : y) += 4;
    }
    task.has_pixel = grid_.pixelOf(cell, in_cell, x, y, task.pixel);
    return task;
  }

 private:
  __device__ bool isList() const { return pixels_.list != nullptr; }
  __device__ static TaskOrder& order() {
    __shared__ TaskOrder order;
    return order;
  }

  const PixelSet& pixels_;
  const TileGrid grid_;
};

}  // namespace emscape::render::cuda
