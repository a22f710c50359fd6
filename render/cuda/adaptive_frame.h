/// A frame of the pattern `adaptive` in one kernel: the lattice, then pass after pass what cannot be
/// predicted from the pixels known by then. For .cu files.
///
/// Each block looks at tiles from all over the picture and casts those of their pixels that need it, so that
/// blocks have alike much to do without asking each other; all of them wait for each other between passes
/// alone.
#pragma once

#include <cooperative_groups.h>

#include "render/adaptive_pass.h"
#include "render/cuda/cast_rays.h"

namespace emscape::render::cuda {

/// Threads a ray of the lattice, whose rays are many: as few as fill the GPU, since neighbouring rays share
/// what the texture unit reads, parts of a ray do not. The passes' rays are few: a thread a part.
/// Either 2 or as many as a ray has parts.
constexpr unsigned kLatticeThreads = 2;

/// What a frame looks at between two barriers, as a grid: the pixels of the lattice, or a pass' midpoints.
class AdaptiveStage {
 public:
  /// @param pass  -1: the lattice
  __device__ AdaptiveStage(const AdaptiveLaunch& launch, int pass)
      : pass_(pass < 0 ? nullptr : launch.passes + pass) {
    const ImageSize size = launch.layer.size;
    columns_ = pass_ != nullptr ? pass_->columns(size) : (size.width + kLatticeStep - 1) / kLatticeStep;
    rows_ = pass_ != nullptr ? pass_->rows(size) : (size.height + kLatticeStep - 1) / kLatticeStep;
    // Small tiles make blocks alike; where there are many of them, larger ones read pixels less often.
    const bool are_many = static_cast<long long>(columns_) * rows_ > 1024LL * gridDim.x;
    width_log2_ = are_many ? 3 : 2;
    height_log2_ = are_many ? 2 : 1;
    tile_columns_ = ((columns_ - 1) >> width_log2_) + 1;
    tiles_ = static_cast<unsigned>(tile_columns_) * (((rows_ - 1) >> height_log2_) + 1);
  }

  /// Null: the lattice.
  __device__ const Pass* pass() const { return pass_; }
  /// How many pixels a block looks at, or some more.
  __device__ unsigned pixelsOfBlock() const {
    return ((tiles_ + gridDim.x - 1) / gridDim.x) << (width_log2_ + height_log2_);
  }
  /// @param n  of the block's pixels. @return false: there is none
  __device__ bool pixelOf(unsigned n, ImageSize size, int& x, int& y) const {
    // Every block has one tile of each run of so many as there are blocks. Its place in the run moves on by a
    // golden section: whatever the picture's width, its tiles do not fall in line.
    const unsigned run = n >> (width_log2_ + height_log2_);
    const unsigned tile = run * gridDim.x + (blockIdx.x + run * (gridDim.x * 5 / 13 + 1)) % gridDim.x;
    if (tile >= tiles_) return false;
    const int in_x = static_cast<int>(n & ((1U << width_log2_) - 1));
    const int in_y = static_cast<int>((n >> width_log2_) & ((1U << height_log2_) - 1));
    const int column = (static_cast<int>(tile % tile_columns_) << width_log2_) + in_x;
    const int row = (static_cast<int>(tile / tile_columns_) << height_log2_) + in_y;
    y = pass_ != nullptr ? pass_->firstY() + row * pass_->stepY() : row * kLatticeStep;
    x = pass_ != nullptr ? pass_->firstX(y) + column * pass_->stepX() : column * kLatticeStep;
    return column < columns_ && row < rows_ && x < size.width && y < size.height;
  }

 private:
  const Pass* pass_;
  int columns_, rows_;
  int width_log2_, height_log2_;  ///< of a tile
  unsigned tile_columns_, tiles_;
};

/// The layer as midpoints see it; see predictMidpoint(). Other blocks have written it before a barrier.
struct KnownLayer {
  using Color = Rgba;
  const Layer& layer;
  ImageSize size;

