// `itm` on the device: a warp a column. Its lanes share the posts of the profile, of which each height needs
// sums and maxima; then each of them has a height. The heights are those of fillByBisection(), all intervals
// of a size together.

#include <algorithm>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_tiles.h"
#include "emfield/cuda/itm_kernels.h"

namespace emscape::emfield::cuda {
namespace {

using namespace propagation::itm_detail;
using propagation::drawLine;
using propagation::isStraight;
using propagation::ItmExcess;
using propagation::ItmPath;
using propagation::ItmProfile;
using propagation::ItmResult;
using propagation::ItmStatus;
using propagation::kBisectionStep;
using propagation::kItmRefused;

constexpr int kWarp = 32;
constexpr unsigned kAll = ~0u;

__device__ int laneOf() {
  return static_cast<int>(threadIdx.x) % kWarp;
}
/// The same in all lanes.
template <class Combine>
__device__ float ofAllLanes(float value, const Combine& combine) {
#pragma unroll
  for (int apart = kWarp / 2; apart > 0; apart /= 2)
    value = combine(value, __shfl_xor_sync(kAll, value, apart));
  return value;
}
__device__ float sumOfLanes(float value) {
  return ofAllLanes(value, [](float a, float b) { return a + b; });
}
/// As itm_detail::ProfileStatistics, by all lanes of a warp.
class WarpStatistics {
 public:
  __device__ explicit WarpStatistics(const ItmProfile<float>& profile) : profile_(profile), lane_(laneOf()) {
    bool is_known = true;
    for (int i = lane_; i <= profile.intervals; i += kWarp)
      is_known = is_known && profile.heights_msl_m[i] - profile.heights_msl_m[i] == 0;
    has_every_height_ = __all_sync(kAll, is_known) != 0;
  }
  __device__ bool hasEveryHeight() const { return has_every_height_; }
  __device__ float meanHeight_m() const {
    const int tenth = static_cast<int>(0.1 * profile_.intervals), last = profile_.intervals - tenth;
    const float base_m = profile_.heights_msl_m[tenth];
    return base_m + sums(tenth, last, base_m, 0).plain / static_cast<float>(last - tenth + 1);
  }
  __device__ HorizonDistances findHorizons(ItmPath<float>& path) {
    const int last = profile_.intervals;
    const float half_curvature = 1 / (2 * path.effective_earth_radius_m);
    if (transmitter_.post < 0)
      transmitter_ =
          steepest(profile_.heights_msl_m[0] + path.terminal[0].height_agl_m, half_curvature, false);
    const HorizonPost receiver =
        steepest(profile_.heights_msl_m[last] + path.terminal[1].height_agl_m, half_curvature, true);
    return setHorizons(profile_, path, transmitter_, rangeOf(transmitter_.post), receiver,
                       rangeOf(last - receiver.post));
  }
  __device__ float irregularityBetween_m(double begin_m, double end_m) {
    if (begin_m == begin_m_ && end_m == end_m_) return irregularity_m_;
    begin_m_ = begin_m;
    end_m_ = end_m;
    const double begin = begin_m / profile_.step_m, end = end_m / profile_.step_m;
    irregularity_m_ =
        end - begin >= 2 ? irregularityOf_m(interdecileRange_m({profile_, begin, end}), begin_m, end_m) : 0;
    return irregularity_m_;
  }
  __device__ __noinline__ FittedLine<float> fitLine(double begin, double end) const {
    const PostRange posts(profile_.intervals, begin, end);
    const float base_m = profile_.heights_msl_m[posts.first];
    return lineOf(posts, profile_.intervals, base_m,
                  sums(posts.first, posts.last, base_m, posts.center<float>()),
                  profile_.heights_msl_m[posts.last] - base_m);
  }

 private:
  using Sampled = SampledProfile<float, float>;

