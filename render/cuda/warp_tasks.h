/// How the warps of a launch share out its pixels. For .cu files.
#pragma once

#include <cuda_pipeline.h>

#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Threads of a block, one block a multiprocessor. Warps take pixels independently of each other.
constexpr int kCastThreads = 768;

/// A barrier after which what the block's threads copy to shared memory, by __pipeline_memcpy_async() too, is
/// there.
__device__ inline void waitForCopies() {
  __pipeline_wait_prior(0);
  __syncthreads();
}

/// Where the ray of a pixel ends at the ground.
__device__ inline double limitOf(const CastLaunch& launch, const Pixel& pixel) {
  return launch.limits != nullptr ? launch.limits[pixelIndex(launch.task.camera.size, pixel.x, pixel.y)]
                                  : 1e300;
}

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
/// need a good part of the launch's time are cast in halves. Cells of a coarse grid over the lattice are put
/// in order by the rays in their corners; each block finds the same order for itself.
/// @param kMayHalve  whether rays can be cast in halves
template <bool kMayHalve>
class WarpTasks {
 public:
  /// All threads of a block call it. What they have begun to copy to shared memory is there after it.
  __device__ explicit WarpTasks(const CastLaunch& launch)
      : pixels_(launch.pixels),
        lattice_(launch.pixels.lattice),
        tile_width_(lattice_.step_x > lattice_.step_y ? 4 : 8),
        width_(cellSide(lattice_.columns, tile_width_)),
        height_(cellSide(lattice_.rows, 32 / tile_width_)) {
    if (isList()) {
      waitForCopies();
    } else {
      sort(launch);
    }
  }

  /// How many numbers there are, with a tile, or half of one, each. Early ones carry tiles that show nothing
  /// too: their rays are set up while others wait for samples, and no numbers are handed out for them.
  __device__ unsigned count() const {
    if (isList()) return (pixels_.end - pixels_.first + 31) / 32;
    return max(found().shown, found().carriers);
  }
  /// Tasks of a number.
  __device__ unsigned tasksOf(unsigned number) const {
    return isList() || number >= found().carriers ? 1 : 1 + found().carried;
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
    const Order& order = found();
    const unsigned tile = n == 0 ? number : order.shown + number * order.carried + n - 1;
    if (n == 0 ? tile >= order.shown : tile >= order.all) return task;
    const unsigned entry = order.entries[tile / tilesOfCell()];
    const int in_cell = static_cast<int>(tile % tilesOfCell());
    const int cell = static_cast<int>(entry / kPortions);
    const unsigned portion = entry % kPortions;
    task.in_halves = portion != kWhole;
    // Threads that follow each other sample close together: the texture unit takes four of them at once.
    int x = static_cast<int>(lane) % tile_width_;
    int y = static_cast<int>(lane) / tile_width_;
    if (task.in_halves) {
      x = static_cast<int>(lane % 4);
      y = static_cast<int>(lane % 16 / 4);
      if (portion == kSecondHalf) (tile_width_ == 8 ? x : y) += 4;
    }
    task.has_pixel =
        pixelAt((cell % kAlong * width_ + in_cell % width_) * tile_width_ + x,
                (cell / kAlong * height_ + in_cell / width_) * (32 / tile_width_) + y, task.pixel);
    return task;
  }

 private:
  static constexpr int kAlong = 26;  ///< cells
  static constexpr int kCorners = (kAlong + 1) * (kAlong + 1);
  static constexpr unsigned kCells = kAlong * kAlong;
  static constexpr unsigned kRounds = (kCells + 31) / 32;  ///< of a warp over the cells
  static constexpr unsigned kWarps = kCastThreads / 32;
  static constexpr unsigned kClasses =
      32;  ///< of length: the first is that of the longest, the last has none
  static_assert(kCorners <= kCastThreads && kRounds <= 32, "a thread a corner, a lane a round");
  /// What of a cell's tiles an entry of the order stands for.
  enum Portion : unsigned { kWhole, kFirstHalf, kSecondHalf, kPortions };

  struct Order {
    unsigned short entries[2 * kCells];  ///< cell * kPortions + portion
    unsigned shown, all;                 ///< tiles, or halves of them, that show something; all of them
    unsigned carriers, carried;          ///< numbers that carry others, and how many each
  };
  __device__ static Order& found() {
    __shared__ Order order;
    return order;
  }

  /// Of a cell, in tiles.
  __device__ static int cellSide(int pixels, int tile) {
    return ((pixels + tile - 1) / tile + kAlong - 1) / kAlong;
  }
  __device__ bool isList() const { return pixels_.list != nullptr; }
  __device__ unsigned tilesOfCell() const { return static_cast<unsigned>(width_ * height_); }
  /// @return false: the lattice has no such pixel
  __device__ bool pixelAt(int column, int row, Pixel& pixel) const {
    pixel = {static_cast<std::uint16_t>(lattice_.first_x + column * lattice_.step_x),
             static_cast<std::uint16_t>(lattice_.first_y + row * lattice_.step_y)};
    return column < lattice_.columns && row < lattice_.rows;
  }

