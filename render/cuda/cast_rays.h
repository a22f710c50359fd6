/// Rays as kernels cast them, whatever they sample. For .cu files.
#pragma once

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "render/cuda/kernels.h"
#include "render/cuda/pixel_tile.h"

namespace emscape::render::cuda {

/// Samples fetched at a time: with few rays, and at the end of a launch, too few threads are left to hide the
/// wait for one. More registers a thread mean fewer threads.
template <class Compositor>
constexpr int kBatch = Compositor::kEndsItself ? 8 : 4;

/// Threads of a block, one block a multiprocessor. Warps take pixels independently of each other.
constexpr int kCastThreads = 768;

/// Where the ray of a pixel ends at the ground.
__device__ inline double limitOf(const CastLaunch& launch, const Pixel& pixel) {
  return launch.limits != nullptr ? launch.limits[pixelIndex(launch.task.camera.size, pixel.x, pixel.y)]
                                  : 1e300;
}

/// The table where it lies.
class GlobalColors {
 public:
  static unsigned sharedBytes(const CastLaunch& /*launch*/) { return 0; }
  __device__ explicit GlobalColors(const CastLaunch& launch) : samples_(launch.task.transfer.samples) {}
  EMSCAPE_HD const Rgba& at(int index) const { return samples_[index]; }

 private:
  const Rgba* samples_;
};

template <class RayCompositor, class Sampler, class SampleColors, bool kMayShade>
struct VolumeRay {
  using Compositor = RayCompositor;
  using Colors = SampleColors;
  static constexpr int kParts = kMayShade ? 1 : Compositor::kParts;
  static constexpr int kFetched = kMayShade ? 1 : kBatch<Compositor>;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& colors, int x, int y, double limit) {
    return launch.task.castVolume<Compositor, Sampler, kMayShade, kFetched>(x, y, limit, colors,
                                                                            *launch.volume_highest_f);
  }
  __device__ static Compositor begin(const CastLaunch& launch) {
    return {launch.task.opaque_enough, launch.task.mida_gamma, *launch.volume_highest_f};
  }
  __device__ static bool castHalf(const CastLaunch& launch, const RayPieces& pieces, int half,
                                  const Colors& colors, Compositor& compositor) {
    return launch.task.castHalf<Compositor, Sampler, kMayShade, kFetched>(pieces, half, colors, compositor);
  }
  __device__ static bool castPart(const CastLaunch& launch, const RayPieces& pieces, int part,
                                  const Colors& colors, Compositor& compositor) {
    return launch.task.castPart<Compositor, Sampler, kMayShade, kFetched>(pieces, part, colors, compositor);
  }
};
template <class Sampler>
struct SurfaceRay {
  using Colors = GlobalColors;
  static constexpr int kParts = 1;
  __device__ static Rgba cast(const CastLaunch& launch, const Colors& /*colors*/, int x, int y,
                              double limit) {
    return launch.task.castSurface<Sampler>(x, y, limit);
  }
};

/// Pixels of a launch in portions for a warp: rectangles of a lattice, pieces of a list.
/// @param kWidth, kHeight  of a rectangle; their product is the size of a piece
template <int kWidth, int kHeight>
class WarpTiles {
 public:
  static constexpr unsigned kPixels = kWidth * kHeight;

  __device__ explicit WarpTiles(const PixelSet& pixels) : pixels_(pixels) {}

  __device__ bool isList() const { return pixels_.list != nullptr; }
  /// Of a lattice.
  __device__ int columns() const { return (pixels_.lattice.columns + kWidth - 1) / kWidth; }
  __device__ int rows() const { return (pixels_.lattice.rows + kHeight - 1) / kHeight; }
  /// Of a list.
  __device__ unsigned pieces() const { return (listEnd() - pixels_.first + kPixels - 1) / kPixels; }