  __device__ float rangeOf(int post) const { return static_cast<float>(post * profile_.step_m); }
  __device__ HeightSums<float> sums(int first, int last, float base_m, float center) const {
    HeightSums<float> of_lane{};
    for (int i = first + lane_; i <= last; i += kWarp) {
      const float height_m = profile_.heights_msl_m[i] - base_m;
      of_lane.plain += height_m;
      of_lane.weighted += height_m * (static_cast<float>(i) - center);
    }
    return {sumOfLanes(of_lane.plain), sumOfLanes(of_lane.weighted)};
  }
  __device__ __noinline__ HorizonPost steepest(float from_m, float half_curvature, bool from_receiver) const {
    const int last = profile_.intervals;
    HorizonPost found{last, -HUGE_VALF, 0};
    for (int i = 1 + lane_; i < last; i += kWarp) {
      const float range_m = rangeOf(from_receiver ? last - i : i);
      const float slope = (profile_.heights_msl_m[i] - from_m - range_m * range_m * half_curvature) / range_m;
      found.post = slope > found.slope ? i : found.post;
      found.slope = fmaxf(slope, found.slope);
    }
    const float highest = ofAllLanes(found.slope, [](float a, float b) { return fmaxf(a, b); });
    found.post = __reduce_min_sync(kAll, found.slope == highest ? found.post : last);
    found.slope = highest;
    const float range_m = rangeOf(from_receiver ? last - found.post : found.post);
    found.rise_m = profile_.heights_msl_m[found.post] - from_m - range_m * range_m * half_curvature;
    return found;
  }
  /// Difference of the tenth-th largest and the tenth-th smallest sample above the line fitted to them.
  __device__ float interdecileRange_m(const Sampled& sampled) const {
    constexpr int kOfLane = (Sampled::kMostSamples + kWarp - 1) / kWarp;
    const int count = sampled.count(), last = count - 1;
    float above_m[kOfLane], last_m = 0;
#pragma unroll
    for (int n = 0; n < kOfLane; ++n) {
      const int i = n * kWarp + lane_;
      above_m[n] = i < last ? sampled.at(i) : 0;
      if (i == last) last_m = above_m[n] = sampled.last();
    }
    const PostRange posts(last, 0, last);
    const float base_m = __shfl_sync(kAll, above_m[0], 0), center = posts.center<float>();
    HeightSums<float> of_lane{};
#pragma unroll
    for (int n = 0; n < kOfLane; ++n) {
      const int i = n * kWarp + lane_;
      if (i > last) continue;
      of_lane.plain += above_m[n] - base_m;
      of_lane.weighted += (above_m[n] - base_m) * (static_cast<float>(i) - center);
    }
    const FittedLine<float> line =
        lineOf(posts, last, base_m, {sumOfLanes(of_lane.plain), sumOfLanes(of_lane.weighted)},
               __shfl_sync(kAll, last_m, last % kWarp) - base_m);
    const float slope_m = (line.at_end_m - line.at_start_m) / static_cast<float>(last);
    float least_m = HUGE_VALF, most_m = -HUGE_VALF;
#pragma unroll
    for (int n = 0; n < kOfLane; ++n) {
      const int i = n * kWarp + lane_;
      above_m[n] -= line.at_start_m + slope_m * static_cast<float>(i);
      least_m = i > last ? least_m : fminf(least_m, above_m[n]);
      most_m = i > last ? most_m : fmaxf(most_m, above_m[n]);
    }
    least_m = ofAllLanes(least_m, [](float a, float b) { return fminf(a, b); });
    most_m = ofAllLanes(most_m, [](float a, float b) { return fmaxf(a, b); });
    constexpr float kFlat_m = 1e-6f;
    if (!(most_m - least_m > kFlat_m)) return 0;
    constexpr int kBits = 16;  // a step of millimetres
    const float steps_per_m = ((1 << kBits) - 1) / (most_m - least_m);
    unsigned steps[kOfLane];
#pragma unroll
    for (int n = 0; n < kOfLane; ++n)
      steps[n] = n * kWarp + lane_ > last
                     ? ~0u
                     : static_cast<unsigned>(__float2int_rn((above_m[n] - least_m) * steps_per_m));
    // The largest numbers below which there are at most as many samples as the rank, bit by bit.
    const unsigned low_rank = sampled.tenth() - 1, high_rank = count - sampled.tenth();
    unsigned low = 0, high = 0;
#pragma unroll 1
    for (unsigned bit = 1u << (kBits - 1); bit != 0; bit >>= 1) {
      unsigned below_low = 0, below_high = 0;
#pragma unroll
      for (int n = 0; n < kOfLane; ++n) {
        below_low += steps[n] < (low | bit) ? 1 : 0;
        below_high += steps[n] < (high | bit) ? 1 : 0;
      }
      const unsigned below = __reduce_add_sync(kAll, below_low | below_high << 16);
      if ((below & 0xffffu) <= low_rank) low |= bit;
      if (below >> 16 <= high_rank) high |= bit;
    }
    return static_cast<float>(high - low) / steps_per_m;
  }

