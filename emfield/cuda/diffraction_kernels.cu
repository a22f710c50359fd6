// `diffraction` on the device: a warp a column.
//
// The first pass over a path's posts gives the steepest slope from the transmitter, and the slope of the line
// of sight above which every post is clear: nu of a post falls linearly with the receiver's height. Only
// receivers below that, or not clear of the smooth earth, are computed, some at each further pass; the others
// have no loss and were filled beforehand. The same formulas as propagation/diffraction/excess.cpp.

#include <algorithm>
#include <cstdint>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/warp_posts.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::emfield::cuda {
namespace {

using propagation::DiffractionModel;
using propagation::EffectiveHeights;
using propagation::TerrainTrend;

/// A separate call, so that its registers are not part of those of the columns.
__device__ __noinline__ float effectiveHeight_m(const Station& station, float height_msl_m, double range_m) {
  return static_cast<float>(
      station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m), station.height_msl_m, range_m));
}

/// Of tilted columns. A separate call, too.
__device__ __noinline__ float groundAtEnd(const DiffractionTask& task, const FastInverse& path) {
  return groundAt(task.station, task.ground, path);
}

/// A receiver whose loss is not yet computed: the maxima are found, and what remains takes many instructions
/// for each, by lanes with a receiver each.
struct Receiver {
  int column, layer;
  float nu;                   ///< of Bullington's edge
  float distance_m, ground_msl_m;
  EffectiveHeights<float> heights;  ///< above the smooth earth; NaN: it has no loss
  float smooth_nu, sea_fraction;    ///< nu of Bullington's edge over the smooth earth

  /// Loss (dB). @see P.526-15 eq. (68)
  __device__ float lossDb(const DiffractionModel<float>& model) const {
    const float loss_db = propagation::bullingtonLossDb(nu, distance_m);
    if (isnan(heights.tx_m)) return loss_db;
    propagation::SphericalEarth<float> earth = model.earth;
    earth.sea_fraction = sea_fraction;
    const float spherical_db = sphericalEarthLossDb(earth, distance_m, heights.tx_m, heights.rx_m);
    if (!(spherical_db > 0)) return loss_db;
    return loss_db + fmaxf(spherical_db - propagation::bullingtonLossDb(smooth_nu, distance_m), 0);
  }
};

/// Last of the posts 1..last that is nearer than a range; 1: none is.
__device__ inline int lastBefore(const PathPost* posts, int last, float range_m) {
  int begin = 1;
  while (begin < last) {
    const int middle = (begin + last + 1) / 2;
    if (posts[middle].range_m < range_m) {
      begin = middle;
    } else {
      last = middle - 1;
    }
  }
  return begin;
}

/// The receivers over the end of a path. Heights are above the first post unless stated otherwise; "plain"
/// values leave out the earth's bulge. Members are the same in all lanes, parameters named rx_m are a
/// receiver's of each lane.
class WarpColumn {
 public:
  /// @param posts  from the emitter's on
  __device__ WarpColumn(const DiffractionTask& task, const PathPost* posts, int count, float distance_m,
                        float ground_msl_m)
      : task_(task),
        posts_(posts),
        last_(count - 1),
        base_msl_m_(posts[0].height_msl_m),
        distance_m_(distance_m),
        ground_m_(ground_msl_m - base_msl_m_),
        tx_m_(DiffractionModel<float>::raised_m(task.model.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / task.model.model.earth.wavelength_m)),
        half_curvature_(task.model.model.half_curvature),
        sea_fraction_(task.model.model.earth.sea_fraction) {}

  /// The first pass. @param lowest_m  of the lowest receiver
  /// @return false if terrain is missing along the profile
  __device__ bool survey(float lowest_m) {
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    has_earth_ = !isClearThroughout(earth, distance_m_,
                                    sightLine(earth, distance_m_, tx_m_, lowest_m - ground_m_));
    return has_earth_ ? surveyPosts<true>() : surveyPosts<false>();
  }

  __device__ float receiver_m(float rx_msl_m) const {
    return DiffractionModel<float>::raised_m(rx_msl_m - base_msl_m_, ground_m_);
  }

  __device__ bool isLossy(float rx_m) const {
    return slopeTo(rx_m) < clear_slope_ || (has_earth_ && !isClearOfEarth(rx_m));
  }