  /// @param n  of the tile's pixels, 0..kPixels - 1. @return false: there is none
  __device__ bool pixelOfPiece(unsigned piece, unsigned n, Pixel& pixel) const {
    const unsigned place = pixels_.first + piece * kPixels + n;
    if (place >= listEnd()) return false;
    pixel = pixels_.list[place];
    return true;
  }
  __device__ bool pixelOfTile(int tile_column, int tile_row, int x, int y, Pixel& pixel) const {
    const Lattice& lattice = pixels_.lattice;
    const int column = tile_column * kWidth + x;
    const int row = tile_row * kHeight + y;
    if (column >= lattice.columns || row >= lattice.rows) return false;
    pixel = {static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
             static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
    return true;
  }

 private:
  __device__ unsigned listEnd() const {
    return pixels_.length != nullptr && *pixels_.length < pixels_.end ? *pixels_.length : pixels_.end;
  }

  const PixelSet& pixels_;
};

/// What a warp is to cast, for one of its threads.
struct WarpTask {
  Pixel pixel;
  bool has_pixel = false;
  bool in_halves = false;  ///< of the whole warp: each ray by two threads, 16 apart
};

/// Which pixels a warp casts, in which order. Those of a lattice with the longest rays come first, so that a
/// launch ends with short ones and no warp is left with a long one; rays so long that a warp would need a
/// good part of the launch's time are cast in halves. Cells of a coarse grid over the lattice are put in
/// order by the ray in their middle; each block finds the same order for itself.
/// @param kMayHalve  whether rays can be cast in halves
template <bool kMayHalve>
class WarpTasks {
 public:
  /// All threads of a block call it.
  __device__ explicit WarpTasks(const CastLaunch& launch)
      : tiles_(launch.pixels),
        width_((tiles_.columns() + kAlong - 1) / kAlong),
        height_((tiles_.rows() + kAlong - 1) / kAlong) {
    if (!tiles_.isList()) sort(launch);
  }

  /// How many numbers there are. The first ones stand for half a tile each, then they stand for one, and the
  /// last ones, which show nothing, for several: to hand out a number takes its time.
  __device__ unsigned count() const {
    if (tiles_.isList()) return tiles_.pieces();
    const Tiles& tiles = found();
    return tiles.halved + tiles.shown + (tiles.all - tiles.shown + kEmptyTiles - 1) / kEmptyTiles;
  }
  /// Tasks of a number.
  __device__ unsigned tasksOf(unsigned number) const {
    return tiles_.isList() || number < found().halved + found().shown ? 1 : kEmptyTiles;
  }
  /// @param n  0..tasksOf(number) - 1
  __device__ WarpTask of(unsigned number, unsigned n, unsigned lane) const {
    WarpTask task;
    if (tiles_.isList()) {
      task.has_pixel = tiles_.pixelOfPiece(number, lane, task.pixel);
      return task;
    }
    const Tiles& tiles = found();
    task.in_halves = number < 2 * tiles.halved;
    unsigned tile = task.in_halves ? number / 2 : number - tiles.halved;
    if (tile >= tiles.shown) tile = tiles.shown + (tile - tiles.shown) * kEmptyTiles + n;
    if (tile >= tiles.all) return task;
    const int in_cell = static_cast<int>(tile % tilesOfCell());
    const int cell = order()[tile / tilesOfCell()];
    // Threads that follow each other sample close together: the texture unit takes four of them at once.
    const unsigned x = task.in_halves ? number % 2 * 4 + lane % 4 : lane % 8;
    const unsigned y = task.in_halves ? lane % 16 / 4 : lane / 8;
    task.has_pixel = tiles_.pixelOfTile(cell % kAlong * width_ + in_cell % width_,
                                        cell / kAlong * height_ + in_cell / width_, static_cast<int>(x),
                                        static_cast<int>(y), task.pixel);
    return task;
  }