  const ItmProfile<float> profile_;
  int lane_;
  bool has_every_height_;
  HorizonPost transmitter_;
  double begin_m_ = NAN, end_m_ = NAN;
  float irregularity_m_ = 0;
};

/// Memory of the columns in progress, of a warp each.
class WarpMemory {
 public:
  WarpMemory(const ScratchMemory& memory, int posts, int layers)
      : memory_(static_cast<char*>(memory.data)), posts_(posts), layers_(layers) {
    constexpr std::size_t kAlignment = alignof(double);
    bytes_each_ = (ExcessScratch::bytes(posts, layers) + kAlignment - 1) / kAlignment * kAlignment;
    constexpr int kWarps = kColumnThreads / kWarp;
    blocks_ = static_cast<int>(std::min<std::size_t>(memory.bytes / bytes_each_ / kWarps, 1 << 20));
    if (blocks_ == 0) throwTooSmall(bytes_each_, memory.bytes);
  }
  int blocks() const { return blocks_; }
  __device__ ExcessScratch of(long long warp) const {
    return ExcessScratch::in(memory_ + warp * bytes_each_, posts_, layers_);
  }

 private:
  char* memory_;
  std::size_t bytes_each_;
  int blocks_, posts_, layers_;
};

/// As ExcessTask::readSegment(), by all lanes of a warp.
__device__ propagation::ExcessColumn readColumn(const ExcessTask<ItmExcess>& task, std::size_t c, int segment,
                                                const ExcessScratch& scratch) {
  const int lane = laneOf();
  const ExcessGrid& grid = task.grid;
  const GroundPosts& ground = task.ground;
  const FastInverse point = grid.coordinatesOf(task.station, c, segment);
  const int first = grid.firstLayer(segment);
  propagation::ExcessColumn column;
  column.position = c;
  column.range_m = point.distance_m;
  column.ground_msl_m =
      grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(task.station, ground, point);
  column.height_msl_m = scratch.height_msl_m;
  column.count = grid.firstLayer(segment + 1) - first;
  column.every_height = grid.every_height;
  const GridColumn of_grid = grid.columns[c];
  for (int k = lane; k < column.count; k += kWarp)
    scratch.height_msl_m[k] =
        static_cast<float>(heightMsl_m(of_grid, static_cast<double>(grid.t_m[first + k])));

  const int nearer = ground.lastBefore(point.distance_m) + 1, last = point.distance_m > 0 ? nearer : 0;
  TerrainWalk walk(task.station, ground.terrain, point);
  for (int i = lane; i < nearer; i += kWarp) {
    scratch.range_m[i] = ground.ranges_m[i];
    scratch.ground_msl_m[i] = ground.is_smooth ? 0 : walk.heightAt(ground.ranges_m[i]);
  }
  __syncwarp();
  int count = last + 1;
  if (lane == 0 && last > 0) {
    scratch.range_m[last] = point.distance_m;
    scratch.ground_msl_m[last] = column.ground_msl_m;
    if (ground.has_clutter)
      count = addClutterPosts(task.station, ground, point, count, scratch.range_m, scratch.ground_msl_m);
  }
  count = __shfl_sync(kAll, count, 0);
  __syncwarp();
  column.profile = {scratch.range_m, scratch.ground_msl_m, count};
  if (!ground.is_smooth && ground.terrain.hasCover() && ground.is_raised) {
    TerrainWalk again(task.station, ground.terrain, point);
    for (int i = lane; i < count; i += kWarp) {
      if (!isClutterAt(scratch.range_m[i], point.distance_m)) continue;
      const float cover_m = coverHeightAt(again, ground, scratch.range_m[i], scratch.ground_msl_m[i]);
      if (cover_m > 0) scratch.ground_msl_m[i] += cover_m;
    }
  }
  __syncwarp();
  return column;
}

/// Fills ExcessScratch::even_ground_msl_m.
__device__ void spaceEvenly(const propagation::TerrainProfile& profile, int intervals, float* heights_msl_m) {
  const int last = profile.count - 1;
  const double length_m = profile.range_m[last];
  for (int i = laneOf(); i <= intervals; i += kWarp) {
    const double at_m = length_m * i / intervals;
    int after = 1, end = last;  // the first post from at_m on
    while (after < end) {
      const int middle = (after + end) / 2;
      const bool is_before = profile.range_m[middle] < at_m;
      after = is_before ? middle + 1 : after;
      end = is_before ? end : middle;
    }
    const double before_m = profile.range_m[after - 1];
    const auto part = static_cast<float>((at_m - before_m) / (profile.range_m[after] - before_m));
    const float before = profile.height_msl_m[after - 1];
    heights_msl_m[i] = before + part * (profile.height_msl_m[after] - before);
  }
  __syncwarp();
}

/// The excess of ITM alone at a column's lowest heights.
/// @tparam kArea  area mode
template <bool kArea>
class ItmHeights {
 public:
  __device__ ItmHeights(const ItmExcess& model, const propagation::ExcessColumn& column,
                        const ItmProfile<float>& even, float* itm_db)
      : model_(model), column_(column), even_(even), statistics_(even), itm_db_(itm_db) {
    const auto& link = model.link;
    if (kArea || !statistics_.hasEveryHeight()) return;
    itmSetMedium(medium_, link.frequency_hz, link.vertical_polarization, link.relative_permittivity,
                 link.conductivity_s_m, link.sea_level_refractivity, statistics_.meanHeight_m());
  }
  /// @param count      of the heights
  /// @param intervals  memory for `count` numbers
  /// @return warnings of the lane's heights
  __device__ unsigned fill(int count, unsigned* intervals) {
    const int lane = laneOf();
    const float tolerance_db = column_.tolerance_db(ItmExcess::kTolerance_db);
    const auto endOf = [=](int n) { return min(n * kBisectionStep, count - 1); };
    const int ends = (count + kBisectionStep - 2) / kBisectionStep + 1;
    unsigned *open = intervals, *next = intervals + count / 2;
    int open_count = 0;
    const auto push = [lane](unsigned* to, int& size, bool has, int from, int end) {
      const unsigned lanes = __ballot_sync(kAll, has);
      if (has) to[size + __popc(lanes & ((1u << lane) - 1))] = static_cast<unsigned>(from) << 16 | end;
      size += __popc(lanes);
    };
    // At first all ends with the middles between them, which are always needed.
    for (int n = lane; n - lane < ends; n += kWarp) {
      const int from = endOf(n), end = endOf(n + 1), middle = (from + end) / 2;
      push(open, open_count, n < ends, from, from);
      push(open, open_count, n < ends && middle > from, middle, middle);
    }
    for (bool is_first = true; open_count > 0; is_first = false) {
      __syncwarp();
      evaluate(open_count, open);
      if (is_first) {
        open_count = 0;
        for (int n = lane; n - lane < ends - 1; n += kWarp) {
          const int from = endOf(n), end = endOf(n + 1);
          push(open, open_count, n < ends - 1 && end - from >= 2, from, end);
        }
        __syncwarp();
      }
      int next_count = 0;
      for (int n = lane; n - lane < open_count; n += kWarp) {
        const bool is_interval = n < open_count;
        const int from = is_interval ? open[n] >> 16 : 0, end = is_interval ? open[n] & 0xffffu : 0;
        const int middle = (from + end) / 2;
        const bool is_done = !is_interval || isStraight(itm_db_, from, middle, end, tolerance_db);
        if (is_interval && is_done) {
          drawLine(itm_db_, from, middle);
          drawLine(itm_db_, middle, end);
        }
        push(next, next_count, !is_done && middle - from >= 2, from, middle);
        push(next, next_count, !is_done && end - middle >= 2, middle, end);
      }
      unsigned* const done = open;
      open = next;
      next = done;
      open_count = next_count;
    }
    return warnings_;
  }

