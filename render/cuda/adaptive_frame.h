/// A frame of the pattern `adaptive` in one kernel: the lattice, then in each pass the pixels that cannot be
/// predicted from those known so far. For .cu files.
///
/// Each block processes tiles distributed over the picture and casts the pixels that cannot be predicted, so
/// that blocks have about the same work without a common queue. They synchronise only between passes.
#pragma once

#include <cooperative_groups.h>

#include <cstring>
#include <type_traits>

#include "render/cuda/cast_rays.h"
#include "render/patterns/adaptive_pass.h"

namespace emscape::render::cuda {

/// Threads per ray of the lattice, which has many rays: as few as fill the GPU, because neighbouring rays
/// share texture cache lines but parts of a ray do not. Passes have few rays: one thread per part. Either 2
/// or as many as a ray has parts.
constexpr unsigned kLatticeThreads = 2;

/// The tiles of a grid of pixels that a block processes: one of each run of as many tiles as there are
/// blocks. Its position in the run advances by the golden section, so that its tiles are not aligned for any
/// width of the picture.
class BlockTiles {
 public:
  /// @param columns, rows  of pixels; width_log2, height_log2  of a tile
  __device__ BlockTiles(int columns, int rows, unsigned width_log2, unsigned height_log2)
      : width_log2_(width_log2), height_log2_(height_log2) {
    columns_ = ((static_cast<unsigned>(columns) - 1) >> width_log2) + 1;
    count_ = columns_ * (((static_cast<unsigned>(rows) - 1) >> height_log2) + 1);
  }

  /// Number of pixels of a block, or a few more.
  __device__ unsigned pixelsOfBlock() const {
    return ((count_ + gridDim.x - 1) / gridDim.x) << (width_log2_ + height_log2_);
  }
  /// Position of pixel n of the block in the grid, or beyond its last column or row. @return false if there
  /// is none
  __device__ bool locate(unsigned n, int& column, int& row) const {
    const unsigned run = n >> (width_log2_ + height_log2_), shift = gridDim.x * 5 / 13 + 1;
    const unsigned tile = run * gridDim.x + (blockIdx.x + run * shift) % gridDim.x;
    const unsigned in_x = n & ((1U << width_log2_) - 1);
    const unsigned in_y = n >> width_log2_ & ((1U << height_log2_) - 1);
    column = static_cast<int>((tile % columns_ << width_log2_) + in_x);
    row = static_cast<int>((tile / columns_ << height_log2_) + in_y);
    return tile < count_;
  }

 private:
  unsigned width_log2_, height_log2_;  ///< of a tile
  unsigned columns_, count_;           ///< of tiles
};

/// The layer for predictMidpoint(). Other blocks wrote it before the last barrier.
struct KnownLayer {
  using Color = Rgba;
  const Layer& layer;
  ImageSize size;