  /// A counting sort that comes to the same whatever the order in which warps run: they count the entries of
  /// each class, and an entry's place is that of its class, of its round in it, and of its lane in that.
  __device__ void sort(const CastLaunch& launch) {
    __shared__ float corners[kCorners];
    __shared__ unsigned longest, sum;  // of cells' rays, in 1/16 voxels: the same in every block
    __shared__ unsigned short counts[kClasses][32];
    __shared__ unsigned short of_class[kClasses];
    const unsigned cell = threadIdx.x, warp = threadIdx.x / 32, lane = threadIdx.x % 32;
    for (unsigned n = threadIdx.x; n < kClasses * 32; n += kCastThreads) (&counts[0][0])[n] = 0;
    if (threadIdx.x == 0) longest = sum = 0;
    if (threadIdx.x < kCorners) corners[threadIdx.x] = lengthAt(launch, static_cast<int>(threadIdx.x));
    waitForCopies();

    unsigned length = 0;
    if (cell < kCells) {
      const float* corner = corners + cell / kAlong * (kAlong + 1) + cell % kAlong;
      const float cells = fmaxf(fmaxf(corner[0], corner[1]), fmaxf(corner[kAlong + 1], corner[kAlong + 2]));
      constexpr float kMost = 4e6F;  // sums stay within 32 bits
      length = static_cast<unsigned>(ceilf(fminf(16 * cells, kMost)));
    }
    unsigned longest_of_warp = length, sum_of_warp = length;
#if __CUDA_ARCH__ >= 800
    longest_of_warp = __reduce_max_sync(~0U, length);
    sum_of_warp = __reduce_add_sync(~0U, length);
#else
    for (unsigned step = 16; step > 0; step /= 2) {
      longest_of_warp = max(longest_of_warp, __shfl_xor_sync(~0U, longest_of_warp, step));
      sum_of_warp += __shfl_xor_sync(~0U, sum_of_warp, step);
    }
#endif
    if (lane == 0) {
      atomicMax(&longest, longest_of_warp);
      atomicAdd(&sum, sum_of_warp);
    }
    __syncthreads();

    const unsigned most = mostOfTask(sum);
    const bool halves = length > most;
    const unsigned work = halves ? length / 2 : length;
    const unsigned largest = longest > most ? max(longest / 2, most) : max(longest, 1U);
    constexpr float kSteps = kClasses - 1;
    const float step = ceilf(quotient(kSteps * static_cast<float>(work), static_cast<float>(largest)));
    const auto its = static_cast<unsigned>(kSteps - fminf(step, kSteps));
    const unsigned same = __match_any_sync(~0U, cell < kCells ? its : kClasses);
    const unsigned same_halved = same & __ballot_sync(~0U, halves);
    const unsigned before = (1U << lane) - 1;
    const unsigned rank = __popc(same & before) + __popc(same_halved & before);
    if (cell < kCells && (same & before) == 0) {
      counts[its][warp] = static_cast<unsigned short>(__popc(same) + __popc(same_halved));
    }
    __syncthreads();
    for (unsigned c = warp; c < kClasses; c += kWarps) {
      const unsigned count = counts[c][lane];
      const unsigned end = sumUpTo(count, lane);
      counts[c][lane] = static_cast<unsigned short>(end - count);
      if (lane == 31) of_class[c] = static_cast<unsigned short>(end);
    }
    __syncthreads();
    Order& order = found();
    const unsigned end_of_class = sumUpTo(of_class[lane], lane);
    const unsigned first_of_class = end_of_class - of_class[lane];
    if (warp == 0 && lane == kClasses - 1) {
      order.shown = first_of_class * tilesOfCell();
      order.all = end_of_class * tilesOfCell();
      order.carriers = max(order.shown / 2, gridDim.x * kWarps);
      order.carried = (order.all - order.shown + order.carriers - 1) / order.carriers;
    }
    const unsigned first = __shfl_sync(~0U, first_of_class, static_cast<int>(its));
    if (cell < kCells) {
      unsigned short* entry = order.entries + first + counts[its][warp] + rank;
      entry[0] = static_cast<unsigned short>(cell * kPortions + (halves ? kFirstHalf : kWhole));
      if (halves) entry[1] = static_cast<unsigned short>(cell * kPortions + kSecondHalf);
    }
    __syncthreads();
  }

  /// The longest rays that are not halved, of a length that a warp casts in a good part of the launch's time.
  /// @param sum  of the lengths of all cells
  __device__ unsigned mostOfTask(unsigned sum) const {
    constexpr float kPartOfTime = 0.5F;
    const float tiles_of_warp =
        quotient(static_cast<float>(tilesOfCell()), static_cast<float>(gridDim.x * kWarps));
    return kMayHalve ? static_cast<unsigned>(kPartOfTime * tiles_of_warp * static_cast<float>(sum)) : ~0U;
  }
  /// Of the values of the lanes up to this one, it included.
  __device__ static unsigned sumUpTo(unsigned value, unsigned lane) {
    for (unsigned step = 1; step < 32; step *= 2) {
      const unsigned before = __shfl_up_sync(~0U, value, step);
      if (lane >= step) value += before;
    }
    return value;
  }
  /// Of the ray in a corner of cells, in voxels, about.
  __device__ float lengthAt(const CastLaunch& launch, int corner) const {
    Pixel pixel;
    pixelAt(min(corner % (kAlong + 1) * width_ * tile_width_, lattice_.columns - 1),
            min(corner / (kAlong + 1) * height_ * (32 / tile_width_), lattice_.rows - 1), pixel);
    const RaycastTask& task = launch.task;
    const RayOf<float> ray = task.camera.rayThrough<float>(pixel.x, pixel.y);
    const auto inside = clip(ray, vecCast<float>(task.volume.lower()), vecCast<float>(task.volume.upper()));
    const float square = dot(ray.direction, ray.direction);
    const float voxels = square * rsqrtf(square);
    const float end = fminf(inside.end * voxels, static_cast<float>(limitOf(launch, pixel)));
    return fmaxf(end - inside.begin * voxels, 0.0F);
  }

  const PixelSet& pixels_;
  const Lattice lattice_;
  const int tile_width_;      ///< pixels; a tile has 32, and is near to a square of the picture
  const int width_, height_;  ///< of a cell, in tiles
};

}  // namespace emscape::render::cuda