 private:
  /// @param intervals  from and to in 16 bits each, of whose middles
  __device__ void evaluate(int count, const unsigned* intervals) {
    const int lane = laneOf();
    const auto heightOf = [=](int n) {
      return static_cast<int>((intervals[n] >> 16) + (intervals[n] & 0xffffu)) / 2;
    };
    const auto linkTo = [&](int n) {
      return model_.linkTo(column_, ItmExcess::heightAgl(column_, heightOf(n)));
    };
    for (int first = 0; first < count; first += kWarp) {
      ItmPath<float> path;
      const int end = kArea || !statistics_.hasEveryHeight() ? first : min(first + kWarp, count);
#pragma unroll 1
      for (int n = first; n < end; ++n) {
        const auto link = linkTo(n);
        ItmPath<float> of_height = medium_;
        for (int side = 0; side < 2; ++side) of_height.terminal[side].height_agl_m = link.height_agl_m[side];
        itmSetTerrain(of_height, even_, statistics_);
        if (lane == n - first) path = of_height;
      }
      if (first + lane < count) {
        const ItmResult<float> result = resultOf(linkTo(first + lane), path);
        warnings_ |= result.refused() ? kItmRefused : result.warnings;
        itm_db_[heightOf(first + lane)] = result.loss_db - result.free_space_db;
      }
      __syncwarp();
    }
  }
  __device__ ItmResult<float> resultOf(const propagation::ItmLink<float>& link,
                                       const ItmPath<float>& path) const {
    if constexpr (kArea) {
      return itmAreaMode(model_.areaTo(column_), link, model_.quantiles);
    } else {
      ItmResult<float> result;
      const ItmStatus status = checkInput(link, model_.quantiles, result.warnings);
      if (status != ItmStatus::done) return refuse(result, status);
      if (!(even_.intervals >= 2 && even_.step_m > 0) || !statistics_.hasEveryHeight())
        return refuse(result, ItmStatus::profile);
      result.path = path;
      finish(link, model_.quantiles, result);
      return result;
    }
  }

