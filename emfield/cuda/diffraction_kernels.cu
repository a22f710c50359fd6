// `diffraction` on the device: a thread a column, which reads its posts again for some receivers at a time
// and stores none.
//
// The first pass over a path's posts gives the steepest slope from the transmitter, and the slope of the line
// of sight above which every post is clear: nu of a post falls linearly with the receiver's height. Only
// receivers below that, or not clear of the smooth earth, are computed; the others have no loss. Few
// receivers, as those of a map, take one pass. The same formulas as propagation/diffraction/excess.cpp.

#include <algorithm>
#include <cstdint>

#include "base/cuda/cuda_memory.h"
#include "emfield/cuda/column_posts.h"
#include "emfield/cuda/column_tiles.h"

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

/// Bullington's nu over a smooth earth with posts at the same ranges, as propagation::bullingtonNu. A
/// separate call.
/// @param heights  of the antennas above it
__device__ __noinline__ float smoothEarthNu(const DiffractionModel<float>& model, ColumnPosts& posts,
                                            float distance_m, const EffectiveHeights<float>& heights) {
  const float k = model.half_curvature, d = distance_m, tx_m = heights.tx_m, rx_m = heights.rx_m;
  // Largest slope from an antenna: at its horizon, that is at one of the posts on either side of it.
  const auto largest = [](const PostsAround& around, const auto& slopeAt) {
    return fmaxf(around.before_m > 0 ? slopeAt(around.before_m) : -HUGE_VALF,
                 around.after_m < HUGE_VALF ? slopeAt(around.after_m) : -HUGE_VALF);
  };
  const float tx_slope = largest(posts.around(std::sqrt(tx_m / k)),
                                 [=](float range_m) { return k * (d - range_m) - tx_m / range_m; });
  const float slope_to_rx = (rx_m - tx_m) / d;
  if (tx_slope >= slope_to_rx) {
    const float rx_slope = largest(posts.around(fmaxf(d - std::sqrt(rx_m / k), 0)),
                                   [=](float range_m) { return k * range_m - rx_m / (d - range_m); });
    return bullingtonEdgeNu(model, d, slope_to_rx, tx_slope, rx_slope);
  }
  // The square of the clearance over d1 d2 has a single minimum between antennas that are not below ground:
  // where its logarithm's derivative changes its sign.
  float nearer_m = 0, farther_m = d;
  for (int i = 0; i < 24; ++i) {
    const float at_m = (nearer_m + farther_m) / 2, beyond_m = d - at_m;
    const float clearance_m = tx_m + slope_to_rx * at_m - k * at_m * beyond_m;
    const float rise = slope_to_rx - k * (beyond_m - at_m);
    const bool falls = 2 * rise * at_m * beyond_m < clearance_m * (beyond_m - at_m);
    nearer_m = falls ? at_m : nearer_m;
    farther_m = falls ? farther_m : at_m;
  }
  return largest(posts.around(nearer_m), [=](float range_m) {
    const float beyond_m = d - range_m;
    return -(tx_m + slope_to_rx * range_m - k * range_m * beyond_m) *
           std::sqrt(2 * d / (model.earth.wavelength_m * range_m * beyond_m));
  });
}

/// The receivers over the end of a path. Heights are above the first post unless stated otherwise; "plain"
/// values leave out the earth's bulge.
class Receivers {
 public:
  __device__ Receivers(const DiffractionTask& task, ColumnPosts& posts, const FastInverse& path,
                       float ground_msl_m)
      : task_(task),
        posts_(posts),
        base_msl_m_(groundAt(task.station, task.ground, {0, path.sin_azimuth, path.cos_azimuth})),
        distance_m_(static_cast<float>(path.distance_m)),
        ground_m_(ground_msl_m - base_msl_m_),
        tx_m_(DiffractionModel<float>::raised_m(task.model.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / task.model.model.earth.wavelength_m)),
        half_curvature_(task.model.model.half_curvature),
        sea_fraction_(task.model.model.earth.sea_fraction) {}

