#include <algorithm>
#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "base/device_math.h"
#include "emfield/cuda/excess_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;
using propagation::DiffractionColumn;
using propagation::kBisectionStep;
using propagation::kMissingTerrain;

constexpr int kThreads = 128;
constexpr int kReceivers = propagation::kDiffractionReceivers;

unsigned blocksFor(int threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

/// A column's profile for DiffractionColumn: the fan's samples nearer than the column, linear between
/// the azimuths, as readProfile().
class FanPosts {
 public:
  __device__ FanPosts(const DiffractionTask& task, const FanIndex& index)
      : ranges_m_(task.sector.emitter.fan.ranges_m),
        azimuths_(task.sector.interval_count + 1),
        before_(task.sector.emitter.fan.lastBefore(index.range_m)),
        distance_m_(index.range_m) {
    const int interval = static_cast<int>(index.azimuth_index);
    weight_ = static_cast<float>(index.azimuth_index - interval);
    heights_m_ = task.sector.samples + (interval - task.sector.first_interval);
    blocks_ = task.blocks + (interval - task.sector.first_interval);
    sums_ = task.sums + (interval - task.sector.first_interval);
  }

  /// Below the column.
  __device__ void setGround(float ground_msl_m) { ground_msl_m_ = ground_msl_m; }

  __device__ int count() const { return before_ + 1; }
  __device__ double range_m(int i) const { return ranges_m_[i]; }
  __device__ float height_msl_m(int i) const {
    const float* left = heights_m_ + i * azimuths_;
    return lerp(left[0], left[1], weight_);
  }
  __device__ float highest_msl_m(int b) const {
    const FanBlock* left = blocks_ + b * azimuths_;
    return lerp(left[0].highest_msl_m, left[1].highest_msl_m, weight_);
  }
  __device__ float lowered_msl_m(int b) const {
    const FanBlock* left = blocks_ + b * azimuths_;
    return lerp(left[0].lowered_msl_m, left[1].lowered_msl_m, weight_);
  }
  __device__ TerrainSums sumsBefore(int b) const {
    const TerrainSums* left = sums_ + b * azimuths_;
    const double weight = static_cast<double>(weight_);
    return {left[0].v1 + weight * (left[1].v1 - left[0].v1), left[0].v2 + weight * (left[1].v2 - left[0].v2)};
  }
  __device__ double distance_m() const { return distance_m_; }
  __device__ float ground_msl_m() const { return ground_msl_m_; }
  /// Ranges are even except for the first ones: an estimate from the end, then a few steps.
  __device__ int lastBefore(double range_m) const {
    if (before_ == 0) return 0;
    const double even_m = ranges_m_[before_] - ranges_m_[before_ - 1];
    const int guess = before_ - static_cast<int>((ranges_m_[before_] - range_m) / even_m);
    int post = guess < 0 ? 0 : guess > before_ ? before_ : guess;
    while (post > 0 && ranges_m_[post] >= range_m) --post;
    while (post < before_ && ranges_m_[post + 1] < range_m) ++post;
    return post;
  }

 private:
  const double* ranges_m_;
  long long azimuths_;
  int before_;
  double distance_m_;
  float ground_msl_m_;
  float weight_;
  const float* heights_m_;
  const FanBlock* blocks_;
  const TerrainSums* sums_;
};

/// Blocks, and the sums of each one's own intervals.
__global__ void blocksKernel(const DiffractionTask* tasks) {
  const DiffractionTask& task = tasks[blockIdx.z];
  const FanSector& sector = task.sector;
  const int a = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int b = static_cast<int>(blockIdx.y);
  if (a > sector.interval_count || b >= DiffractionTask::blockCount(sector.emitter.fan.range_count)) return;
  const int used = sector.usedRanges(a);
  const int begin = b * kDiffractionBlock;
  const int end = min(begin + kDiffractionBlock, used);
  const float* const heights_m = sector.samples + a * sector.azimuth_stride;
  const double* const ranges_m = sector.emitter.fan.ranges_m;
  const double curvature = static_cast<double>(task.model.model.half_curvature);
  const double base = static_cast<double>(heights_m[0]);
  FanBlock block{-HUGE_VALF, -HUGE_VALF};
  TerrainSums sums;
  double before_m = 0, before_height_m = 0;
  if (begin > 0 && begin < end) {
    before_m = ranges_m[begin - 1];
    before_height_m = static_cast<double>(heights_m[(begin - 1) * sector.range_stride]) - base;
  }
  for (int i = begin; i < end; ++i) {
    const float height_msl_m = heights_m[i * sector.range_stride];
    const double range_m = ranges_m[i], height_m = static_cast<double>(height_msl_m) - base;
    if (i > 0) sums.add(before_m, before_height_m, range_m, height_m);
    before_m = range_m;
    before_height_m = height_m;
    const auto lowered =
        static_cast<float>(static_cast<double>(height_msl_m) - curvature * range_m * range_m);
    block.highest_msl_m = fmaxf(block.highest_msl_m, height_msl_m);
    block.lowered_msl_m = fmaxf(block.lowered_msl_m, lowered);
  }
  const long long at = static_cast<long long>(b) * (sector.interval_count + 1) + a;
  task.blocks[at] = block;
  task.sums[at] = sums;
}

/// Sums of each block become those before it. One thread per azimuth.
__global__ void sumsKernel(const DiffractionTask* tasks) {
  constexpr int kAhead = 8;
  const DiffractionTask& task = tasks[blockIdx.y];
  const FanSector& sector = task.sector;
  const int a = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (a > sector.interval_count) return;
  const long long azimuths = sector.interval_count + 1;
  const int blocks = DiffractionTask::blockCount(sector.usedRanges(a));
  TerrainSums* const of = task.sums + a;
  TerrainSums before;
  for (int begin = 0; begin < blocks; begin += kAhead) {
    TerrainSums own[kAhead];
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n < blocks) own[n] = of[(begin + n) * azimuths];
    }
#pragma unroll
    for (int n = 0; n < kAhead; ++n) {
      if (begin + n >= blocks) break;
      of[(begin + n) * azimuths] = before;
      before.v1 += own[n].v1;
      before.v2 += own[n].v2;
    }
  }
}

