/// In which order the tiles of a lattice are cast. For .cu files.
#pragma once

#include "base/device_math.h"
#include "render/cuda/cast_block.h"
#include "render/cuda/kernels.h"

namespace emscape::render::cuda {

/// A lattice in tiles of 32 pixels, near to a square of the picture, and these in cells of a coarse grid.
struct TileGrid {
  static constexpr int kAlong = TaskOrder::kAlong;

  Lattice lattice;
  int tile_width;     ///< pixels
  int width, height;  ///< of a cell, in tiles

  __device__ explicit TileGrid(const Lattice& of)
      : lattice(of),
        tile_width(of.step_x > of.step_y ? 4 : 8),
        width(cellSide(of.columns, tile_width)),
        height(cellSide(of.rows, tileHeight())) {}

  __device__ unsigned tilesOfCell() const { return static_cast<unsigned>(width * height); }
  /// @param in_cell  tile, 0..tilesOfCell() - 1; x, y  in the tile. @return false: there is no such pixel
  __device__ bool pixelOf(int cell, int in_cell, int x, int y, Pixel& pixel) const {
    return pixelAt((cell % kAlong * width + in_cell % width) * tile_width + x,
                   (cell / kAlong * height + in_cell / width) * tileHeight() + y, pixel);
  }
  /// In the corner of cells, or at the lattice's edge.
  __device__ Pixel cornerAt(int column, int row) const {
    Pixel pixel;
    pixelAt(min(column * width * tile_width, lattice.columns - 1),
            min(row * height * tileHeight(), lattice.rows - 1), pixel);
    return pixel;
  }

 private:
  __device__ int tileHeight() const { return 32 / tile_width; }
  /// @return false: the lattice has no such pixel
  __device__ bool pixelAt(int column, int row, Pixel& pixel) const {
    pixel = {static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
             static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
    return column < lattice.columns && row < lattice.rows;
  }
  __device__ static int cellSide(int pixels, int tile) {
    return ((pixels + tile - 1) / tile + kAlong - 1) / kAlong;
  }
};

/// What of a cell's tiles an entry of the order stands for.
enum Portion : unsigned { kWhole, kFirstHalf, kSecondHalf, kPortions };

/// Puts a lattice's cells in order by the rays in their corners. Only the threads of a whole block can.
/// @param kMayHalve  whether rays can be cast in halves
template <bool kMayHalve>
class OrderFinder {
 public:
  /// @param order  in shared memory
  __device__ OrderFinder(const CastLaunch& launch, const TileGrid& grid, TaskOrder& order)
      : launch_(launch), grid_(grid), order_(order) {}

  /// Each block finds the order for itself: a counting sort that comes to the same whatever the order in
  /// which warps run. They count the entries of each class, and an entry's place is that of its class, of its
  /// round in it, and of its lane in that. What was begun to be copied to shared memory is there after it.
  __device__ void find() {
    __shared__ float corners[kCorners];
    __shared__ unsigned longest, sum;  // of cells' rays, in 1/16 voxels: the same in every block
    __shared__ unsigned short counts[kClasses][kRounds];
    __shared__ unsigned short of_class[kClasses];
    const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
    for (unsigned n = threadIdx.x; n < kClasses * kRounds; n += kCastThreads) (&counts[0][0])[n] = 0;
    if (threadIdx.x == 0) longest = sum = 0;
    for (int n = static_cast<int>(threadIdx.x); n < kCorners; n += kCastThreads)
      corners[n] = lengthAt(grid_.cornerAt(n % (kAlong + 1), n / (kAlong + 1)));
    __syncthreads();

    unsigned lengths[kCellsOfThread];
    unsigned longest_of_warp = 0, sum_of_warp = 0;
    EMSCAPE_UNROLL
    for (unsigned n = 0; n < kCellsOfThread; ++n) {
      const unsigned cell = cellOfThread(n);
      lengths[n] = cell < kCells ? longestOf(corners + cell / kAlong * (kAlong + 1) + cell % kAlong) : 0;
      longest_of_warp = max(longest_of_warp, lengths[n]);
      sum_of_warp += lengths[n];
    }
    longest_of_warp = maxOfWarp(longest_of_warp);
    sum_of_warp = sumOfWarp(sum_of_warp);
    if (lane == 0) {
      atomicMax(&longest, longest_of_warp);
      atomicAdd(&sum, sum_of_warp);
    }
    __syncthreads();

    const unsigned most = mostOfTask(sum);
    const unsigned largest = longest > most ? max(longest / 2, most) : max(longest, 1U);
    const unsigned before = (1U << lane) - 1;
    unsigned short classes[kCellsOfThread], ranks[kCellsOfThread];
    EMSCAPE_UNROLL
    for (unsigned n = 0; n < kCellsOfThread; ++n) {
      const unsigned cell = cellOfThread(n);
      const bool halves = lengths[n] > most;
      const unsigned work = halves ? lengths[n] / 2 : lengths[n];
      constexpr float kSteps = kClasses - 1;
      const float step = ceilf(quotient(kSteps * static_cast<float>(work), static_cast<float>(largest)));
      classes[n] = static_cast<unsigned short>(kSteps - fminf(step, kSteps));
      const unsigned same = __match_any_sync(~0U, cell < kCells ? classes[n] : kClasses);
      const unsigned same_halved = same & __ballot_sync(~0U, halves);
      ranks[n] = static_cast<unsigned short>(__popc(same & before) + __popc(same_halved & before));
      if (cell < kCells && (same & before) == 0) {
        counts[classes[n]][cell / 32] = static_cast<unsigned short>(__popc(same) + __popc(same_halved));
      }
    }
    __syncthreads();
    for (unsigned c = warp; c < kClasses; c += kCastWarps) {
      unsigned short* const of_lane = counts[c] + lane * kRoundsOfLane;
      unsigned count = 0;
      for (unsigned n = 0; n < kRoundsOfLane; ++n) count += of_lane[n];
      const unsigned end = sumUpTo(count, lane);
      unsigned first = end - count;
      for (unsigned n = 0; n < kRoundsOfLane; ++n) {
        const unsigned here = of_lane[n];
        of_lane[n] = static_cast<unsigned short>(first);
        first += here;
      }
      if (lane == 31) of_class[c] = static_cast<unsigned short>(end);
    }
    __syncthreads();
    const unsigned end_of_class = sumUpTo(of_class[lane], lane);
    const unsigned first_of_class = end_of_class - of_class[lane];
    if (warp == 0 && lane == kClasses - 1) {
      order_.shown = first_of_class * grid_.tilesOfCell();
      order_.all = end_of_class * grid_.tilesOfCell();
      order_.carriers = max(order_.shown / 2, gridDim.x * kCastWarps);
      order_.carried = (order_.all - order_.shown + order_.carriers - 1) / order_.carriers;
    }
    EMSCAPE_UNROLL
    for (unsigned n = 0; n < kCellsOfThread; ++n) {
      const unsigned cell = cellOfThread(n);
      const unsigned first = __shfl_sync(~0U, first_of_class, static_cast<int>(classes[n]));
      if (cell >= kCells) continue;
      const bool halves = lengths[n] > most;
      unsigned short* const entry = order_.entries + first + counts[classes[n]][cell / 32] + ranks[n];
      entry[0] = static_cast<unsigned short>(cell * kPortions + (halves ? kFirstHalf : kWhole));
      if (halves) entry[1] = static_cast<unsigned short>(cell * kPortions + kSecondHalf);
    }
    __syncthreads();
  }

