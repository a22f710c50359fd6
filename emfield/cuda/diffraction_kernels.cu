#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_tiles.h"
#include "propagation/diffraction/obstacle_maxima.h"

namespace emscape::emfield::cuda {
namespace {

using propagation::DiffractionColumn;
using propagation::TerrainSums;

/// Summary of a block of posts; see DiffractionColumn.
struct PostBlock {
  float highest_msl_m, lowered_msl_m;
};

/// Memory for the profiles of the columns in progress: for each post or block of posts, the values of
/// consecutive threads.
class ProfileMemory {
 public:
  /// @param posts  of the longest profile
  ProfileMemory(const ScratchMemory& memory, int posts) {
    constexpr int kBlock = propagation::kDiffractionBlock;
    const auto blocks = static_cast<std::size_t>((posts + kBlock - 1) / kBlock);
    const std::size_t bytes_each = blocks * (kBlock * sizeof(float) + sizeof(PostBlock));
    threads_ = static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each, 1 << 30)) / kColumnThreads *
               kColumnThreads;
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
      : ground_(task.ground),
        ranges_m_(task.ground.ranges_m),
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
  /// Sums before the last block, the only ones that DiffractionColumn reads.
  __device__ TerrainSums sumsBefore(int) const { return sums_; }
  __device__ double distance_m() const { return distance_m_; }
  __device__ float ground_msl_m() const { return ground_msl_m_; }
  __device__ double sea_m() const {
    return propagation::lengthOverSea_m(
        count() + 1, [this](int i) { return i <= before_ ? ranges_m_[i] : distance_m_; },
        [this](int i) { return i <= before_ ? height_msl_m(i) : ground_msl_m_; });
  }
  __device__ int lastBefore(double range_m) const { return min(ground_.lastBefore(range_m), before_); }

 private:
  const GroundPosts& ground_;
  const double* ranges_m_;
  int before_;
  int thread_;
  double distance_m_;
  float ground_msl_m_;
  const ProfileMemory& memory_;
  TerrainSums sums_;
};

/// A separate call, so that its registers are not part of those of the columns.
__device__ __noinline__ float effectiveHeight_m(const Station& station, float height_msl_m, double range_m) {
  return static_cast<float>(
      station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m), station.height_msl_m, range_m));
}

/// Height of a receiver, as input of the model.
__device__ float modelHeight_m(const Station& station, float height_msl_m, double range_m) {
  return station.refraction.exponential ? effectiveHeight_m(station, height_msl_m, range_m) : height_msl_m;
}

/// The column of a thread in a tile.
template <int kReceivers>
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
        for (int j = 0; j < kReceivers; ++j) {
          rx_msl_m[j] = modelHeight_m(task.station, heightOf(k + j), path.distance_m);
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

/// @param left  null: all columns; else those that fillClear() left
template <int kReceivers>
__global__ void __launch_bounds__(kColumnThreads, 5)
    diffractionKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid,
                      const std::uint8_t* left, const __grid_constant__ ProfileMemory memory,
                      const __grid_constant__ Tiles tiles) {
  tiles.eachColumn(grid, [&](int task, int c, int thread) {
    if (left != nullptr && left[task * grid.column_count + static_cast<std::size_t>(c)] == 0) return;
    diffractionOfColumn<kReceivers>(tasks[task], grid, c, memory, thread);
  });
}