/// Once for a column; one thread at a time.
__device__ void markUnknown(const ExcessOutputs& to, int column) {
  if (isnan(to.out.shadow_edge_m[column])) return;
  to.out.markUnknown(static_cast<std::size_t>(column));
  atomicAdd(&to.counts->unknown_columns, 1);
}

/// Columns of a block, and of each of its warps: the columns of a square share more data than those of a row.
constexpr int kTileX = 16, kTileY = 8, kWarpX = 8, kWarpY = 4;

/// @tparam kTilted  columns are tilted: they are cut into the grid's segments, each above a point of its own
template <bool kTilted>
__global__ void __launch_bounds__(kTileX* kTileY, 5)
    diffractionKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid, int row,
                      const std::uint16_t* first_valid_k) {
  const int lane = static_cast<int>(threadIdx.x) % 32, warp = static_cast<int>(threadIdx.x) / 32;
  constexpr int kWarpsX = kTileX / kWarpX;
  const int x = static_cast<int>(blockIdx.x) * kTileX + warp % kWarpsX * kWarpX + lane % kWarpX;
  const int y = static_cast<int>(blockIdx.y) * kTileY + warp / kWarpsX * kWarpY + lane / kWarpX;
  const auto layer = static_cast<long long>(grid.column_count);
  if (x >= row || static_cast<long long>(y) * row >= layer) return;
  const int c = y * row + x;
  const DiffractionTask& task = tasks[blockIdx.z];
  FanIndex index;
  if (!kTilted) {
    index = task.sector.emitter.fan_indices[c];
    const int interval = static_cast<int>(index.azimuth_index) - task.sector.first_interval;
    if (interval < 0 || interval >= task.sector.interval_count) return;
  }

  ExcessCode* const codes = task.to.out.codes + c;
  const int lowest = first_valid_k == nullptr ? 0 : min(static_cast<int>(first_valid_k[c]), grid.layers);
  for (int below = 0; below < lowest; ++below) codes[below * layer] = 0;
  const AirLoss& air = task.air;
  const GridColumn& column = grid.columns[c];
  bool is_unknown = false;
  for (int segment = 0; segment < (kTilted ? grid.segments : 1); ++segment) {
    const int end = kTilted ? grid.firstLayer(segment + 1) : grid.layers;
    int k = kTilted ? max(lowest, grid.firstLayer(segment)) : lowest;
    if (kTilted) {
      const LocateTask& emitter = task.sector.emitter;
      const FanCoordinates point = grid.coordinatesOf(emitter.station, static_cast<std::size_t>(c), segment);
      index = {emitter.fan.azimuthIndex(point.azimuth_rad), point.range_m};
    }
    const auto heightOf = [&](int layer_k) {
      const int here = min(layer_k, end - 1);
      return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[here])));
    };
    bool is_free = !(index.range_m > 0);  // at the emitter itself
    if (!is_free) {
      FanPosts posts(task, index);
      if (kTilted) {
        posts.setGround(heightBetween(task.sector.emitter.fan, index.range_m,
                                      [&](int range) { return posts.height_msl_m(range); }));
      } else {
        posts.setGround(grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : 0);
      }
      DiffractionColumn<float, FanPosts> receivers(task.model.model, posts, task.model.tx_msl_m);
      if (receivers.isUnknown()) {
        is_unknown = true;
        for (; k < end; ++k) codes[k * layer] = kUnknownExcess;
      }
      while (k < end && !is_free) {
        float rx_msl_m[kReceivers], loss_db[kReceivers];
#pragma unroll
        for (int j = 0; j < kReceivers; ++j) rx_msl_m[j] = heightOf(k + j);
        is_free = receivers.losses(rx_msl_m, loss_db);
#pragma unroll
        for (int j = 0; j < kReceivers; ++j) {
          if (k + j >= end) break;
          if (!air.isClear()) loss_db[j] += air.lossDb(static_cast<float>(index.range_m), rx_msl_m[j]);
          codes[(k + j) * layer] = excessCode(loss_db[j]);
        }
        k += kReceivers;
      }
    }
    for (; k < end; ++k) {
      codes[k * layer] =
          air.isClear() ? 0 : excessCode(air.lossDb(static_cast<float>(index.range_m), heightOf(k)));
    }
  }
  if (is_unknown) markUnknown(task.to, c);
}

