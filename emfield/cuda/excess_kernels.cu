#include <algorithm>
#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/excess_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using emscape::cuda::checkLaunch;
using propagation::ColumnPart;
using propagation::DiffractionColumn;
using propagation::kBisectionStep;
using propagation::kMissingTerrain;
using propagation::TerrainSums;

constexpr int kThreads = 128;
constexpr int kReceivers = propagation::kDiffractionReceivers;

unsigned blocksFor(int threads) {
  return static_cast<unsigned>((threads + kThreads - 1) / kThreads);
}

/// @throws Error (device)
[[noreturn]] void throwTooSmall(std::size_t bytes_each, std::size_t bytes) {
  throw Error(ErrorCode::device, "GPU: " + std::to_string(kThreads) + " columns at a time need " +
                                     std::to_string(kThreads * bytes_each) + " bytes, of " +
                                     std::to_string(bytes));
}

/// Summary of a block of posts; see DiffractionColumn.
struct PostBlock {
  float highest_msl_m, lowered_msl_m;
};

/// Memory for the profiles of the columns that are computed at a time: of each post or block of posts the
/// threads one after another.
class ProfileMemory {
 public:
  /// @param posts  of the longest profile
  ProfileMemory(const ScratchMemory& memory, int posts) {
    constexpr int kBlock = propagation::kDiffractionBlock;
    const auto blocks = static_cast<std::size_t>((posts + kBlock - 1) / kBlock);
    const std::size_t bytes_each = blocks * (kBlock * sizeof(float) + sizeof(PostBlock));
    threads_ =
        static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each, 1 << 30)) / kThreads * kThreads;
    if (threads_ == 0) throwTooSmall(bytes_each, memory.bytes);
    blocks_ = static_cast<PostBlock*>(memory.data);
    heights_msl_m_ = reinterpret_cast<float*>(blocks_ + blocks * static_cast<std::size_t>(threads_));
  }
  int threads() const { return threads_; }
  __device__ float& height_msl_m(int thread, int post) const {
    return heights_msl_m_[static_cast<long long>(post) * threads_ + thread];
  }
  __device__ PostBlock& block(int thread, int b) const {
    return blocks_[static_cast<long long>(b) * threads_ + thread];
  }

 private:
  int threads_;
  PostBlock* blocks_;
  float* heights_msl_m_;
};

/// A column's profile for DiffractionColumn, as propagation::ProfilePosts.
class ColumnPosts {
 public:
  /// Reads the profile.
  __device__ ColumnPosts(const DiffractionTask& task, const FastInverse& path, float ground_msl_m,
                         const ProfileMemory& memory, int thread)
      : ranges_m_(task.ground.ranges_m),
        before_(task.ground.lastBefore(path.distance_m)),
        thread_(thread),
        distance_m_(path.distance_m),
        ground_msl_m_(ground_msl_m),
        memory_(memory) {
    constexpr int kBlock = propagation::kDiffractionBlock;
    const auto curvature = static_cast<float>(task.model.model.half_curvature);
    const int last_block = before_ / kBlock * kBlock;
    PostBlock block{-HUGE_VALF, -HUGE_VALF};
    double base = 0, before_m = 0, before_height_m = 0;
    visitPosts(task.station, task.ground, path, count(), [&](int i, float height_msl_m) {
      memory.height_msl_m(thread, i) = height_msl_m;
      const double range_m = ranges_m_[i];
      if (i == 0) base = static_cast<double>(height_msl_m);
      const double height_m = static_cast<double>(height_msl_m) - base;
      if (i > 0 && i < last_block) sums_.add(before_m, before_height_m, range_m, height_m);
      before_m = range_m;
      before_height_m = height_m;
      const auto range = static_cast<float>(range_m);
      block.highest_msl_m = fmaxf(block.highest_msl_m, height_msl_m);
      block.lowered_msl_m = fmaxf(block.lowered_msl_m, height_msl_m - curvature * range * range);
      if (i % kBlock != kBlock - 1 && i != before_) return;
      memory.block(thread, i / kBlock) = block;
      block = {-HUGE_VALF, -HUGE_VALF};
    });
  }

  __device__ int count() const { return before_ + 1; }
  __device__ double range_m(int i) const { return ranges_m_[i]; }
  __device__ float height_msl_m(int i) const { return memory_.height_msl_m(thread_, i); }
  __device__ float highest_msl_m(int b) const { return memory_.block(thread_, b).highest_msl_m; }
  __device__ float lowered_msl_m(int b) const { return memory_.block(thread_, b).lowered_msl_m; }
  /// Those before the last block: DiffractionColumn reads no others.
  __device__ TerrainSums sumsBefore(int) const { return sums_; }
  __device__ double distance_m() const { return distance_m_; }
  __device__ float ground_msl_m() const { return ground_msl_m_; }
  __device__ double sea_m() const {
    return propagation::lengthOverSea_m(
        count() + 1, [this](int i) { return i <= before_ ? ranges_m_[i] : distance_m_; },
        [this](int i) { return i <= before_ ? height_msl_m(i) : ground_msl_m_; });
  }
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
  int before_;
  int thread_;
  double distance_m_;
  float ground_msl_m_;
  const ProfileMemory& memory_;
  TerrainSums sums_;
};