  EMSCAPE_HD Rgba at(int x, int y) const {
    const float4& p = layer.at(x, y);
    return {p.x, p.y, p.z, p.w};
  }
};

/// Criteria that select the pixels of a pass to be cast; from an AdaptiveLaunch.
struct Criteria {
  Layer layer;
  const Span* inside;
  float tolerance_levels;
  bool* is_predicted;
  Pass pass;
  bool is_lattice;  ///< instead of a pass
};

/// Sets a pixel to transparent or to its prediction. @return true if it must be cast instead
__device__ inline bool mustBeCast(const Criteria& frame, int x, int y) {
  const Span inside = frame.inside[y];
  const bool is_inside = inside.contains(x);
  bool must_be_cast = is_inside;
  Rgba color;
  if (is_inside && !frame.is_lattice) {
    Prediction<Rgba> prediction;
    if (predictMidpoint(KnownLayer{frame.layer, frame.layer.size}, frame.pass, x, y, prediction)) {
      must_be_cast = !(prediction.error_levels <= frame.tolerance_levels);
    }
    if (!must_be_cast) color = prediction.color;
  }
  if (!must_be_cast) frame.layer.at(x, y) = toFloat4(color);
  frame.is_predicted[pixelIndex(frame.layer.size, x, y)] = is_inside && !must_be_cast;
  return must_be_cast;
}

/// Pixels to be cast by a block, in its shared memory.
struct BlockQueue {
  static constexpr unsigned kMax = 6144;
  Pixel pixels[kMax];
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

/// Predicts the block's pixels from the first one on, or queues them, as many as fit into the queue. Not
/// inlined, to save registers in the rest of the kernel.
/// @return number of pixels of the block
__device__ __noinline__ inline unsigned classifyPixels(Criteria frame, unsigned first) {
  __builtin_assume(__isGlobal(frame.layer.pixels));
  __builtin_assume(__isGlobal(frame.inside));
  __builtin_assume(__isGlobal(frame.is_predicted));
  const bool is_lattice = frame.is_lattice;
  const Pass pass = frame.pass;
  const ImageSize size = frame.layer.size;
  const auto ofLattice = [](int length) { return (length + kLatticeStep - 1) / kLatticeStep; };
  const int columns = is_lattice ? ofLattice(size.width) : pass.columns(size);
  const int rows = is_lattice ? ofLattice(size.height) : pass.rows(size);
  // Small tiles balance the blocks; where there are many of them, larger ones read pixels less often.
  const bool is_small = is_lattice || static_cast<long long>(columns) * rows < 768LL * gridDim.x;
  const BlockTiles tiles(columns, rows, is_small ? 2 : 3, is_small ? 1 : 2);
  BlockQueue& queue = BlockQueue::ofBlock();
  const unsigned pixels = tiles.pixelsOfBlock();
  const unsigned end = min(first + BlockQueue::kMax, pixels);
  for (unsigned n = first + threadIdx.x; n - threadIdx.x % 32 < end; n += kCastThreads) {
    int column = 0, row = 0;
    const bool is_any = n < end && tiles.locate(n, column, row);
    const int y = is_lattice ? row * kLatticeStep : pass.firstY() + row * pass.stepY();
    const int x = is_lattice ? column * kLatticeStep : pass.firstX(y) + column * pass.stepX();
    queue.append(is_any && x < size.width && y < size.height && mustBeCast(frame, x, y), x, y);
  }
  return pixels;
}

/// @param pass  of AdaptiveLaunch::passes; -1: the lattice
__device__ inline Criteria criteriaOf(const AdaptiveLaunch& launch, int pass) {
  Criteria criteria{launch.layer, launch.inside, launch.tolerance_levels, launch.is_predicted, {}, pass < 0};
  if (pass < 0) return criteria;
  criteria.pass = launch.passes[pass];
  criteria.tolerance_levels *= static_cast<float>(criteria.pass.tolerance);
  return criteria;
}

/// The value of another thread of the warp. All threads of the warp call it.
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

/// Casts one ray with several threads, `rays` lanes apart, each of which casts the same number of its parts.
/// For any number of threads the pixel equals that of RaycastTask::castVolume(). All threads of a warp call
/// it.
/// @param threads  2, or as many as there are parts
/// @return the ray's colour for the first of its threads
template <class RayKind>
__device__ Rgba castByThreads(const CastLaunch& launch, const typename RayKind::Colors& colors,
                              const RaySegments& segments, unsigned threads) {
  using Compositor = typename RayKind::Compositor;
  constexpr int kParts = RayKind::kParts;
  const unsigned rays = 32 / threads;
  const unsigned lane = threadIdx.x % 32;
  const int parts_of_thread = kParts / static_cast<int>(threads);
  JoinedParts<Compositor> ray(RayKind::begin(launch));
  int part = static_cast<int>(lane / rays) * parts_of_thread;
  int end = part + parts_of_thread;
  bool done = segments.count == 0;
  // One copy of the sampling loop: instruction-cache misses dominate the start of the kernel.
  for (bool again = false;; again = true) {
    for (; part < end && !done; ++part) {
      Compositor next = ray.behind();
      done = RayKind::castPart(launch, segments, part, colors, next);
      ray.join(next);
    }
    if (again) break;
    // Only the first of a ray's threads had no parts in front of its own.
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
    end = kParts;  // the rest is cast again, with the known parts in front
  }
  return ray.whole().result(launch.task.transfer);
}

/// All threads of a block call it. @param is_lattice  the rays are many
template <class RayKind>
__device__ void castQueued(const CastLaunch& launch, const typename RayKind::Colors& colors,
                           const BlockQueue& queue, bool is_lattice) {
  const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
  if constexpr (RayKind::kParts == 1) {
    // Rays of a warp wait for each other, so each warp gets as few as possible.
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
      const RaySegments segments =
          launch.task.segmentsOf(pixel.x, pixel.y, has_pixel ? boundsOf(launch, pixel) : RayBounds{0, 0});
      const Rgba color = castByThreads<RayKind>(launch, colors, segments, threads);
      if (has_pixel && lane < rays) launch.layer.at(pixel.x, pixel.y) = toFloat4(color);
    }
  }
}

/// Launched with as many blocks as run at a time.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads, 1)
    castAdaptiveFrame(const __grid_constant__ AdaptiveLaunch launch) {
  BlockQueue& queue = BlockQueue::ofBlock();
  const typename RayKind::Colors colors(launch);
#pragma unroll 1
  for (int pass = -1; pass < AdaptiveLaunch::kPassCount; ++pass) {
    if (pass >= 0) cooperative_groups::this_grid().sync();
    const Criteria criteria = criteriaOf(launch, pass);
    for (unsigned first = 0, looked_at = ~0U; first < looked_at; first += BlockQueue::kMax) {
      if (threadIdx.x == 0) queue.length = 0;
      __syncthreads();
      looked_at = classifyPixels(criteria, first);
      waitForCopies();  // also of the colours
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