  /// Of a receiver.
  struct Maxima {
    float edge = -HUGE_VALF;  ///< slope from it, of one below the steepest ray; else height over sqrt(d1 d2)
    float plain_rx_slope = -HUGE_VALF, plain_height_m = -HUGE_VALF;
  };

  __device__ float receiver_m(float rx_msl_m) const {
    return DiffractionModel<float>::raised_m(rx_msl_m - base_msl_m_, ground_m_);
  }

  /// The first pass.
  /// @param lowest_m  of the lowest receiver
  /// @param rx_m      of receivers whose maxima are found, too
  /// @return false if terrain is missing along the profile
  template <int kReceivers>
  __device__ bool survey(float lowest_m, const float* rx_m, Maxima* most) {
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    has_earth_ =
        !isClearThroughout(earth, distance_m_, sightLine(earth, distance_m_, tx_m_, lowest_m - ground_m_));
    const bool for_any = __any_sync(__activemask(), has_earth_);  // one loop for all threads
    return for_any ? pass<kReceivers, true, true>(rx_m, most) : pass<kReceivers, true, false>(rx_m, most);
  }
  /// Finds the maxima of receivers, lowest first.
  /// With increasing height of the receiver, the post of each maximum only moves toward the transmitter:
  /// posts beyond those of the receivers before need not be visited again, while the measure is the same.
  template <int kReceivers>
  __device__ void find(const float* rx_m, Maxima* most) {
    const bool is_below = slopeTo(rx_m[kReceivers - 1]) <= tx_slope_;
    const bool is_above = slopeTo(rx_m[0]) > tx_slope_;
    if (!(is_below || (is_above && was_above_))) limit_m_ = HUGE_VALF;
    was_above_ = is_above;
    const bool in_earth = isInEarth(rx_m[0]) && slopeTo(rx_m[0]) < plain_tx_slope_;
    if (__any_sync(__activemask(), in_earth)) {
      pass<kReceivers, false, true>(rx_m, most);
    } else {
      pass<kReceivers, false, false>(rx_m, most);
    }
  }

  __device__ bool isLossy(float rx_m) const { return slopeTo(rx_m) < clear_slope_ || isInEarth(rx_m); }

  /// @see P.526-15 eq. (68)
  __device__ float lossDb(float rx_m, const Maxima& most) const {
    const float above = tx_slope_ - slopeTo(rx_m);
    const float relative = above >= 0 ? std::sqrt(fmaxf(above * most.edge, 0)) : most.edge;
    const float loss_db = propagation::bullingtonLossDb(edge_scale_ * relative, distance_m_);
    return isInEarth(rx_m) ? loss_db + earthCorrectionDb(rx_m, most) : loss_db;
  }

 private:
  __device__ float slopeTo(float rx_m) const { return (rx_m - tx_m_) / distance_m_; }