 private:
  static constexpr unsigned kEmptyTiles = 4;  ///< of a number
  static constexpr int kAlong = 32;           ///< cells
  static constexpr unsigned kCells = kAlong * kAlong;
  static constexpr unsigned kClasses = 32;          ///< of length
  static constexpr unsigned kRounds = kCells / 32;  ///< of a warp
  static constexpr unsigned kWarps = kCastThreads / 32;
  static_assert(kRounds == 32 && kClasses == 32, "lanes stand for them");

  __device__ static unsigned short* order() {
    __shared__ unsigned short cells[kCells];
    return cells;
  }
  /// How many of the first tiles are cast in halves, and how many show anything, to all appearances.
  struct Tiles {
    unsigned halved, shown, all;
  };
  __device__ static Tiles& found() {
    __shared__ Tiles tiles;
    return tiles;
  }
  __device__ unsigned tilesOfCell() const { return static_cast<unsigned>(width_ * height_); }

  /// A counting sort that comes to the same whatever the order in which warps run: they count their cells of
  /// each class, and a cell's place is that of its class, of its round in it, and of its lane in that.
  __device__ void sort(const CastLaunch& launch) {
    __shared__ unsigned short counts[kClasses][kRounds];
    __shared__ unsigned short first[kClasses];
    __shared__ unsigned char classes[kCells], ranks[kCells];
    const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
    for (unsigned n = threadIdx.x; n < kClasses * kRounds; n += kCastThreads) (&counts[0][0])[n] = 0;
    __syncthreads();
    const Vec3f box = vecCast<float>(launch.task.volume.upper() - launch.task.volume.lower());
    const float per_class = (kClasses - 1) / (length(box) + 1.0F);
#pragma unroll 1
    for (unsigned round = warp; round < kRounds; round += kWarps) {
      const unsigned cell = round * 32 + lane;
      // The first class is that of the longest, the last one has none.
      const float length = lengthIn(launch, cell);
      const unsigned its = kClasses - 1 - min(kClasses - 1, static_cast<unsigned>(ceilf(length * per_class)));
      const unsigned same = __match_any_sync(~0U, its);
      const unsigned rank = __popc(same & ((1U << lane) - 1));
      if (rank == 0) counts[its][round] = static_cast<unsigned short>(__popc(same));
      classes[cell] = static_cast<unsigned char>(its);
      ranks[cell] = static_cast<unsigned char>(rank);
    }
    __syncthreads();
    for (unsigned c = warp; c < kClasses; c += kWarps) {
      const unsigned count = counts[c][lane];
      const unsigned end = sumUpTo(count, lane);
      counts[c][lane] = static_cast<unsigned short>(end - count);
      if (lane == 31) first[c] = static_cast<unsigned short>(end);
    }
    __syncthreads();
    if (warp == 0) {
      const unsigned count = first[lane];
      const unsigned end = sumUpTo(count, lane);
      first[lane] = static_cast<unsigned short>(end - count);
      const unsigned length = kClasses - 1 - lane;
      const unsigned all = __shfl_sync(~0U, sumUpTo(count * length, lane), 31);
      const unsigned long_classes = __popc(__ballot_sync(~0U, kMayHalve && isLong(length, all)));
      const unsigned halved = __shfl_sync(~0U, end, static_cast<int>(long_classes) - 1);
      if (length == 0) {
        found() = {(long_classes > 0 ? halved : 0) * tilesOfCell(), (end - count) * tilesOfCell(),
                   kCells * tilesOfCell()};
      }
    }
    __syncthreads();
    for (unsigned cell = threadIdx.x; cell < kCells; cell += kCastThreads) {
      order()[first[classes[cell]] + counts[classes[cell]][cell / 32] + ranks[cell]] =
          static_cast<unsigned short>(cell);
    }
    __syncthreads();
  }