  /// Of the receivers of the first `count` lanes, which rise from lane to lane.
  __device__ Receiver find(float rx_m, int count) const {
    const float slope = slopeTo(rx_m);
    const bool is_in_earth = has_earth_ && !isClearOfEarth(rx_m);
    const bool is_below = is_in_earth && slope < plain_tx_slope_;  // and so those before
    const int below = __popc(__ballot_sync(kAllLanes, is_below)), first = min(below, count);
    Maxima most;
#pragma unroll 1
    for (int at = 0; at < first; at += 4) findMaxima<4, true>(slope, at, most);
#pragma unroll 1
    for (int at = first; at < count; at += 4) findMaxima<4, false>(slope, at, most);
    const float above = tx_slope_ - slope;
    const float relative = above >= 0 ? std::sqrt(fmaxf(above * most.edge, 0)) : most.edge;
    Receiver receiver;
    receiver.nu = edge_scale_ * relative;
    receiver.distance_m = distance_m_;
    receiver.sea_fraction = sea_fraction_;
    receiver.heights.tx_m = NAN;
    if (is_in_earth) setEarth(slope, rx_m, most, receiver);
    return receiver;
  }

 private:
  /// Of a receiver.
  struct Maxima {
    float edge = -HUGE_VALF;  ///< slope from it, of one below the steepest ray; else height over sqrt(d1 d2)
    float plain_rx_slope = -HUGE_VALF, plain_height_m = -HUGE_VALF;
  };
  /// Terms of an obstacle.
  struct Obstacle {
    float range_m, beyond_m, product_m2, root;  ///< root: 1 / sqrt(product)
    float above_tx_m, bulged_m;                 ///< the latter with the earth's bulge

    __device__ float perBeyond() const { return root * root * range_m; }
  };

  __device__ float slopeTo(float rx_m) const { return (rx_m - tx_m_) / distance_m_; }
  __device__ Obstacle obstacleAt(const PathPost& at) const {
    Obstacle post;
    post.range_m = at.range_m;
    post.beyond_m = distance_m_ - post.range_m;
    post.product_m2 = post.range_m * post.beyond_m;
    post.root = rsqrtf(post.product_m2);
    post.above_tx_m = at.height_msl_m - base_msl_m_ - tx_m_;
    post.bulged_m = fmaf(half_curvature_, post.product_m2, post.above_tx_m);
    return post;
  }

  /// @tparam kEarth  also for the smooth earth
  template <bool kEarth>
  __device__ bool surveyPosts() {
    const PathPost* const posts = posts_;
    const float clearance = -propagation::kKnifeEdgeClear<float> / edge_scale_;
    float tx = -HUGE_VALF, clear = -HUGE_VALF, plain_tx = -HUGE_VALF;
    float unknown = base_msl_m_ - base_msl_m_ + (ground_m_ - ground_m_);
    float v1 = 0, v2 = 0, sea_m = 0;
#pragma unroll 2
    for (int i = 1 + static_cast<int>(threadIdx.x) % kWarpLanes; i <= last_; i += kWarpLanes) {
      const PathPost at = posts[i];
      unknown += at.height_msl_m - at.height_msl_m;
      const Obstacle post = obstacleAt(at);
      const float per_range = post.beyond_m * post.root;
      tx = fmaxf(tx, per_range * (post.bulged_m * post.root));
      clear = fmaxf(clear, per_range * fmaf(post.bulged_m, post.root, clearance));
      if constexpr (kEarth) {
        plain_tx = fmaxf(plain_tx, per_range * (post.above_tx_m * post.root));
        addToTrend(posts[i - 1], at, v1, v2, sea_m);
      }
    }
    tx_slope_ = largestOfWarp(tx);
    clear_slope_ = largestOfWarp(clear);
    if constexpr (kEarth) {
      plain_tx_slope_ = largestOfWarp(plain_tx);
      if (threadIdx.x % kWarpLanes == 0)
        addToTrend(posts[last_], {distance_m_, ground_m_ + base_msl_m_}, v1, v2, sea_m);
      const propagation::TerrainSums sums{static_cast<double>(sumOfWarp(v1)),
                                          static_cast<double>(sumOfWarp(v2))};
      trend_start_m_ = static_cast<float>(sums.start_m(static_cast<double>(distance_m_)));
      trend_end_m_ = static_cast<float>(sums.end_m(static_cast<double>(distance_m_)));
      if (task_.model.model.sea_by_height) sea_fraction_ = sumOfWarp(sea_m) / distance_m_;
    }
    return __all_sync(kAllLanes, unknown == 0);
  }
  /// Adds the interval between two posts to propagation::TerrainSums, and to the length over sea.
  __device__ void addToTrend(const PathPost& from, const PathPost& to, float& v1, float& v2,
                             float& sea_m) const {
    const float length_m = to.range_m - from.range_m;
    const float from_m = from.height_msl_m - base_msl_m_, to_m = to.height_msl_m - base_msl_m_;
    v1 = fmaf(length_m, from_m + to_m, v1);
    v2 = fmaf(length_m, to_m * (2 * to.range_m + from.range_m) + from_m * (to.range_m + 2 * from.range_m), v2);
    sea_m = fmaf(length_m, (from.height_msl_m <= 0 ? 0.5f : 0) + (to.height_msl_m <= 0 ? 0.5f : 0), sea_m);
  }