  /// @tparam kSurvey  finds what is the same for all receivers
  /// @tparam kEarth   also for the smooth earth
  template <int kReceivers, bool kSurvey, bool kEarth>
  __device__ __noinline__ bool pass(const float* rx_m, Maxima* most) {
    constexpr int kRoom = kReceivers > 0 ? kReceivers : 1;
    constexpr bool kOrdered = kSurvey && kEarth;
    constexpr bool kBoth = kSurvey && kReceivers > 0;  // it is not known which are below the steepest ray
    const float clearance = -propagation::kKnifeEdgeClear<float> / edge_scale_;
    const float d = distance_m_, base_msl_m = base_msl_m_, tx_m = tx_m_, half_curvature = half_curvature_;
    float slope[kRoom], edge[kRoom], nearest[kRoom], plain_rx[kRoom], plain[kRoom];
    bool is_below[kRoom];
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) {
      slope[j] = slopeTo(rx_m[j]);
      is_below[j] = slope[j] <= tx_slope_;
    }
    float tx, clear, plain_tx, unknown, v1, v2, sea_m;
    PathPost before{};
    float v1_rest, v2_rest;  // of the sums' rounding
    const auto add = [](float term, float& sum, float& rest) {
      const float more = term - rest, next = sum + more;
      rest = (next - sum) - more;
      sum = next;
    };
    const auto addToTrend = [&](const PathPost& to) {  // as propagation::TerrainSums
      const float length_m = to.range_m - before.range_m;
      const float from_m = before.height_msl_m - base_msl_m, to_m = to.height_msl_m - base_msl_m;
      add(length_m * (from_m + to_m), v1, v1_rest);
      add(length_m * (to_m * (2 * to.range_m + before.range_m) + from_m * (to.range_m + 2 * before.range_m)),
          v2, v2_rest);
      sea_m =
          fmaf(length_m, (before.height_msl_m <= 0 ? 0.5f : 0) + (to.height_msl_m <= 0 ? 0.5f : 0), sea_m);
      before = to;
    };
    bool is_whole;
    float edge_at_m = 0, plain_rx_at_m = 0, plain_at_m = 0;  // of the last receiver
    do {
      tx = clear = plain_tx = -HUGE_VALF;
      unknown = base_msl_m - base_msl_m + (ground_m_ - ground_m_);
      v1 = v2 = v1_rest = v2_rest = sea_m = 0;
      before = {0, base_msl_m};
#pragma unroll
      for (int j = 0; j < kReceivers; ++j) edge[j] = nearest[j] = plain_rx[j] = plain[j] = -HUGE_VALF;
      is_whole = posts_.each<kOrdered>(kSurvey ? HUGE_VALF : limit_m_, [&](const PathPost& post) {
        const float range = post.range_m, beyond = d - range, product = range * beyond;
        float root;
        asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(root) : "f"(product));
        const float above = post.height_msl_m - base_msl_m - tx_m;
        const float bulged = fmaf(half_curvature, product, above);
        if constexpr (kSurvey) {
          unknown += post.height_msl_m - post.height_msl_m;
          const float per_range = beyond * root;
          tx = fmaxf(tx, per_range * (bulged * root));
          clear = fmaxf(clear, per_range * fmaf(bulged, root, clearance));
          if constexpr (kEarth) {
            plain_tx = fmaxf(plain_tx, per_range * (above * root));
            addToTrend(post);
          }
        }
        const float per_beyond = root * root * range, bend = half_curvature * range;
#pragma unroll
        for (int j = 0; j < kReceivers; ++j) {
          const float above_line = fmaf(-slope[j], range, bulged);
          const float from_rx = above_line * (kBoth || is_below[j] ? per_beyond : root);
          if (!kSurvey && j == kReceivers - 1 && from_rx > edge[j]) edge_at_m = range;
          edge[j] = fmaxf(edge[j], from_rx);
          if constexpr (kBoth) nearest[j] = fmaxf(nearest[j], above_line * root);
          if constexpr (kEarth) {  // read of those below the steepest plain ray, and so below the
                                   // steepest one
            const float plain_above = fmaf(-slope[j], range, above);
            if (!kSurvey && j == kReceivers - 1) {
              if (from_rx - bend > plain_rx[j]) plain_rx_at_m = range;
              if (plain_above > plain[j]) plain_at_m = range;
            }
            plain_rx[j] = fmaxf(plain_rx[j], from_rx - bend);
            plain[j] = fmaxf(plain[j], plain_above);
          }
        }
      });
    } while (!is_whole);
    if constexpr (kSurvey) {
      tx_slope_ = tx;
      clear_slope_ = clear;
      plain_tx_slope_ = plain_tx;
      if constexpr (kEarth) {
        addToTrend({d, ground_m_ + base_msl_m});
        const propagation::TerrainSums sums{static_cast<double>(v1), static_cast<double>(v2)};
        trend_start_m_ = static_cast<float>(sums.start_m(static_cast<double>(d)));
        trend_end_m_ = static_cast<float>(sums.end_m(static_cast<double>(d)));
        if (task_.model.model.sea_by_height) sea_fraction_ = sea_m / d;
      }
    }
    if constexpr (!kSurvey) {
      limit_m_ = edge_at_m;
      if constexpr (kEarth) limit_m_ = fmaxf(limit_m_, fmaxf(plain_rx_at_m, plain_at_m));
    }