/// Sets the excess of a column without keeping its posts.
/// @return false: it was not set, because a receiver is not clear of the smooth earth
template <int kReceivers>
__device__ bool fillClearColumn(const DiffractionTask& task, const ExcessGrid& grid, int c) {
  const auto column_index = static_cast<std::size_t>(c);
  const auto set = [&](int k, float excess_db) {
    task.to.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + column_index, excess_db);
  };
  const int lowest = grid.firstValid(column_index);
  const auto setUnknown = [&] {
    for (int k = lowest; k < grid.layers; ++k) set(k, NAN);
    markUnknown(task.to, c);
  };
  for (int k = 0; k < lowest; ++k) set(k, 0);
  if (grid.isWithoutGround(column_index)) {
    setUnknown();
    return true;
  }
  if (lowest == grid.layers) return true;

  const FastInverse path = grid.coordinatesOf(task.station, column_index, 0);
  if (!(path.distance_m > 0)) return false;  // at the emitter itself
  const GridColumn column = grid.columns[column_index];
  const auto distance_m = static_cast<float>(path.distance_m);
  const float base_msl_m = groundAt(task.station, task.ground, {0, path.sin_azimuth, path.cos_azimuth});
  const propagation::DiffractionModel<float>& model = task.model.model;
  const float tx_m = model.raised_m(task.model.tx_msl_m - base_msl_m, 0);
  const float ground_m = grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] - base_msl_m : 0;
  const auto heightMslOf = [&](int k) {
    return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[min(k, grid.layers - 1)])));
  };
  const auto receiver_m = [&](int k) {
    return model.raised_m(modelHeight_m(task.station, heightMslOf(k), path.distance_m) - base_msl_m,
                          ground_m);
  };
  // The antennas are at least as high above the smooth earth as above their ground.
  if (!isClearThroughout(model.earth, distance_m,
                         sightLine(model.earth, distance_m, tx_m, receiver_m(lowest) - ground_m))) {
    return false;
  }
  const propagation::AirColumn air(task.air, distance_m);
  const int posts = task.ground.lastBefore(path.distance_m) + 1;
  for (int first = lowest; first < grid.layers; first += kReceivers) {
    float rx_m[kReceivers];
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) rx_m[j] = receiver_m(first + j);
    propagation::ObstacleMaxima<float, kReceivers> obstacles(model, distance_m, tx_m, rx_m);
    float known = 0;  // NaN after a missing height
    visitPosts(task.station, task.ground, path, posts, [&](int i, float height_msl_m) {
      known += height_msl_m;
      if (i > 0) obstacles.add(static_cast<float>(task.ground.ranges_m[i]), height_msl_m - base_msl_m);
    });
    if (isnan(known)) {
      setUnknown();
      return true;
    }
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) {
      if (first + j >= grid.layers) break;
      const float air_db = task.air.isClear() ? 0 : air.lossDb(heightMslOf(first + j));
      set(first + j, obstacles.lossDb(model, j) + air_db);
    }
  }
  return true;
}

template <int kReceivers>
__global__ void __launch_bounds__(kColumnThreads, 5)
    clearColumnsKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid,
                       const __grid_constant__ Tiles tiles, std::uint8_t* left, unsigned* left_count) {
  tiles.eachColumn(grid, [&](int task, int c, int) {
    const bool is_left = !fillClearColumn<kReceivers>(tasks[task], grid, c);
    left[task * grid.column_count + static_cast<std::size_t>(c)] = is_left ? 1 : 0;
    if (is_left) atomicAdd(left_count, 1u);
  });
}

/// Calls f with the first of some numbers, as a std::integral_constant, that is not below `receivers`.
template <int kFirst, int... kOthers, class Function>
void withReceivers(int receivers, const Function& f) {
  if constexpr (sizeof...(kOthers) > 0) {
    if (receivers > kFirst) return withReceivers<kOthers...>(receivers, f);
  }
  f(std::integral_constant<int, kFirst>());
}

}  // namespace

void fillDiffraction(const DiffractionTask* tasks, int count, int ranges, const ExcessGrid& grid, int row,
                     const std::uint8_t* left, const ScratchMemory& scratch, cudaStream_t stream) {
  const Tiles tiles(grid, row, count);
  const ProfileMemory memory(scratch, ranges);
  const auto blocks = static_cast<unsigned>(std::min(tiles.count(), memory.threads() / kColumnThreads));
  const auto launch = [&](auto kernel) {
    kernel<<<blocks, kColumnThreads, 0, stream>>>(tasks, grid, left, memory, tiles);
  };
  if (grid.layers == 1) {
    launch(diffractionKernel<1>);
  } else {
    launch(diffractionKernel<propagation::kDiffractionReceivers>);
  }
  emscape::cuda::checkLaunch("diffraction");
}

void fillClear(const DiffractionTask* tasks, int count, const ExcessGrid& grid, int row, std::uint8_t* left,
               unsigned* left_count, cudaStream_t stream) {
  const Tiles tiles(grid, row, count);
  const auto blocks = static_cast<unsigned>(tiles.count());
  constexpr int kMost = 8;
  const int passes = (grid.layers + kMost - 1) / kMost;
  withReceivers<1, 2, 4, 6, kMost>((grid.layers + passes - 1) / passes, [&](auto receivers) {
    clearColumnsKernel<receivers()>
        <<<blocks, kColumnThreads, 0, stream>>>(tasks, grid, tiles, left, left_count);
  });
  emscape::cuda::checkLaunch("diffraction of clear columns");
}

}  // namespace emscape::emfield::cuda