  EMSCAPE_HD Rgba at(int x, int y) const {
    const float4 p = layer.at(x, y);
    return {p.x, p.y, p.z, p.w};
  }
};

/// As predictMidpoint(); in the middle of the picture all pixels are read before the first is waited for.
__device__ inline bool predictPixel(const KnownLayer& known, const Pass& pass, int x, int y,
                                    Prediction<Rgba>& prediction) {
  const int r = pass.reach;
  if (!contains(known, x - 3 * r, y - 3 * r) || !contains(known, x + 3 * r, y + 3 * r)) {
    return predictMidpoint(known, pass, x, y, prediction);
  }
  constexpr int kSteps[] = {-1, 1, -3, 3};
  const int dy = pass.diagonal ? r : 0;
  const int dx = pass.diagonal ? -r : 0;
  Rgba p[4], q[4];
#pragma unroll
  for (int n = 0; n < 4; ++n) p[n] = known.at(x + kSteps[n] * r, y + kSteps[n] * dy);
#pragma unroll
  for (int n = 0; n < 4; ++n) q[n] = known.at(x + kSteps[n] * dx, y + kSteps[n] * r);
  prediction = predict(predictAlong(p[0], p[1], p[2], p[3]), predictAlong(q[0], q[1], q[2], q[3]));
  return true;
}

/// Leaves a pixel transparent, or as it is predicted. @return whether it must be cast instead
__device__ inline bool mustBeCast(const AdaptiveLaunch& launch, const Pass* pass, int x, int y) {
  const ImageSize size = launch.layer.size;
  const bool is_inside = launch.inside[y].contains(x);
  bool must_be_cast = is_inside;
  Prediction<Rgba> prediction{};
  std::uint8_t error_class = 0;
  if (is_inside && pass != nullptr) {
    must_be_cast =
        !predictPixel({launch.layer, size}, *pass, x, y, prediction) ||
        !(prediction.error_levels <= launch.tolerance_levels * static_cast<float>(pass->tolerance));
    if (!must_be_cast) error_class = errorClassOf(prediction.error_levels);
  }
  if (!must_be_cast) launch.layer.at(x, y) = toFloat4(prediction.color);
  launch.classes[pixelIndex(size, x, y)] = error_class;
  return must_be_cast;
}

/// Pixels that a block is to cast, in its shared memory.
struct BlockQueue {
  static constexpr unsigned kMost = 6144;
  Pixel pixels[kMost];
  unsigned length;
  unsigned rays;  ///< of the whole frame

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

/// Looks at the block's pixels from the first one on, as many as the queue holds.
/// @return how many the block has
__device__ inline unsigned lookAtPixels(const AdaptiveLaunch& launch, int pass, unsigned first,
                                        BlockQueue& queue) {
  const AdaptiveStage stage(launch, pass);
  const unsigned pixels = stage.pixelsOfBlock();
  const unsigned end = min(first + BlockQueue::kMost, pixels);
  for (unsigned n = first + threadIdx.x; n - threadIdx.x % 32 < end; n += kCastThreads) {
    int x = 0, y = 0;
    const bool must_be_cast =
        n < end && stage.pixelOf(n, launch.layer.size, x, y) && mustBeCast(launch, stage.pass(), x, y);
    queue.append(must_be_cast, x, y);
  }
  return pixels;
}

/// Casts one ray by several threads, `rays` lanes apart, each of which takes as many of its parts; with any
/// number of them, and as castTask() does it, a pixel becomes the same. All threads of a warp call it.
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
  Compositor whole = RayKind::begin(launch);
  Compositor half = whole.behind();
  int part = static_cast<int>(lane / rays) * parts_of_thread;
  int end = part + parts_of_thread;
  bool done = pieces.count == 0;
  // Every sample is taken in one place: code that was not run before is waited for.
  for (bool again = false;; again = true) {
    for (; part < end && !done; ++part) {
      if (again && part == kParts / kRayHalves) {
        whole.join(half);
        half = whole.behind();
      }
      Compositor next = half.behind();
      done = RayKind::castPart(launch, pieces, part, colors, next);
      half.join(next);
    }
    if (again) break;
    // The first of a ray's threads knew what lies before its parts: nothing.
    const Compositor own = half;
    bool is_sure = true;
#pragma unroll 1
    for (unsigned n = 1; n < threads; ++n) {
      const Compositor cast = fromLane(own, n * rays + lane % rays);
      if (done || !is_sure) continue;
      if (2 * n == threads) {
        whole.join(half);
        half = whole.behind();
      }
      Compositor joined = half;
      joined.join(cast);
      is_sure = !joined.nearlyDone();
      if (is_sure) {
        half = joined;
      } else {
        part = static_cast<int>(n) * parts_of_thread;
      }
    }
    if (done || is_sure || lane >= rays) break;
    end = kParts;  // the rest once more, now that it is known what lies before
  }
  whole.join(half);
  return whole.result(launch.task.transfer);
}

/// All threads of a block call it. @param is_lattice  the rays are many
template <class RayKind>
__device__ void castQueued(const CastLaunch& launch, const typename RayKind::Colors& colors,
                           const BlockQueue& queue, bool is_lattice) {
  constexpr unsigned kWarps = kCastThreads / 32;
  const unsigned warp = threadIdx.x / 32, lane = threadIdx.x % 32;
  if constexpr (RayKind::kParts == 1) {
    // Rays of a warp wait for each other: as few of them as leave no warp without.
    const unsigned count = queue.length;
    const unsigned rays = min(max((count + kWarps - 1) / kWarps, 1U), 32U);
    for (unsigned n = warp * rays + lane; n < count; n += kWarps * rays) {
      if (lane >= rays) break;
      const Pixel pixel = queue.pixels[n];
      launch.layer.at(pixel.x, pixel.y) =
          toFloat4(RayKind::cast(launch, colors, pixel.x, pixel.y, limitOf(launch, pixel)));
    }
  } else {
    const unsigned threads = is_lattice ? kLatticeThreads : static_cast<unsigned>(RayKind::kParts);
    const unsigned rays = 32 / threads;
    for (unsigned first = warp * rays; first < queue.length; first += kWarps * rays) {
      const unsigned n = first + lane % rays;
      const bool has_pixel = n < queue.length;
      const Pixel pixel = has_pixel ? queue.pixels[n] : Pixel{};
      const RayPieces pieces =
          launch.task.piecesOf(pixel.x, pixel.y, has_pixel ? limitOf(launch, pixel) : 0.0);
      const Rgba color = castByThreads<RayKind>(launch, colors, pieces, threads);
      if (has_pixel && lane < rays) launch.layer.at(pixel.x, pixel.y) = toFloat4(color);
    }
  }
}

/// As many blocks as run at a time.
template <class RayKind>
__global__ void __launch_bounds__(kCastThreads, 1)
    castAdaptiveFrame(const __grid_constant__ AdaptiveLaunch launch) {
  __shared__ BlockQueue queue;
  const typename RayKind::Colors colors(launch);
  if (threadIdx.x == 0) queue.rays = 0;
#pragma unroll 1
  for (int pass = -1; pass < AdaptiveLaunch::kPassCount; ++pass) {
    if (pass >= 0) cooperative_groups::this_grid().sync();
    for (unsigned first = 0, looked_at = ~0U; first < looked_at; first += BlockQueue::kMost) {
      if (threadIdx.x == 0) queue.length = 0;
      __syncthreads();
      looked_at = lookAtPixels(launch, pass, first, queue);
      __syncthreads();
      if (threadIdx.x == 0) queue.rays += queue.length;
      castQueued<RayKind>(launch, colors, queue, pass < 0);
      __syncthreads();
    }
  }
  if (threadIdx.x == 0) atomicAdd(launch.rays, queue.rays);
}

template <class RayKind>
void start(const AdaptiveLaunch& launch, cudaStream_t stream) {
  static const unsigned resident = residentBlocks(castAdaptiveFrame<RayKind>);
  cudaLaunchAttribute together{};
  together.id = cudaLaunchAttributeCooperative;
  together.val.cooperative = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = resident;
  config.blockDim = kCastThreads;
  config.dynamicSmemBytes = RayKind::Colors::sharedBytes(launch);
  config.stream = stream;
  config.attrs = &together;
  config.numAttrs = 1;
  // What goes wrong is told by checkLaunch(), with the kernel's name.
  static_cast<void>(cudaLaunchKernelEx(&config, castAdaptiveFrame<RayKind>, launch));
  emscape::cuda::checkLaunch("castAdaptiveFrame");
}

}  // namespace emscape::render::cuda