#pragma unroll
    for (int j = 0; j < kReceivers; ++j) {
      most[j].edge = kBoth && !(slope[j] <= tx) ? nearest[j] : edge[j];
      most[j].plain_rx_slope = plain_rx[j];
      most[j].plain_height_m = plain[j];
    }
    return unknown == 0;
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
  /// False if the smooth earth has no loss for a receiver and those above; see LaneColumn.
  __device__ bool isInEarth(float rx_m) const {
    if (!has_earth_) return false;
    const EffectiveHeights<float> least = effectiveHeights(trend(), tx_m_, rx_m);
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    return !isClearThroughout(earth, distance_m_, sightLine(earth, distance_m_, least.tx_m, least.rx_m));
  }
  /// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
  __device__ float earthCorrectionDb(float rx_m, const Maxima& most) const {
    TerrainTrend<float> over = trend();
    over.highest_m = most.plain_height_m;
    over.tx_angle = plain_tx_slope_ - slopeTo(rx_m);
    over.rx_angle = most.plain_rx_slope;
    const EffectiveHeights<float> heights = effectiveHeights(over, tx_m_, rx_m);
    propagation::SphericalEarth<float> earth = task_.model.model.earth;
    earth.sea_fraction = sea_fraction_;
    const float spherical_db = sphericalEarthLossDb(earth, distance_m_, heights.tx_m, heights.rx_m);
    if (!(spherical_db > 0)) return 0;
    const float nu = smoothEarthNu(task_.model.model, posts_, distance_m_, heights);
    return fmaxf(spherical_db - propagation::bullingtonLossDb(nu, distance_m_), 0);
  }

  const DiffractionTask& task_;
  ColumnPosts& posts_;
  float base_msl_m_, distance_m_, ground_m_, tx_m_;
  float edge_scale_;  ///< from heights over sqrt(d1 d2) to nu
  float half_curvature_, sea_fraction_;
  float limit_m_ = HUGE_VALF;          ///< see find()
  bool was_above_ = false;             ///< the receivers before are above the steepest ray
  bool has_earth_ = false;             ///< the ground alone does not prove that the smooth earth has no loss
  float tx_slope_ = -HUGE_VALF;        ///< largest slope from the transmitter to an obstacle
  float clear_slope_ = -HUGE_VALF;     ///< of the lowest line of sight that all obstacles are clear of
  float plain_tx_slope_ = -HUGE_VALF;  ///< tx_slope without the earth's bulge
  float trend_start_m_ = 0, trend_end_m_ = 0;  ///< the line fitted to the terrain, with has_earth_
};