__device__ void note(const ExcessOutputs& to, int column, unsigned warnings) {
  if ((warnings & kMissingTerrain) != 0) markUnknown(to, column);
  if ((warnings & ~kMissingTerrain) != 0) atomicOr(&to.counts->warnings, warnings & ~kMissingTerrain);
}

/// Memory of columns that are computed at a time.
class ColumnMemory {
 public:
  /// State of a column between two kernels.
  struct Begun {
    ExcessColumn column;
    bool is_open;  ///< there is something to fill
  };

  ColumnMemory(void* memory, std::size_t bytes, int posts, int layers)
      : memory_(static_cast<char*>(memory)), posts_(posts), layers_(layers) {
    constexpr std::size_t kAlignment = alignof(Begun);
    bytes_each_ =
        (sizeof(Begun) + ExcessScratch::bytes(posts, layers) + kAlignment - 1) / kAlignment * kAlignment;
    columns_ = static_cast<int>(std::min<std::size_t>(bytes / bytes_each_, 1 << 30)) / kThreads * kThreads;
    if (columns_ > 0) return;
    throw Error(ErrorCode::device, "GPU: " + std::to_string(kThreads) + " columns at a time need " +
                                       std::to_string(kThreads * bytes_each_) + " bytes, of " +
                                       std::to_string(bytes));
  }
  int columns() const { return columns_; }
  __device__ Begun& begun(int n) const { return *reinterpret_cast<Begun*>(memory_ + n * bytes_each_); }
  __device__ ExcessScratch scratch(int n) const {
    return ExcessScratch::in(memory_ + n * bytes_each_ + sizeof(Begun), posts_, layers_);
  }

 private:
  char* memory_;
  std::size_t bytes_each_;
  int columns_;
  int posts_, layers_;
};

/// Whole columns, one per thread.
template <class Model>
__global__ void __launch_bounds__(kThreads)
    excessKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
                 const __grid_constant__ ColumnMemory memory) {
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int threads = static_cast<int>(gridDim.x * blockDim.x);
  const ExcessGrid& grid = task.grid;
  const ExcessScratch scratch = memory.scratch(thread);
  for (std::size_t c = thread; c < grid.column_count; c += threads) {
    unsigned warnings = 0;
    if (!task.fillColumn(c, scratch, to.out.reflected, warnings)) continue;
    note(to, static_cast<int>(c), warnings);
    for (int k = 0; k < grid.layers; ++k) {
      to.out.codes[k * grid.column_count + c] = excessCode(scratch.excess_db[k]);
    }
  }
}

/// A segment of some columns.
struct ColumnRun {
  int first, count;
  int segment;
};

/// The part that runs once per column.
template <class Model>
__global__ void __launch_bounds__(kThreads)
    beginKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
                const __grid_constant__ ColumnMemory memory, ColumnRun run) {
  const int n = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (n >= run.count) return;
  const ExcessScratch scratch = memory.scratch(n);
  ExcessColumn column;
  const bool is_here = task.readSegment(run.first + n, run.segment, scratch, column);
  unsigned warnings = 0;
  const int first = task.grid.firstLayer(run.segment);
  if (is_here) warnings = task.model.begin(column, scratch, scratch.excess_db + first);
  memory.begun(n) = {column, is_here && warnings == 0};
  if (warnings == 0) return;
  note(to, run.first + n, warnings);
  for (int k = 0; k < column.count; ++k) {
    const float excess_db = scratch.excess_db[first + k];
    to.out.codes[(first + k) * task.grid.column_count + run.first + n] = excessCode(excess_db);
  }
}

