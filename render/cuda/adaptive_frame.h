/// A frame of the pattern `adaptive` in one kernel: the lattice, then pass after pass what cannot be
/// predicted from the pixels known by then. For .cu files.
///
/// Each block looks at tiles from all over the picture and casts those of their pixels that need it, so that
/// blocks have alike much to do without asking each other; all of them wait for each other between passes
/// alone.
#pragma once

#include <cooperative_groups.h>

#include <cstring>
#include <type_traits>

#include "render/adaptive_pass.h"
#include "render/cuda/cast_rays.h"

namespace emscape::render::cuda {

/// Threads a ray of the lattice, whose rays are many: as few as fill the GPU, since neighbouring rays share
/// what the texture unit reads, parts of a ray do not. The passes' rays are few: a thread a part.
/// Either 2 or as many as a ray has parts.
constexpr unsigned kLatticeThreads = 2;

/// The tiles of a grid of pixels that a block looks at, and the place of each of its threads in them.
class BlockTiles {
 public:
  /// @param first  of the block's pixels that the first thread is to look at
  __device__ BlockTiles(int columns, int rows, unsigned width_log2, unsigned height_log2, unsigned first) {
    log2_ = width_log2 + height_log2;
    tile_columns_ = ((static_cast<unsigned>(columns) - 1) >> width_log2) + 1;
    tiles_ = tile_columns_ * (((static_cast<unsigned>(rows) - 1) >> height_log2) + 1);
    per_tile_columns_ = 1.0F / static_cast<float>(tile_columns_);
    width_log2_ = width_log2;
    height_log2_ = height_log2;
    const unsigned n = first + threadIdx.x;
    in_x_ = n & ((1U << width_log2) - 1);
    in_y_ = (n >> width_log2) & ((1U << height_log2) - 1);
    // Every block has one tile of each run of so many as there are blocks. Its place in the run moves on by a
    // golden section: whatever the picture's width, its tiles do not fall in line.
    const unsigned shift = gridDim.x * 5 / 13 + 1, runs = kCastThreads >> log2_, run = n >> log2_;
    run_ = run * gridDim.x;
    in_run_ = (blockIdx.x + run * shift) % gridDim.x;
    runs_ = runs * gridDim.x;
    shift_ = runs * shift % gridDim.x;
  }

  /// How many pixels a block looks at, or some more.
  __device__ unsigned pixelsOfBlock() const { return ((tiles_ + gridDim.x - 1) / gridDim.x) << log2_; }
  /// On to the thread's next pixel, kCastThreads further.
  __device__ void moveOn() {
    run_ += runs_;
    in_run_ += shift_;
    if (in_run_ >= gridDim.x) in_run_ -= gridDim.x;
  }
  /// The pixel's place in the grid, or beyond its last column or row.
  /// @return false: there is none
  __device__ bool place(int& column, int& row) const {
    const unsigned tile = run_ + in_run_;
    // A quotient that is at most one off: there are far fewer rows than 2^22.
    auto tile_row = static_cast<unsigned>(static_cast<float>(tile) * per_tile_columns_);
    auto tile_column = static_cast<int>(tile - tile_row * tile_columns_);
    if (tile_column < 0) {
      tile_column += static_cast<int>(tile_columns_);
      --tile_row;
    } else if (tile_column >= static_cast<int>(tile_columns_)) {
      tile_column -= static_cast<int>(tile_columns_);
      ++tile_row;
    }
    column = static_cast<int>((static_cast<unsigned>(tile_column) << width_log2_) + in_x_);
    row = static_cast<int>((tile_row << height_log2_) + in_y_);
    return tile < tiles_;
  }

 private:
  unsigned width_log2_, height_log2_, log2_;  ///< of a tile
  unsigned tile_columns_, tiles_;
  float per_tile_columns_;
  unsigned in_x_, in_y_;   ///< the thread's, of a tile
  unsigned run_, in_run_;  ///< the first tile of a run, and the block's of it
  unsigned runs_, shift_;  ///< how the two change
};

/// The layer as midpoints see it; see predictMidpoint(). Other blocks have written it before a barrier.
struct KnownLayer {
  using Color = Rgba;
  const Layer& layer;
  ImageSize size;