 private:
  static constexpr int kAlong = TaskOrder::kAlong;
  static constexpr int kCorners = (kAlong + 1) * (kAlong + 1);
  static constexpr unsigned kCells = TaskOrder::kCells;
  static constexpr unsigned kCellsOfThread = (kCells + kCastThreads - 1) / kCastThreads;
  static constexpr unsigned kRoundsOfLane = (kCells + 32 * 32 - 1) / (32 * 32);  ///< of 32 cells each
  static constexpr unsigned kRounds = 32 * kRoundsOfLane;
  static constexpr unsigned kClasses = 32;  ///< of work: the first is the most, the last is none
  static_assert(kCells * kPortions < 1 << 16, "an entry has 16 bits");

  __device__ static unsigned cellOfThread(unsigned n) { return n * kCastThreads + threadIdx.x; }
  /// Of the rays in a cell's corners, in 1/16 voxels. @param corner  its first
  __device__ static unsigned longestOf(const float* corner) {
    constexpr float kMost = 1e6F;  // sums over cells stay within 32 bits
    const float voxels = fmaxf(fmaxf(corner[0], corner[1]), fmaxf(corner[kAlong + 1], corner[kAlong + 2]));
    return static_cast<unsigned>(ceilf(fminf(16 * voxels, kMost)));
  }
  /// The longest rays that are not halved, of a length that a warp casts in a good part of the launch's time:
  /// a larger one where bricks are skipped, as halves of a ray that lie in one warp skip different ones.
  /// @param sum  of the lengths of all cells
  __device__ unsigned mostOfTask(unsigned sum) const {
    const float part_of_time = launch_.task.skip.levels != nullptr ? 0.5F : 0.3F;
    const float tiles_of_warp =
        quotient(static_cast<float>(grid_.tilesOfCell()), static_cast<float>(gridDim.x * kCastWarps));
    return kMayHalve ? static_cast<unsigned>(part_of_time * tiles_of_warp * static_cast<float>(sum)) : ~0U;
  }
  __device__ static unsigned maxOfWarp(unsigned value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_max_sync(~0U, value);
#else
    for (unsigned step = 16; step > 0; step /= 2) value = max(value, __shfl_xor_sync(~0U, value, step));
    return value;
#endif
  }
  __device__ static unsigned sumOfWarp(unsigned value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_add_sync(~0U, value);
#else
    for (unsigned step = 16; step > 0; step /= 2) value += __shfl_xor_sync(~0U, value, step);
    return value;
#endif
  }
  /// Of the values of the lanes up to this one, it included.
  __device__ static unsigned sumUpTo(unsigned value, unsigned lane) {
    for (unsigned step = 1; step < 32; step *= 2) {
      const unsigned before = __shfl_up_sync(~0U, value, step);
      if (lane >= step) value += before;
    }
    return value;
  }
  /// Of a ray in the volume, in voxels, about.
  __device__ float lengthAt(const Pixel& pixel) const {
    const RaycastTask& task = launch_.task;
    const RayOf<float> ray = task.camera.rayThrough<float>(pixel.x, pixel.y);
    const auto inside = clip(ray, vecCast<float>(task.volume.lower()), vecCast<float>(task.volume.upper()));
    const float square = dot(ray.direction, ray.direction);
    const float voxels = square * rsqrtf(square);
    const float end = fminf(inside.end * voxels, boundsOf(launch_, pixel).end);
    return fmaxf(end - inside.begin * voxels, 0.0F);
  }

  const CastLaunch& launch_;
  const TileGrid& grid_;
  TaskOrder& order_;
};

}  // namespace emscape::render::cuda