/// Parts of columns, one per thread: neighbours read the same profile.
template <class Model>
__global__ void __launch_bounds__(kThreads)
    fillKernel(const __grid_constant__ ExcessTask<Model> task, const __grid_constant__ ExcessOutputs to,
               const __grid_constant__ ColumnMemory memory, ColumnRun run, int parts) {
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int n = thread / parts;
  if (n >= run.count) return;
  const ColumnMemory::Begun begun = memory.begun(n);
  const int begin = thread % parts * kBisectionStep;
  const int end = min(begin + kBisectionStep, begun.column.count);
  if (!begun.is_open || begin >= end) return;
  const ExcessScratch scratch = memory.scratch(n);
  const int first = task.grid.firstLayer(run.segment);
  float* const excess_db = scratch.excess_db + first;
  float other_db[kBisectionStep + 1];
  note(to, run.first + n, task.model.fill(begun.column, scratch, {begin, end, other_db}, excess_db));
  task.addAir(begun.column, begin, end, excess_db);
  for (int k = begin; k < end; ++k) {
    to.out.codes[(first + k) * task.grid.column_count + run.first + n] = excessCode(excess_db[k]);
  }
}

template <class Model>
void launchExcess(const ExcessTask<Model>& task, const ExcessOutputs& to, const ColumnMemory& memory,
                  cudaStream_t stream) {
  const ExcessGrid& grid = task.grid;
  const int columns = static_cast<int>(grid.column_count);
  if constexpr (!Model::kInParts) {
    excessKernel<<<blocksFor(std::min(memory.columns(), columns)), kThreads, 0, stream>>>(task, to, memory);
    checkLaunch("excess");
  } else {
    const int parts = (grid.firstLayer(1) + kBisectionStep) / kBisectionStep;  // segments differ by a layer
    const int runs = (columns + memory.columns() - 1) / memory.columns();
    for (int segment = 0; segment < grid.segments; ++segment) {
      for (int r = 0; r < runs; ++r) {
        const int first = static_cast<int>(static_cast<long long>(columns) * r / runs);
        const int end = static_cast<int>(static_cast<long long>(columns) * (r + 1) / runs);
        const ColumnRun run{first, end - first, segment};
        beginKernel<<<blocksFor(run.count), kThreads, 0, stream>>>(task, to, memory, run);
        checkLaunch("excess of columns");
        fillKernel<<<blocksFor(run.count * parts), kThreads, 0, stream>>>(task, to, memory, run, parts);
        checkLaunch("excess of parts");
      }
    }
  }
}

}  // namespace

void fillDiffraction(const DiffractionTask* tasks, const SectorExtent& extent, const ExcessGrid& grid,
                     int row, bool tilted, const std::uint16_t* first_valid_k, cudaStream_t stream) {
  const auto count = static_cast<unsigned>(extent.sectors);
  const dim3 blocks(blocksFor(extent.azimuths),
                    static_cast<unsigned>(DiffractionTask::blockCount(extent.ranges)), count);
  blocksKernel<<<blocks, kThreads, 0, stream>>>(tasks);
  checkLaunch("terrain blocks");
  constexpr int kWarp = 32;
  const dim3 warps(static_cast<unsigned>((extent.azimuths + kWarp - 1) / kWarp), count);
  sumsKernel<<<warps, kWarp, 0, stream>>>(tasks);
  checkLaunch("terrain sums");
  const int rows = static_cast<int>(grid.column_count) / row;
  const dim3 tiles(static_cast<unsigned>((row + kTileX - 1) / kTileX),
                   static_cast<unsigned>((rows + kTileY - 1) / kTileY), count);
  const auto kernel = tilted ? diffractionKernel<true> : diffractionKernel<false>;
  kernel<<<tiles, kTileX * kTileY, 0, stream>>>(tasks, grid, row, first_valid_k);
  checkLaunch("diffraction");
}

void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const FanHeights& fan, const ExcessOutputs& to, void* scratch, std::size_t scratch_bytes,
                cudaStream_t stream) {
  std::visit(
      [&](const auto& m) {
        using Model = std::decay_t<decltype(m)>;
        if constexpr (!std::is_same_v<Model, DiffractionExcess>) {  // it has its own kernel
          const ExcessTask<Model> task{m, excess.air, station, grid, fan};
          launchExcess(task, to, ColumnMemory(scratch, scratch_bytes, task.posts(), grid.layers), stream);
        }
      },
      excess.model);
}

}  // namespace emscape::emfield::cuda