  EMSCAPE_HD Rgba at(int x, int y) const {
    const float4& p = layer.at(x, y);
    return {p.x, p.y, p.z, p.w};
  }
};

/// As predictMidpoint(); where nothing is known, nothing is certain. Apart, as few pixels lie at the edge.
__device__ __noinline__ inline Prediction<Rgba> predictAtEdge(const Layer& layer, Pass pass, int x, int y) {
  Prediction<Rgba> prediction;
  if (!predictMidpoint(KnownLayer{layer, layer.size}, pass, x, y, prediction)) {
    prediction.error_levels = INFINITY;
  }
  return prediction;
}

/// The known pixels in line with a midpoint (x, y): 3 and 1 times (dx, dy) before it, and behind it.
__device__ inline void readLine(const Layer& layer, int x, int y, int dx, int dy, Rgba (&known)[4]) {
  // They are twice (dx, dy) apart: they lie in one plane.
  const float4* pixel = &layer.at(x - 3 * dx, y - 3 * dy);
  const int step = dx + dy * static_cast<int>(layer.columns());
#pragma unroll
  for (int n = 0; n < 4; ++n) known[n] = toRgba(pixel[n * step]);
}

/// @param kPass  of kPasses
template <int kPass>
__device__ Prediction<Rgba> predictPixel(const Layer& layer, int x, int y) {
  constexpr Pass kTaken = kPasses[kPass];
  constexpr int r = kTaken.reach;
  const auto isInside = [](int n, int length) {
    return static_cast<unsigned>(n - 3 * r) < static_cast<unsigned>(length - 6 * r);
  };
  if (layer.size.width <= 6 * r || layer.size.height <= 6 * r || !isInside(x, layer.size.width) ||
      !isInside(y, layer.size.height)) {
    return predictAtEdge(layer, kTaken, x, y);
  }
  constexpr int dy = kTaken.diagonal ? r : 0;
  Rgba p[4], q[4];  // all of them are read before the first is waited for
  readLine(layer, x, y, r, dy, p);
  readLine(layer, x, y, -dy, r, q);
  return predict(predictAlong(p[1], p[2], p[0], p[3]), predictAlong(q[1], q[2], q[0], q[3]));
}

/// What decides which pixels are cast; of an AdaptiveLaunch.
struct Criteria {
  Layer layer;
  const Span* inside;
  float tolerance_levels;
  std::uint8_t* classes;
};

/// Leaves a pixel transparent, or as it is predicted. @param kPass  of kPasses; -1: the lattice
/// @return whether it must be cast instead
template <int kPass>
__device__ bool mustBeCast(const Criteria& frame, int x, int y) {
  const Span inside = frame.inside[y];
  const bool is_inside = inside.contains(x);
  bool must_be_cast = is_inside;
  Rgba color;
  std::uint8_t error_class = 0;
  if constexpr (kPass >= 0) {
    if (is_inside) {
      constexpr auto kTolerance = static_cast<float>(kPasses[kPass].tolerance);
      const Prediction<Rgba> prediction = predictPixel<kPass>(frame.layer, x, y);
      must_be_cast = !(prediction.error_levels <= frame.tolerance_levels * kTolerance);
      if (!must_be_cast) {
        color = prediction.color;
        error_class = errorClassOf(prediction.error_levels);
      }
    }
  }
  if (!must_be_cast) frame.layer.at(x, y) = toFloat4(color);
  frame.classes[pixelIndex(frame.layer.size, x, y)] = error_class;
  return must_be_cast;
}

/// Pixels that a block is to cast, in its shared memory.
struct BlockQueue {
  static constexpr unsigned kMost = 6144;
  Pixel pixels[kMost];
  unsigned length;

  __device__ static BlockQueue& ofBlock() {
    __shared__ BlockQueue queue;
    return queue;
  }