  /// Whether rays of a length are to be halved. @param all  the lengths of all cells' rays together
  __device__ bool isLong(unsigned length, unsigned all) const {
    constexpr float kMostOfTime = 0.7F;
    const float tiles_of_warp = static_cast<float>(width_ * height_) / static_cast<float>(gridDim.x * kWarps);
    return static_cast<float>(length) > kMostOfTime * static_cast<float>(all) * tiles_of_warp;
  }
  /// Of the values of the lanes up to this one, it included.
  __device__ static unsigned sumUpTo(unsigned value, unsigned lane) {
    for (unsigned step = 1; step < 32; step *= 2) {
      const unsigned before = __shfl_up_sync(~0U, value, step);
      if (lane >= step) value += before;
    }
    return value;
  }
  /// Of the longest of a few rays, in voxels, about.
  __device__ float lengthIn(const CastLaunch& launch, unsigned cell) const {
    const int first_column = static_cast<int>(cell) % kAlong * width_;
    const int first_row = static_cast<int>(cell) / kAlong * height_;
    float longest = 0;
#pragma unroll 1
    for (int n = 0; n < 5; ++n) {  // in the corners and in the middle
      const int column = first_column + (n == 4 ? width_ / 2 : n % 2 * (width_ - 1));
      const int row = first_row + (n == 4 ? height_ / 2 : n / 2 * (height_ - 1));
      Pixel pixel;
      if (tiles_.pixelOfTile(column, row, n == 4 ? 0 : n % 2 * 7, n == 4 ? 0 : n / 2 * 3, pixel)) {
        longest = fmaxf(longest, lengthOf(launch, pixel));
      }
    }
    return longest;
  }
  __device__ static float lengthOf(const CastLaunch& launch, const Pixel& pixel) {
    const RaycastTask& task = launch.task;
    const RayOf<float> ray = task.camera.rayThrough<float>(pixel.x, pixel.y);
    const auto inside = clip(ray, vecCast<float>(task.volume.lower()), vecCast<float>(task.volume.upper()));
    const float voxels = length(ray.direction);
    const float end = fminf(inside.end * voxels, static_cast<float>(limitOf(launch, pixel)));
    return fmaxf(end - inside.begin * voxels, 0.0F);
  }

  const WarpTiles<8, 4> tiles_;
  const int width_, height_;  ///< of a cell, in tiles
};

/// Portions of a launch, given to warps as they ask. All of them ask until there is none left.
class TileQueue {
 public:
  __device__ TileQueue(unsigned* next, unsigned tiles) : next_(next), tiles_(tiles) {}

  /// @return false: none is left
  __device__ bool take(unsigned lane, unsigned& tile) const {
    if (lane == 0) {
      tile = atomicAdd(next_, 1U);
      // The last one to ask leaves the counter as it found it.
      if (tile == tiles_ + gridDim.x * (blockDim.x / 32) - 1) *next_ = 0;
    }
    tile = __shfl_sync(~0U, tile, 0);
    return tile < tiles_;
  }