  /// Finds the maxima of the receivers of kReceivers lanes from `first` on.
  template <int kReceivers, bool kEarth>
  __device__ void findMaxima(float slope_of_lane, int first, Maxima& of_lane) const {
    float slope[kReceivers], edge[kReceivers], plain_rx[kReceivers], plain[kReceivers];
    bool is_below[kReceivers];
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) {
      slope[j] = __shfl_sync(kAllLanes, slope_of_lane, min(first + j, kWarpLanes - 1));
      is_below[j] = slope[j] <= tx_slope_;
      edge[j] = plain_rx[j] = plain[j] = -HUGE_VALF;
    }
    const PathPost* const posts = posts_;
    const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
#pragma unroll 2
    for (int i = 1 + lane; i <= last_; i += kWarpLanes) {
      const Obstacle post = obstacleAt(posts[i]);
      const float per_beyond = post.perBeyond();
#pragma unroll
      for (int j = 0; j < kReceivers; ++j) {
        const float above_m = fmaf(-slope[j], post.range_m, post.bulged_m);
        edge[j] = fmaxf(edge[j], above_m * (is_below[j] ? per_beyond : post.root));
        if constexpr (kEarth) {
          const float plain_m = fmaf(-slope[j], post.range_m, post.above_tx_m);
          plain_rx[j] = fmaxf(plain_rx[j], plain_m * per_beyond);
          plain[j] = fmaxf(plain[j], plain_m);
        }
      }
    }
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) {
      Maxima most{largestOfWarp(edge[j])};
      if constexpr (kEarth) {
        most.plain_rx_slope = largestOfWarp(plain_rx[j]);
        most.plain_height_m = largestOfWarp(plain[j]);
      }
      if (lane == first + j) of_lane = most;
    }
  }
  /// Sets what the smooth-earth correction needs.
  __device__ void setEarth(float slope, float rx_m, const Maxima& most, Receiver& receiver) const {
    TerrainTrend<float> over = trend();
    over.highest_m = most.plain_height_m;
    over.tx_angle = plain_tx_slope_ - slope;
    over.rx_angle = most.plain_rx_slope;
    const DiffractionModel<float>& model = task_.model.model;
    const EffectiveHeights<float> heights = effectiveHeights(over, tx_m_, rx_m);
    if (isClearThroughout(model.earth, distance_m_,
                          sightLine(model.earth, distance_m_, heights.tx_m, heights.rx_m)))
      return;
    receiver.heights = heights;
    const auto before = [this](float range_m) { return lastBefore(posts_, last_, range_m); };
    int clear = before(distance_m_ * heights.tx_m / (heights.tx_m + heights.rx_m));
    receiver.smooth_nu = smoothEarthNu(
        model, [this](int i) { return posts_[i].range_m; }, before, last_, distance_m_, heights, clear);
  }
  __device__ TerrainTrend<float> trend() const {
    TerrainTrend<float> trend;
    trend.start_msl_m = trend_start_m_;
    trend.end_msl_m = trend_end_m_;
    trend.highest_m = trend.tx_angle = trend.rx_angle = -HUGE_VALF;
    trend.tx_ground_msl_m = 0;
    trend.rx_ground_msl_m = ground_m_;
    return trend;
  }
  /// True if the smooth earth has no loss for a receiver and those above; see LaneColumn.
  __device__ bool isClearOfEarth(float rx_m) const {
    const EffectiveHeights<float> least = effectiveHeights(trend(), tx_m_, rx_m);
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    return isClearThroughout(earth, distance_m_, sightLine(earth, distance_m_, least.tx_m, least.rx_m));
  }

  const DiffractionTask& task_;
  const PathPost* posts_;
  int last_;  ///< the last one before the receivers
  float base_msl_m_, distance_m_, ground_m_, tx_m_;
  float edge_scale_;  ///< from heights over sqrt(d1 d2) to nu
  float half_curvature_, sea_fraction_;
  bool has_earth_ = false;             ///< the ground alone does not prove that the smooth earth has no loss
  float tx_slope_ = -HUGE_VALF;        ///< largest slope from the transmitter to an obstacle
  float clear_slope_ = -HUGE_VALF;     ///< of the lowest line of sight that all obstacles are clear of
  float plain_tx_slope_ = -HUGE_VALF;  ///< tx_slope without the earth's bulge
  float trend_start_m_ = 0, trend_end_m_ = 0;  ///< the line fitted to the terrain, with has_earth_
};