  const ItmExcess& model_;
  const propagation::ExcessColumn& column_;
  const ItmProfile<float> even_;
  WarpStatistics statistics_;
  ItmPath<float> medium_;
  float* itm_db_;
  unsigned warnings_ = 0;
};

template <bool kArea>
__device__ void fillSegment(const ExcessTask<ItmExcess>& task, const ExcessOutputs& to, std::size_t c,
                            int segment, const ExcessScratch& scratch) {
  const int lane = laneOf();
  const ExcessGrid& grid = task.grid;
  const ItmExcess& model = task.model;
  const int first = grid.firstLayer(segment), last = grid.firstLayer(segment + 1) - 1;
  const auto voxel = [&](int k) { return static_cast<std::size_t>(first + k) * grid.column_count + c; };
  if (grid.isLeftOut(c)) {
    for (int k = lane; k <= last - first; k += kWarp) to.out.excess.set(voxel(k), 0);
    return;
  }
  if (isnan(to.out.excess.get(voxel(last - first)))) {
    if (lane == 0) note(to, static_cast<int>(c), propagation::kMissingTerrain);
    return;
  }
  const propagation::ExcessColumn column = readColumn(task, c, segment, scratch);
  const float weight = model.pathWeight(column);
  int in_zone = 0;
  if (weight > 0) {
    for (int k = lane; k < column.count; k += kWarp) in_zone += ItmExcess::isInZone(column, k) ? 1 : 0;
    in_zone = static_cast<int>(__reduce_add_sync(kAll, static_cast<unsigned>(in_zone)));
  }
  if (in_zone > 0) {
    const ItmProfile<float> even = model.evenProfile(column, scratch);
    spaceEvenly(column.profile, even.intervals, scratch.even_ground_msl_m);
    ItmHeights<kArea> heights(model, column, even, scratch.other_db);
    const unsigned warnings = heights.fill(in_zone, reinterpret_cast<unsigned*>(scratch.excess_db));
    note(to, static_cast<int>(c), warnings);
    __syncwarp();
  }
  const PathEnds ends(task.air, task.terminal, static_cast<float>(column.range_m), column.ground_msl_m);
  if (in_zone == 0 && ends.areFree()) return;
  for (int k = lane; k < column.count; k += kWarp) {
    float excess_db = to.out.excess.get(voxel(k));
    if (k < in_zone) excess_db = model.blended(column, k, weight, scratch.other_db[k], excess_db);
    if (!ends.areFree()) excess_db = ends.added(excess_db, column.height_msl_m[k]);
    to.out.excess.set(voxel(k), excess_db);
  }
  __syncwarp();
}

template <bool kArea>
__global__ void __launch_bounds__(kColumnThreads)
    itmKernel(const __grid_constant__ ExcessTask<ItmExcess> task, const __grid_constant__ ExcessOutputs to,
              const __grid_constant__ WarpMemory memory) {
  const long long warp = (static_cast<long long>(blockIdx.x) * kColumnThreads + threadIdx.x) / kWarp;
  const long long warps = static_cast<long long>(gridDim.x) * kColumnThreads / kWarp;
  const ExcessScratch scratch = memory.of(warp);
  const auto columns = static_cast<long long>(task.grid.column_count);
  for (long long n = warp; n < columns * task.grid.segments; n += warps)
    fillSegment<kArea>(task, to, static_cast<std::size_t>(n % columns), static_cast<int>(n / columns),
                       scratch);
}

}  // namespace

void fillItm(const ExcessTask<ItmExcess>& task, const ExcessOutputs& to, const ScratchMemory& scratch,
             cudaStream_t stream) {
  const WarpMemory memory(scratch, task.posts(), task.grid.layers);
  constexpr long long kWarps = kColumnThreads / kWarp;
  const long long columns = static_cast<long long>(task.grid.column_count) * task.grid.segments;
  const auto blocks =
      static_cast<unsigned>(std::min<long long>(memory.blocks(), (columns + kWarps - 1) / kWarps));
  const auto kernel = task.model.is_area ? itmKernel<true> : itmKernel<false>;
  kernel<<<blocks, kColumnThreads, 0, stream>>>(task, to, memory);
  emscape::cuda::checkLaunch("itm");
}

}  // namespace emscape::emfield::cuda