 private:
  unsigned* next_;
  unsigned tiles_;
};

/// What another thread of the warp holds. All threads call it.
template <class Value>
__device__ Value fromLane(const Value& value, unsigned lane) {
  constexpr unsigned kWords = sizeof(Value) / sizeof(unsigned);
  static_assert(kWords * sizeof(unsigned) == sizeof(Value) && std::is_trivially_copyable_v<Value>, "words");
  unsigned words[kWords];
  memcpy(words, &value, sizeof value);
  for (unsigned& word : words) word = __shfl_sync(~0U, word, static_cast<int>(lane));
  Value other = value;
  memcpy(&other, words, sizeof other);
  return other;
}

/// All threads of a warp call it.
template <class RayKind>
__device__ void castTask(const CastLaunch& launch, const typename RayKind::Colors& colors,
                         const WarpTask& task, unsigned lane) {
  const Pixel pixel = task.pixel;
  float4& target = launch.layer.at(pixel.x, pixel.y);
  if constexpr (RayKind::kParts == 1) {
    if (!task.has_pixel) return;
    target = toFloat4(RayKind::cast(launch, colors, pixel.x, pixel.y, limitOf(launch, pixel)));
  } else {
    const RayPieces pieces =
        launch.task.piecesOf(pixel.x, pixel.y, task.has_pixel ? limitOf(launch, pixel) : 0.0);
    typename RayKind::Compositor whole = RayKind::begin(launch);
    bool done = pieces.count == 0;
    // Every sample is taken in one place: kernels begin with waiting for their instructions.
    int half = task.in_halves && lane >= 16 ? 1 : 0;
    int end = task.in_halves ? half + 1 : kRayHalves;
    for (bool again = false;; again = true) {
      for (; half < end && !done; ++half) {
        auto next = whole.behind();
        done = RayKind::castHalf(launch, pieces, half, colors, next);
        whole.join(next);
      }
      if (!task.in_halves || again) break;
      auto joined = whole;
      joined.join(fromLane(whole, lane % 16 + 16));
      if (lane >= 16) return;
      if (done) break;
      if (!joined.nearlyDone()) {
        whole = joined;
        break;
      }
      end = kRayHalves;  // the other half once more, now that it is known what lies before
    }
    if (task.has_pixel) target = toFloat4(whole.result(launch.task.transfer));
  }
}

/// A thread a ray, or two where a ray is long.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads) castRays(const __grid_constant__ CastLaunch launch) {
  const typename RayKind::Colors colors(launch);
  const WarpTasks<(RayKind::kParts > 1)> tasks(launch);
  const TileQueue queue(launch.next_tile, tasks.count());
  const unsigned lane = threadIdx.x % 32;
  unsigned number = 0;
  while (queue.take(lane, number)) {
    for (unsigned n = 0; n < tasks.tasksOf(number); ++n) {
      castTask<RayKind>(launch, colors, tasks.of(number, n, lane), lane);
    }
  }
}

/// As many threads a ray as it has parts: for launches of so few rays that most of the GPU would wait for the
/// longest. The pixels are those that castRays() makes.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads) castRaysInParts(const __grid_constant__ CastLaunch launch) {
  using Compositor = typename RayKind::Compositor;
  constexpr unsigned kParts = RayKind::kParts;
  constexpr unsigned kRays = 32 / kParts;
  using Tiles = WarpTiles<2, kRays / 2>;
  __shared__ alignas(Compositor) unsigned char memory[kCastThreads * sizeof(Compositor)];
  Compositor* const composited = reinterpret_cast<Compositor*>(memory) + threadIdx.x / 32 * 32;
  const typename RayKind::Colors colors(launch);
  const Tiles tiles(launch.pixels);
  const unsigned columns = tiles.isList() ? 1 : static_cast<unsigned>(tiles.columns());
  const TileQueue queue(launch.next_tile,
                        tiles.isList() ? tiles.pieces() : columns * static_cast<unsigned>(tiles.rows()));
  const unsigned lane = threadIdx.x % 32;
  const unsigned ray = lane % kRays;
  unsigned number = 0;
  while (queue.take(lane, number)) {
    Pixel pixel;
    const bool has_pixel =
        tiles.isList()
            ? tiles.pixelOfPiece(number, ray, pixel)
            : tiles.pixelOfTile(static_cast<int>(number % columns), static_cast<int>(number / columns),
                                static_cast<int>(ray % 2), static_cast<int>(ray / 2), pixel);
    const RayPieces pieces = launch.task.piecesOf(pixel.x, pixel.y, has_pixel ? limitOf(launch, pixel) : 0.0);
    Compositor own = RayKind::begin(launch);
    if (pieces.count > 0) RayKind::castPart(launch, pieces, static_cast<int>(lane / kRays), colors, own);
    composited[lane] = own;
    __syncwarp();
    if (lane < kRays && has_pixel) {
      Compositor whole = RayKind::begin(launch);
      bool done = false;
      for (int part = 0; part < static_cast<int>(kParts) && !done;) {
        Compositor half = whole.behind();
        for (unsigned n = 0; n < kParts / kRayHalves && !done; ++n, ++part) {
          Compositor joined = half;
          joined.join(composited[static_cast<unsigned>(part) * kRays + ray]);
          if (joined.nearlyDone()) {  // once more, now that it is known what lies before
            Compositor again = half.behind();
            done = RayKind::castPart(launch, pieces, part, colors, again);
            half.join(again);
          } else {
            half = joined;
          }
        }
        whole.join(half);
      }
      launch.layer.at(pixel.x, pixel.y) = toFloat4(whole.result(launch.task.transfer));
    }
    __syncwarp();
  }
}