/// Losses of a voxel besides diffraction.
struct OtherLosses {
  const DiffractionTask& task;
  propagation::AirColumn air;
  float distance_m, ground_msl_m;

  __device__ OtherLosses(const DiffractionTask& of, float path_m, float ground_m)
      : task(of), air(of.air, path_m), distance_m(path_m), ground_msl_m(ground_m) {}
  __device__ float lossDb(float height_msl_m) const {
    float loss_db = task.air.isClear() ? 0 : air.lossDb(height_msl_m);
    if (task.terminal.isSet()) loss_db += task.terminal.lossDb(distance_m, height_msl_m - ground_msl_m);
    return loss_db;
  }
};

/// A task over a grid.
struct Filler {
  const DiffractionTask& task;
  const ExcessGrid& grid;

  __device__ void set(int k, int c, float excess_db) const {
    task.to.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + static_cast<std::size_t>(c),
                           excess_db);
  }
  __device__ float heightOf(int c, int k) const {
    return static_cast<float>(
        heightMsl_m(grid.columns[static_cast<std::size_t>(c)], static_cast<double>(grid.t_m[k])));
  }
  __device__ float groundBelow(int c, const FastInverse& path) const {
    return grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAtEnd(task, path);
  }
};

/// Fills all voxels by the losses besides diffraction, a thread a column.
__global__ void __launch_bounds__(kColumnThreads)
    othersKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid) {
  const int c = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const auto column_index = static_cast<std::size_t>(c);
  if (column_index >= grid.column_count) return;
  const Filler filler{tasks[blockIdx.y], grid};
  const DiffractionTask& task = filler.task;
  const int lowest = grid.firstValid(column_index);
  const bool has_others = !task.air.isClear() || task.terminal.isSet();
  for (int k = 0; k < (has_others ? lowest : grid.layers); ++k) filler.set(k, c, 0);
  if (!has_others || lowest == grid.layers) return;
  const GridColumn column = grid.columns[column_index];
  for (int segment = 0; segment < grid.segments; ++segment) {
    const FastInverse path = grid.coordinatesOf(task.station, column_index, segment);
    const OtherLosses others(task, static_cast<float>(path.distance_m),
                             task.terminal.isSet() ? filler.groundBelow(c, path) : 0);
    for (int k = max(lowest, grid.firstLayer(segment)); k < grid.firstLayer(segment + 1); ++k) {
      const auto height_msl_m = static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[k])));
      filler.set(k, c, others.lossDb(height_msl_m));
    }
  }
}

/// Receivers of a warp's tile that wait for lanes.
class ReceiverQueue {
 public:
  __device__ ReceiverQueue(const Filler& filler, Receiver* memory) : filler_(filler), memory_(memory) {}

  /// Adds the receivers of the first `count` lanes.
  __device__ void add(const Receiver& receiver, int count) {
    if (waiting_ + count > kWarpLanes) fill();
    __syncwarp();
    const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
    if (lane < count) memory_[waiting_ + lane] = receiver;
    waiting_ += count;
    __syncwarp();
  }
  /// Sets the voxels of those that wait.
  __device__ void fill() {
    if (waiting_ > 0) set(filler_, memory_, waiting_);
    waiting_ = 0;
  }

 private:
  static __device__ __noinline__ void set(const Filler& filler, const Receiver* receivers, int count) {
    const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
    if (lane >= count) return;
    const Receiver receiver = receivers[lane];
    const DiffractionTask& task = filler.task;
    float excess_db = receiver.lossDb(task.model.model);
    if (!task.air.isClear() || task.terminal.isSet()) {
      const float height_msl_m = filler.heightOf(receiver.column, receiver.layer);
      excess_db += OtherLosses(task, receiver.distance_m, receiver.ground_msl_m).lossDb(height_msl_m);
    }
    filler.set(receiver.layer, receiver.column, excess_db);
  }

  const Filler& filler_;
  Receiver* memory_;
  int waiting_ = 0;
};