/// A segment of a column.
/// @tparam kReceivers  at a time
/// @tparam kOnePass    without a pass for all receivers
template <int kReceivers, bool kOnePass>
__device__ void fillSegment(const DiffractionTask& task, const ExcessGrid& grid, int c, int segment) {
  const auto column_index = static_cast<std::size_t>(c);
  const auto set = [&](int k, float excess_db) {
    task.to.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + column_index, excess_db);
  };
  const int end = grid.firstLayer(segment + 1);
  int k = max(grid.firstValid(column_index), grid.firstLayer(segment));
  if (k >= end) return;
  const GridColumn column = grid.columns[column_index];
  const FastInverse path = grid.coordinatesOf(task.station, column_index, segment);
  const float ground_msl_m =
      grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(task.station, task.ground, path);
  const propagation::AirColumn air(task.air, static_cast<float>(path.distance_m));
  const auto heightOf = [&](int layer) {
    return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[min(layer, end - 1)])));
  };
  const auto addOthers = [&](int layer, float loss_db) {
    if (!task.air.isClear()) loss_db += air.lossDb(heightOf(layer));
    if (task.terminal.isSet())
      loss_db += task.terminal.lossDb(static_cast<float>(path.distance_m), heightOf(layer) - ground_msl_m);
    set(layer, loss_db);
  };
  if (path.distance_m > 0) {  // not at the emitter itself
    ColumnPosts posts(task.station, task.ground, path, task.at_crossings);
    Receivers receivers(task, posts, path, ground_msl_m);
    typename Receivers::Maxima most[kReceivers];
    float rx_m[kReceivers];
    const auto setReceivers = [&] {
#pragma unroll
      for (int j = 0; j < kReceivers; ++j) {
        const float height_msl_m = heightOf(k + j);
        rx_m[j] = receivers.receiver_m(task.station.refraction.exponential
                                           ? effectiveHeight_m(task.station, height_msl_m, path.distance_m)
                                           : height_msl_m);
      }
    };
    setReceivers();
    bool is_known = true;
    if constexpr (!kOnePass) is_known = receivers.survey<0>(rx_m[0], rx_m, most);
    while (k < end && is_known) {
      if constexpr (kOnePass) {
        is_known = receivers.survey<kReceivers>(rx_m[0], rx_m, most);
        if (!is_known) break;
      } else {
        if (!receivers.isLossy(rx_m[0])) break;
        receivers.find<kReceivers>(rx_m, most);
      }
#pragma unroll 1
      for (int j = 0; j < kReceivers && k + j < end; ++j) {
        addOthers(k + j, receivers.isLossy(rx_m[j]) ? receivers.lossDb(rx_m[j], most[j]) : 0);
      }
      k += kReceivers;
      setReceivers();
    }
    if (!is_known) {
      for (; k < end; ++k) set(k, NAN);
      markUnknown(task.to, c);
    }
  }
  if (task.air.isClear() && !task.terminal.isSet()) {
    const ExcessStore to = task.to.out.excess;
    std::size_t voxel = static_cast<std::size_t>(k) * grid.column_count + column_index;
    for (; k < end; ++k, voxel += grid.column_count) to.set(voxel, 0);
  }
  for (; k < end; ++k) addOthers(k, 0);
}

// Fewer registers, for more threads at a time, take more time.
template <int kReceivers, bool kOnePass>
__global__ void __launch_bounds__(kColumnThreads, 4)
    diffractionKernel(const DiffractionTask* tasks, const __grid_constant__ ExcessGrid grid,
                      const __grid_constant__ Tiles tiles) {
  tiles.eachColumn(grid, [&](int number, int c, int) {
    const DiffractionTask& task = tasks[number];
    const auto column = static_cast<std::size_t>(c);
    const bool is_unknown = grid.isWithoutGround(column);
    const int lowest = grid.firstValid(column);
    for (int k = 0; k < (is_unknown ? grid.layers : lowest); ++k)
      task.to.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + column, k < lowest ? 0 : NAN);
    if (is_unknown) return markUnknown(task.to, c);
    for (int segment = 0; segment < grid.segments; ++segment)
      fillSegment<kReceivers, kOnePass>(task, grid, c, segment);
  });
}

}  // namespace

void fillDiffraction(const DiffractionTask* tasks, int count, const ExcessGrid& grid, int row,
                     cudaStream_t stream) {
  const Tiles tiles(grid, row, count);
  const auto launch = [&](auto kernel) {
    kernel<<<static_cast<unsigned>(tiles.count()), kColumnThreads, 0, stream>>>(tasks, grid, tiles);
  };
  if (grid.layers == 1) {
    launch(diffractionKernel<1, true>);
  } else if (grid.layers <= 16 && grid.every_height) {
    launch(diffractionKernel<4, true>);
  } else {
    launch(diffractionKernel<8, false>);
  }
  emscape::cuda::checkLaunch("diffraction");
}

}  // namespace emscape::emfield::cuda