/// Allows a kernel the shared memory that the largest table takes. @return its blocks that run at a time
inline unsigned residentBlocks(void (*kernel)(CastLaunch), unsigned shared_bytes) {
  constexpr int kMostSharedBytes = (kMostHalfColors + 1) * static_cast<int>(sizeof(HalfColor));
  emscape::cuda::check(
      cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, kMostSharedBytes),
      "cudaFuncSetAttribute");
  int device = 0, multiprocessors = 0, blocks = 0;
  emscape::cuda::check(cudaGetDevice(&device), "cudaGetDevice");
  emscape::cuda::check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
                       "cudaDeviceGetAttribute");
  emscape::cuda::check(
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, kCastThreads, shared_bytes),
      "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
  return static_cast<unsigned>(multiprocessors * std::max(blocks, 1));
}

/// @param warps  that find something to do
inline void launchKernel(void (*kernel)(CastLaunch), const char* name, const CastLaunch& launch,
                         long long warps, unsigned resident, unsigned shared_bytes, cudaStream_t stream) {
  if (warps == 0) return;
  const auto blocks = static_cast<unsigned>(std::min<long long>(warps, resident));
  kernel<<<blocks, kCastThreads, shared_bytes, stream>>>(launch);
  emscape::cuda::checkLaunch(name);
}

template <class RayKind>
void start(const CastLaunch& launch, cudaStream_t stream) {
  const PixelSet& pixels = launch.pixels;
  const long long rays = pixels.list != nullptr ? pixels.end - pixels.first : pixels.lattice.count();
  const unsigned shared_bytes = RayKind::Colors::sharedBytes(launch);
  if constexpr (RayKind::kParts > 1) {
    if (launch.few_rays) {
      static const unsigned resident = residentBlocks(castRaysInParts<RayKind>, shared_bytes);
      constexpr long long kRays = 32 / RayKind::kParts;
      return launchKernel(castRaysInParts<RayKind>, "castRaysInParts", launch, (rays + kRays - 1) / kRays,
                          resident, shared_bytes, stream);
    }
  }
  static const unsigned resident = residentBlocks(castRays<RayKind>, shared_bytes);
  launchKernel(castRays<RayKind>, "castRays", launch, (rays + 31) / 32, resident, shared_bytes, stream);
}

template <class Sampler, class Colors, bool kMayShade>
void startVolume(const CastLaunch& launch, CompositingMode mode, cudaStream_t stream) {
  switch (mode) {
    case CompositingMode::mida:
      return start<VolumeRay<MidaCompositor, Sampler, Colors, kMayShade>>(launch, stream);
    case CompositingMode::mip:
      return start<VolumeRay<MipCompositor, Sampler, GlobalColors, false>>(launch, stream);
    case CompositingMode::iso:
      return start<SurfaceRay<Sampler>>(launch, stream);
    case CompositingMode::dvr:
      break;
  }
  return start<VolumeRay<DvrCompositor, Sampler, Colors, kMayShade>>(launch, stream);
}

}  // namespace emscape::render::cuda