/// Once for a column; one thread at a time.
__device__ void markUnknown(const ExcessOutputs& to, int column) {
  if (isnan(to.out.shadow_edge_m[column])) return;
  to.out.markUnknown(static_cast<std::size_t>(column));
  atomicAdd(&to.counts->unknown_columns, 1);
}

/// Columns of a block, and of each of its warps: the columns of a square share more data than those of a row.
constexpr int kTileX = 16, kTileY = 8, kWarpX = 8, kWarpY = 4;
static_assert(kTileX * kTileY == kThreads);

/// Tiles of kTileX x kTileY columns: over a grid's rows, of all tasks.
struct Tiles {
  int along_x, along_y, count;
};

/// A call of its own: its registers are not those of the columns.
__device__ __noinline__ float effectiveHeight_m(const Station& station, float height_msl_m, double range_m) {
  return static_cast<float>(
      station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m), station.height_msl_m, range_m));
}

/// The column of a thread in a tile.
__device__ void diffractionOfColumn(const DiffractionTask& task, const ExcessGrid& grid, int c,
                                    const ProfileMemory& memory, int thread) {
  const auto layer = static_cast<long long>(grid.column_count);
  const auto set = [&](int layer_k, float excess_db) {
    task.to.out.excess.set(static_cast<std::size_t>(layer_k * layer + c), excess_db);
  };
  const int lowest = grid.firstValid(static_cast<std::size_t>(c));
  for (int below = 0; below < lowest; ++below) set(below, 0);
  if (grid.isLeftOut(static_cast<std::size_t>(c))) return;
  const AirLoss& air = task.air;
  const GridColumn column = grid.columns[static_cast<std::size_t>(c)];
  bool is_unknown = false;
  for (int segment = 0; segment < grid.segments; ++segment) {
    const int end = grid.firstLayer(segment + 1);
    int k = max(lowest, grid.firstLayer(segment));
    const auto heightOf = [&](int layer_k) {
      const int here = min(layer_k, end - 1);
      return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[here])));
    };
    const FastInverse path = grid.coordinatesOf(task.station, static_cast<std::size_t>(c), segment);
    const propagation::AirColumn above(air, static_cast<float>(path.distance_m));
    bool is_free = !(path.distance_m > 0);  // at the emitter itself
    if (!is_free) {
      const float ground_msl_m =
          grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(task.station, task.ground, path);
      const ColumnPosts posts(task, path, ground_msl_m, memory, thread);
      DiffractionColumn<float, ColumnPosts> receivers(task.model.model, posts, task.model.tx_msl_m);
      if (receivers.isUnknown()) {
        is_unknown = true;
        for (; k < end; ++k) set(k, NAN);
      }
      while (k < end && !is_free) {
        float rx_msl_m[kReceivers], loss_db[kReceivers];
#pragma unroll
        for (int j = 0; j < kReceivers; ++j) rx_msl_m[j] = heightOf(k + j);
        if (task.station.refraction.exponential) {
          for (int j = 0; j < kReceivers; ++j) {
            rx_msl_m[j] = effectiveHeight_m(task.station, rx_msl_m[j], path.distance_m);
          }
        }
        is_free = receivers.losses(rx_msl_m, loss_db);
#pragma unroll
        for (int j = 0; j < kReceivers; ++j) {
          if (k + j >= end) break;
          if (!air.isClear()) loss_db[j] += above.lossDb(heightOf(k + j));
          set(k + j, loss_db[j]);
        }
        k += kReceivers;
      }
    }
    for (; k < end; ++k) set(k, air.isClear() ? 0 : above.lossDb(heightOf(k)));
  }
  if (is_unknown) markUnknown(task.to, c);
}