  /// Appends the pixels of those threads of a warp that have one, in their order.
  __device__ void append(bool has_pixel, int x, int y) {
    const unsigned lanes = __ballot_sync(~0U, has_pixel);
    if (lanes == 0) return;
    const unsigned lane = threadIdx.x % 32;
    unsigned first = 0;
    if (lane == 0) first = atomicAdd(&length, static_cast<unsigned>(__popc(lanes)));
    first = __shfl_sync(~0U, first, 0);
    if (has_pixel) {
      pixels[first + static_cast<unsigned>(__popc(lanes & ((1U << lane) - 1)))] = {
          static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
    }
  }
};

/// Looks at the block's pixels from the first one on, as many as its queue holds. Called, not a part of the
/// kernel: what one function needs would take registers from the others.
/// @return how many the block has
template <int kPass>
__device__ __noinline__ unsigned lookAtPixels(Criteria frame, unsigned first) {
  __builtin_assume(__isGlobal(frame.layer.pixels));
  __builtin_assume(__isGlobal(frame.inside));
  __builtin_assume(__isGlobal(frame.classes));
  constexpr bool kIsLattice = kPass < 0;
  constexpr Pass kTaken = kPasses[kIsLattice ? 0 : kPass];
  const ImageSize size = frame.layer.size;
  const auto ofLattice = [](int length) { return (length + kLatticeStep - 1) / kLatticeStep; };
  const int columns = kIsLattice ? ofLattice(size.width) : kTaken.columns(size);
  const int rows = kIsLattice ? ofLattice(size.height) : kTaken.rows(size);
  // Small tiles make blocks alike; where there are many of them, larger ones read pixels less often.
  const bool is_small = kIsLattice || static_cast<long long>(columns) * rows < 768LL * gridDim.x;
  BlockTiles tiles(columns, rows, is_small ? 2 : 3, is_small ? 1 : 2, first);
  BlockQueue& queue = BlockQueue::ofBlock();
  const unsigned pixels = tiles.pixelsOfBlock();
  const unsigned end = min(first + BlockQueue::kMost, pixels);
  for (unsigned n = first + threadIdx.x; n - threadIdx.x % 32 < end; n += kCastThreads) {
    int column = 0, row = 0;
    const bool is_any = n < end && tiles.place(column, row);
    const int y = kIsLattice ? row * kLatticeStep : kTaken.firstY() + row * kTaken.stepY();
    const int x = kIsLattice ? column * kLatticeStep : kTaken.firstX(y) + column * kTaken.stepX();
    queue.append(is_any && x < size.width && y < size.height && mustBeCast<kPass>(frame, x, y), x, y);
    tiles.moveOn();
  }
  return pixels;
}

/// @param pass  of kPasses; -1: the lattice
__device__ inline unsigned lookAtPixels(const AdaptiveLaunch& launch, int pass, unsigned first) {
  const Criteria frame{launch.layer, launch.inside, launch.tolerance_levels, launch.classes};
  static_assert(AdaptiveLaunch::kPassCount == 4, "one case each");
  switch (pass) {
    case 0:
      return lookAtPixels<0>(frame, first);
    case 1:
      return lookAtPixels<1>(frame, first);
    case 2:
      return lookAtPixels<2>(frame, first);
    case 3:
      return lookAtPixels<3>(frame, first);
    default:
      return lookAtPixels<-1>(frame, first);
  }
}

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

/// Casts one ray by several threads, `rays` lanes apart, each of which takes as many of its parts. The pixel
/// is that of RaycastTask::castVolume() for any number of threads. All threads of a warp call it.
/// @param threads  2, or as many as there are parts
/// @return the ray's colour for the first of its threads
template <class RayKind>
__device__ Rgba castByThreads(const CastLaunch& launch, const typename RayKind::Colors& colors,
                              const RayPieces& pieces, unsigned threads) {
  using Compositor = typename RayKind::Compositor;
  constexpr int kParts = RayKind::kParts;
  const unsigned rays = 32 / threads;
  const unsigned lane = threadIdx.x % 32;
  const int parts_of_thread = kParts / static_cast<int>(threads);
  JoinedParts<Compositor> ray(RayKind::begin(launch));
  int part = static_cast<int>(lane / rays) * parts_of_thread;
  int end = part + parts_of_thread;
  bool done = pieces.count == 0;
  // One copy of the sampling loop: instructions that were not run before are waited for.
  for (bool again = false;; again = true) {
    for (; part < end && !done; ++part) {
      Compositor next = ray.behind();
      done = RayKind::castPart(launch, pieces, part, colors, next);
      ray.join(next);
    }
    if (again) break;
    // Only the first of a ray's threads knew what lies before its parts: nothing.
    const Compositor own = ray.whole();
    bool is_sure = true;
#pragma unroll 1
    for (unsigned n = 1; n < threads; ++n) {
      const Compositor cast = fromLane(own, n * rays + lane % rays);
      if (done || !is_sure) continue;
      JoinedParts<Compositor> joined = ray;
      joined.join(cast, parts_of_thread);
      is_sure = !joined.nearlyDone();
      if (is_sure) {
        ray = joined;
      } else {
        part = static_cast<int>(n) * parts_of_thread;
      }
    }
    if (done || is_sure || lane >= rays) break;
    end = kParts;  // the rest is cast again, now that it is known what lies before
  }
  return ray.whole().result(launch.task.transfer);
}

/// All threads of a block call it. @param is_lattice  the rays are many
template <class RayKind>
__device__ void castQueued(const CastLaunch& launch, const typename RayKind::Colors& colors,
                           const BlockQueue& queue, bool is_lattice) {
  const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
  if constexpr (RayKind::kParts == 1) {
    // Rays of a warp wait for each other: as few of them as leave no warp without.
    const unsigned count = queue.length;
    const unsigned rays = min(max((count + kCastWarps - 1) / kCastWarps, 1U), 32U);
    for (unsigned n = warp * rays + lane; n < count; n += kCastWarps * rays) {
      if (lane >= rays) break;
      const Pixel pixel = queue.pixels[n];
      launch.layer.at(pixel.x, pixel.y) =
          toFloat4(RayKind::cast(launch, colors, pixel.x, pixel.y, boundsOf(launch, pixel)));
    }
  } else {
    const unsigned threads = is_lattice ? kLatticeThreads : static_cast<unsigned>(RayKind::kParts);
    const unsigned rays = 32 / threads;
    for (unsigned first = warp * rays; first < queue.length; first += kCastWarps * rays) {
      const unsigned n = first + lane % rays;
      const bool has_pixel = n < queue.length;
      const Pixel pixel = has_pixel ? queue.pixels[n] : Pixel{};
      const RayPieces pieces =
          launch.task.piecesOf(pixel.x, pixel.y, has_pixel ? boundsOf(launch, pixel) : RayBounds{0, 0});
      const Rgba color = castByThreads<RayKind>(launch, colors, pieces, threads);
      if (has_pixel && lane < rays) launch.layer.at(pixel.x, pixel.y) = toFloat4(color);
    }
  }
}

/// As many blocks as run at a time.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads, 1)
    castAdaptiveFrame(const __grid_constant__ AdaptiveLaunch launch) {
  BlockQueue& queue = BlockQueue::ofBlock();
  const typename RayKind::Colors colors(launch);
#pragma unroll 1
  for (int pass = -1; pass < AdaptiveLaunch::kPassCount; ++pass) {
    if (pass >= 0) cooperative_groups::this_grid().sync();
    for (unsigned first = 0, looked_at = ~0U; first < looked_at; first += BlockQueue::kMost) {
      if (threadIdx.x == 0) queue.length = 0;
      __syncthreads();
      looked_at = lookAtPixels(launch, pass, first);
      waitForCopies();  // of the colours, too
      if (threadIdx.x == 0) atomicAdd(launch.rays, queue.length);
      castQueued<RayKind>(launch, colors, queue, pass < 0);
      __syncthreads();
    }
  }
}

template <class RayKind>
void start(const AdaptiveLaunch& launch, cudaStream_t stream) {
  static const unsigned resident = residentBlocks(castAdaptiveFrame<RayKind>);
  void* parameters[] = {const_cast<AdaptiveLaunch*>(&launch)};
  // A failure is reported by checkLaunch(), with the kernel's name.
  static_cast<void>(cudaLaunchCooperativeKernel(castAdaptiveFrame<RayKind>, resident, kCastThreads,
                                                parameters, RayKind::Colors::sharedBytes(launch), stream));
  emscape::cuda::checkLaunch("castAdaptiveFrame");
}

}  // namespace emscape::render::cuda