/// A segment of a column, by a warp.
__device__ void fillSegment(const Filler& filler, int c, int segment, const WarpPath& path, WarpPosts& posts,
                            PathPost* memory, ReceiverQueue& queue) {
  const DiffractionTask& task = filler.task;
  const ExcessGrid& grid = filler.grid;
  const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
  const int end = grid.firstLayer(segment + 1);
  const int lowest = max(grid.firstValid(static_cast<std::size_t>(c)), grid.firstLayer(segment));
  if (lowest >= end) return;
  const int count_of_posts = posts.read(task.at_crossings, memory);
  const auto distance_m = static_cast<float>(path.to.distance_m);
  const float ground_msl_m = filler.groundBelow(c, path.to);
  WarpColumn receivers(task, memory, count_of_posts, distance_m, ground_msl_m);
  const auto receiver_m = [&](int k) {
    const float height_msl_m = filler.heightOf(c, min(k, end - 1));
    return receivers.receiver_m(task.station.refraction.exponential
                                    ? effectiveHeight_m(task.station, height_msl_m, path.to.distance_m)
                                    : height_msl_m);
  };
  float rx_m = receiver_m(lowest + lane);
  if (!receivers.survey(__shfl_sync(kAllLanes, rx_m, 0))) {
    for (int k = lowest + lane; k < end; k += kWarpLanes) filler.set(k, c, NAN);
    if (lane == 0) markUnknown(task.to, c);
    return;
  }
#pragma unroll 1
  for (int first = lowest; first < end; first += kWarpLanes) {
    if (first > lowest) rx_m = receiver_m(first + lane);
    const int count = __popc(__ballot_sync(kAllLanes, first + lane < end && receivers.isLossy(rx_m)));
    if (count == 0) return;
    Receiver receiver = receivers.find(rx_m, count);
    receiver.column = c;
    receiver.layer = first + lane;
    receiver.ground_msl_m = ground_msl_m;
    queue.add(receiver, count);
    if (count < kWarpLanes) return;
  }
}

__global__ void __launch_bounds__(kColumnThreads, 6)
    diffractionKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid,
                      const __grid_constant__ WarpTiles tiles, const __grid_constant__ PathMemory memory) {
  __shared__ alignas(Receiver) unsigned char waiting[kColumnThreads * sizeof(Receiver)];
  Receiver* const of_warp = reinterpret_cast<Receiver*>(waiting) + threadIdx.x / kWarpLanes * kWarpLanes;
  PathPost* const posts_memory = memory.ofWarp();
  const int lane = static_cast<int>(threadIdx.x) % kWarpLanes;
  tiles.eachTile([&](int number, int tile) {
    const Filler filler{tasks[number], grid};
    const DiffractionTask& task = filler.task;
    ReceiverQueue queue(filler, of_warp);
    const int mine = lane < WarpMemory::kPaths ? tiles.columnOf(grid, tile, lane) : -1;
    if (mine >= 0 && grid.isWithoutGround(static_cast<std::size_t>(mine))) {
      for (int k = grid.firstValid(static_cast<std::size_t>(mine)); k < grid.layers; ++k)
        filler.set(k, mine, NAN);
      markUnknown(task.to, mine);
    }
    for (int segment = 0; segment < grid.segments; ++segment) {
      eachPath(
          task.station, task.ground, grid, tiles, tile, segment, warpMemory(),
          [&](int c) {
            const auto column = static_cast<std::size_t>(c);
            return !grid.isWithoutGround(column) && grid.firstValid(column) < grid.layers;
          },
          [&](int c, const WarpPath& path, WarpPosts posts) {
            fillSegment(filler, c, segment, path, posts, posts_memory, queue);
          });
    }
    queue.fill();
  });
}

}  // namespace

void fillDiffraction(const DiffractionTask* tasks, int count, int posts, const ExcessGrid& grid, int row,
                     const ScratchMemory& scratch, cudaStream_t stream) {
  const auto columns = static_cast<unsigned>(grid.column_count);
  othersKernel<<<dim3((columns + kColumnThreads - 1) / kColumnThreads, static_cast<unsigned>(count)),
                 kColumnThreads, 0, stream>>>(tasks, grid);
  emscape::cuda::checkLaunch("losses besides diffraction");
  const WarpTiles tiles(grid, row, count);
  const PathMemory memory(scratch, posts);
  emscape::cuda::check(cudaFuncSetAttribute(diffractionKernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                            static_cast<int>(memory.sharedBytes())),
                       "cudaFuncSetAttribute");
  diffractionKernel<<<tiles.blocks(memory.mostBlocks()), kColumnThreads, memory.sharedBytes(), stream>>>(
      tasks, grid, tiles, memory);
  emscape::cuda::checkLaunch("diffraction");
}

}  // namespace emscape::emfield::cuda