__global__ void __launch_bounds__(kThreads, 5)
    diffractionKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid, int row,
                      const __grid_constant__ ProfileMemory memory, Tiles tiles) {
  const int lane = static_cast<int>(threadIdx.x) % 32, warp = static_cast<int>(threadIdx.x) / 32;
  constexpr int kWarpsX = kTileX / kWarpX;
  const int in_tile_x = warp % kWarpsX * kWarpX + lane % kWarpX;
  const int in_tile_y = warp / kWarpsX * kWarpY + lane / kWarpX;
  const int thread = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  for (int tile = static_cast<int>(blockIdx.x); tile < tiles.count; tile += static_cast<int>(gridDim.x)) {
    const int x = tile % tiles.along_x * kTileX + in_tile_x;
    const int y = tile / tiles.along_x % tiles.along_y * kTileY + in_tile_y;
    if (x >= row || static_cast<std::size_t>(y) * row >= grid.column_count) continue;
    const int c = y * row + x;
    diffractionOfColumn(tasks[tile / (tiles.along_x * tiles.along_y)], grid, c, memory, thread);
  }
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

  ColumnMemory(const ScratchMemory& memory, int posts, int layers)
      : memory_(static_cast<char*>(memory.data)), posts_(posts), layers_(layers) {
    constexpr std::size_t kAlignment = alignof(Begun);
    bytes_each_ =
        (sizeof(Begun) + ExcessScratch::bytes(posts, layers) + kAlignment - 1) / kAlignment * kAlignment;
    columns_ =
        static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each_, 1 << 30)) / kThreads * kThreads;
    if (columns_ == 0) throwTooSmall(bytes_each_, memory.bytes);
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
    if (grid.isLeftOut(c)) {
      for (int k = 0; k < grid.layers; ++k) to.out.excess.set(k * grid.column_count + c, 0);
      continue;
    }
    const unsigned warnings = task.fillColumn(c, scratch, PostReader{}, to.out.reflected, to.out.mechanisms);
    note(to, static_cast<int>(c), warnings);
    for (int k = 0; k < grid.layers; ++k) {
      to.out.excess.set(k * grid.column_count + c, scratch.excess_db[k]);
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
  if (task.grid.isLeftOut(run.first + n)) {
    memory.begun(n).is_open = false;
    for (int k = 0; k < task.grid.layers; ++k)
      to.out.excess.set(k * task.grid.column_count + run.first + n, 0);
    return;
  }
  const ExcessScratch scratch = memory.scratch(n);
  const ExcessColumn column = task.readSegment(run.first + n, run.segment, scratch, PostReader{});
  const int first = task.grid.firstLayer(run.segment);
  const unsigned warnings = task.model.begin(column, scratch, scratch.excess_db + first);
  memory.begun(n) = {column, warnings == 0};
  if (warnings == 0) return;
  note(to, run.first + n, warnings);
  for (int k = 0; k < column.count; ++k) {
    const float excess_db = scratch.excess_db[first + k];
    to.out.excess.set((first + k) * task.grid.column_count + run.first + n, excess_db);
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
  const auto c = static_cast<std::size_t>(run.first + n);
  const auto voxel = [&](int k) { return (first + k) * task.grid.column_count + c; };
  float* const excess_db = scratch.excess_db + first;
  float other_db[kBisectionStep + 1];
  const ColumnPart part{begin, end, other_db};
  if constexpr (propagation::OverDiffraction<Model>::value) {
    for (int k = begin; k < end && task.model.others.over_terrain; ++k)
      other_db[k - begin] = to.out.excess.get(voxel(k));
  }
  unsigned warnings = 0;
  if constexpr (propagation::HasMechanisms<Model>::value) {
    std::uint8_t* const lowest = to.out.mechanisms == nullptr ? nullptr : to.out.mechanisms + voxel(0);
    warnings = task.model.fill(begun.column, scratch, part, excess_db, {lowest, task.grid.column_count});
  } else {
    warnings = task.model.fill(begun.column, scratch, part, excess_db);
  }
  note(to, run.first + n, warnings);
  task.addAir(c, run.segment, begun.column, begin, end, excess_db);
  for (int k = begin; k < end; ++k) to.out.excess.set(voxel(k), excess_db[k]);
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

void fillDiffraction(const DiffractionTask* tasks, int count, int ranges, const ExcessGrid& grid, int row,
                     const ScratchMemory& scratch, cudaStream_t stream) {
  const int rows = static_cast<int>(grid.column_count) / row;
  Tiles tiles{(row + kTileX - 1) / kTileX, (rows + kTileY - 1) / kTileY, 0};
  tiles.count = tiles.along_x * tiles.along_y * count;
  const ProfileMemory memory(scratch, ranges);
  const int blocks = std::min(tiles.count, memory.threads() / kThreads);
  diffractionKernel<<<static_cast<unsigned>(blocks), kThreads, 0, stream>>>(tasks, grid, row, memory, tiles);
  checkLaunch("diffraction");
}

bool needsDiffraction(const EmitterExcess& excess) {
  return std::visit(
      [](const auto& m) {
        if constexpr (propagation::OverDiffraction<std::decay_t<decltype(m)>>::value)
          return m.others.over_terrain;
        return false;
      },
      excess.model);
}

void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const GroundPosts& ground, const ExcessOutputs& to, const ScratchMemory& scratch,
                cudaStream_t stream) {
  std::visit(
      [&](const auto& m) {
        using Model = std::decay_t<decltype(m)>;
        if constexpr (!std::is_same_v<Model, DiffractionExcess>) {  // it has its own kernel
          const ExcessTask<Model> task{m, excess.air, station, grid, ground};
          launchExcess(task, to, ColumnMemory(scratch, task.posts(), grid.layers), stream);
        }
      },
      excess.model);
}

}  // namespace emscape::emfield::cuda
