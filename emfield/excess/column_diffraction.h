/// `diffraction` over a column of receivers by one thread of the device; also on the host, for tests.
///
/// The first pass over a path's posts gives the steepest slope from the transmitter, and the slope of the
/// line of sight above which every post is clear: nu of a post falls linearly with the receiver's height.
/// Only receivers below that, or not clear of the smooth earth, are computed; the others have no loss. Few
/// receivers, as those of a map, take one pass. Of many the first pass keeps the posts that the others need.
/// The same formulas as propagation/diffraction/excess.cpp.
#pragma once

#include <cmath>

#include "base/math/device_loop.h"
#include "emfield/excess/fill_excess.h"
#include "emfield/ground/column_posts.h"
#include "propagation/diffraction/excess.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::emfield {

/// `diffraction` of one emitter, as plain data.
struct DiffractionTask {
  propagation::DiffractionExcess model;
  AirLoss air;
  Station station;
  GroundPosts ground;
  ExcessOutput out;
  propagation::TerminalClutter terminal = {};
  bool at_crossings = false;  ///< see chord_crossings.h; false: regular posts
  /// See highestPost_m(); infinity where profiles are raised by clutter.
  float highest_msl_m = HUGE_VALF;
};

namespace diffraction_detail {

using propagation::DiffractionModel;
using propagation::EffectiveHeights;
using propagation::TerrainTrend;

/// A separate call, so that its registers are not part of those of the columns.
EMSCAPE_NOINLINE EMSCAPE_HD inline float effectiveHeight_m(const Station& station, float height_msl_m,
                                                           double range_m) {
  return static_cast<float>(
      station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m), station.height_msl_m, range_m));
}

/// A separate call, too.
EMSCAPE_NOINLINE EMSCAPE_HD inline float smoothEarthNu(const DiffractionModel<float>& model,
                                                       ColumnPosts& posts, float distance_m,
                                                       const EffectiveHeights<float>& heights) {
  return propagation::smoothEarthNu(model, distance_m, heights,
                                    [&](float range_m) { return posts.around(range_m); });
}

/// Posts of a path among which are those of all maxima of the receivers at or above the lowest one.
///
/// Each measure of a post seen from a receiver is linear in the slope of the line of sight, and falls faster
/// for farther posts. A post that does not exceed all nearer ones for the lowest receiver therefore exceeds
/// none of them for a higher one. Only such records are kept, of each measure, and fewer for those above some
/// receivers that are done.
class CandidatePosts {
 public:
  static constexpr int kMost = 128;

  /// Measures of the posts so far, seen from the lowest receiver.
  class Records {
   public:
    /// @tparam kPlain  also those without the earth's bulge
    /// @return true if the next post exceeds one
    template <bool kPlain>
    EMSCAPE_HD bool add(const PathPost& post, float line, float plain_line, float root) {
      if (post.range_m < last_m_) *this = {};  // posts come in runs of increasing range
      last_m_ = post.range_m;
      const float per_beyond = root * root * post.range_m;
      const bool exceeds = exceed(line * per_beyond, rx_slope_) | exceed(line * root, nearest_);
      if (!kPlain) return exceeds;
      return exceeds | exceed(plain_line * per_beyond, plain_rx_slope_) | exceed(plain_line, plain_m_);
    }

   private:
    static EMSCAPE_HD bool exceed(float here, float& record) {
      const bool exceeds = here > record;
      record = fmaxf(record, here);
      return exceeds;
    }

    float last_m_ = 0;
    float rx_slope_ = -HUGE_VALF, nearest_ = -HUGE_VALF, plain_rx_slope_ = -HUGE_VALF, plain_m_ = -HUGE_VALF;
  };

  EMSCAPE_HD void clear() { count_ = 0; }
  EMSCAPE_HD void add(const PathPost& post) {
    if (count_ < kMost) posts_[count_] = post;
    ++count_;
  }
  /// False if there was no room for all: they are incomplete.
  EMSCAPE_HD bool areComplete() const { return count_ <= kMost; }
  EMSCAPE_HD int count() const { return count_; }
  EMSCAPE_HD const PathPost& operator[](int i) const { return posts_[i]; }

 private:
  PathPost posts_[kMost];
  int count_ = kMost + 1;  ///< nothing was looked for
};

/// The receivers over the end of a path. Heights are above the first post unless stated otherwise; "plain"
/// values leave out the earth's bulge.
class Receivers {
 public:
  EMSCAPE_HD Receivers(const DiffractionTask& task, ColumnPosts& posts, const FastInverse& path,
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

  EMSCAPE_HD float receiver_m(float rx_msl_m) const {
    return DiffractionModel<float>::raised_m(rx_msl_m - base_msl_m_, ground_m_);
  }

  /// The first pass.
  /// @param lowest_m  of the lowest receiver
  /// @param rx_m      of receivers whose maxima are found, too
  /// @return false if terrain is missing along the profile
  template <int kReceivers>
  EMSCAPE_HD bool survey(float lowest_m, const float* rx_m, Maxima* most) {
    has_earth_ = !isClearThroughout(task_.model.model.earth, distance_m_, tx_m_, lowest_m - ground_m_);
    const float slope = slopeTo(lowest_m);
    const bool for_any = isForAnyLane(has_earth_);  // one loop for all threads
    return for_any ? pass<kReceivers, true, true>(rx_m, slope, most)
                   : pass<kReceivers, true, false>(rx_m, slope, most);
  }
  /// Finds the maxima of receivers, lowest first.
  /// @param next_m  of the next receiver; infinity: there is none
  template <int kReceivers>
  EMSCAPE_HD void find(const float* rx_m, float next_m, Maxima* most) {
    const bool in_earth = isInEarth(rx_m[0]) && slopeTo(rx_m[0]) < plain_tx_slope_;
    if (isForAnyLane(in_earth)) {
      pass<kReceivers, false, true>(rx_m, slopeTo(next_m), most);
    } else {
      pass<kReceivers, false, false>(rx_m, slopeTo(next_m), most);
    }
  }

  EMSCAPE_HD bool isLossy(float rx_m) const { return slopeTo(rx_m) < clear_slope_ || isInEarth(rx_m); }

  /// @see P.526-15 eq. (68)
  EMSCAPE_HD float lossDb(float rx_m, const Maxima& most) const {
    const float above = tx_slope_ - slopeTo(rx_m);
    const float relative = above >= 0 ? std::sqrt(fmaxf(above * most.edge, 0)) : most.edge;
    const float loss_db = propagation::bullingtonLossDb(edge_scale_ * relative, distance_m_);
    return isInEarth(rx_m) ? loss_db + earthCorrectionDb(rx_m, most) : loss_db;
  }

 private:
  EMSCAPE_HD float slopeTo(float rx_m) const { return (rx_m - tx_m_) / distance_m_; }

  /// @tparam kSurvey  finds what is the same for all receivers
  /// @tparam kEarth   also for the smooth earth
  /// @param next_slope  of the line of sight to the lowest receiver of further passes
  template <int kReceivers, bool kSurvey, bool kEarth>
  EMSCAPE_NOINLINE EMSCAPE_HD bool pass(const float* rx_m, float next_slope, Maxima* most) {
    constexpr int kRoom = kReceivers > 0 ? kReceivers : 1;
    constexpr bool kOrdered = kSurvey && kEarth;
    constexpr bool kBoth = kSurvey && kReceivers > 0;  // it is not known which are below the steepest ray
    constexpr bool kKeeps = !kBoth;
    const float clearance = -propagation::kKnifeEdgeClear<float> / edge_scale_;
    const float d = distance_m_, base_msl_m = base_msl_m_, tx_m = tx_m_, half_curvature = half_curvature_;
    float slope[kRoom], edge[kRoom], nearest[kRoom], plain_rx[kRoom], plain[kRoom];
    bool is_below[kRoom];
    EMSCAPE_UNROLL
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
    const int candidates = !kSurvey && candidates_.areComplete() ? candidates_.count() : -1;
    const float nearest_m = kSurvey && !kOrdered ? nearestOfAll_m(next_slope, clearance) : 0;
    CandidatePosts::Records records;
    do {
      tx = clear = plain_tx = -HUGE_VALF;
      unknown = base_msl_m - base_msl_m + (ground_m_ - ground_m_);
      v1 = v2 = v1_rest = v2_rest = sea_m = 0;
      before = {0, base_msl_m};
      records = {};
      if constexpr (kKeeps) candidates_.clear();
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) edge[j] = nearest[j] = plain_rx[j] = plain[j] = -HUGE_VALF;
      const auto visit = [&](const PathPost& post) {
        const float range = post.range_m, beyond = d - range, product = range * beyond;
        const float root = approximateReciprocalRoot(product);
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
        if constexpr (kKeeps) {
          const bool is_record = records.add<kEarth>(post, fmaf(-next_slope, range, bulged),
                                                     fmaf(-next_slope, range, above), root);
          if (is_record) candidates_.add(post);
        }
        EMSCAPE_UNROLL
        for (int j = 0; j < kReceivers; ++j) {
          const float above_line = fmaf(-slope[j], range, bulged);
          const float from_rx = above_line * (kBoth || is_below[j] ? per_beyond : root);
          edge[j] = fmaxf(edge[j], from_rx);
          if constexpr (kBoth) nearest[j] = fmaxf(nearest[j], above_line * root);
          if constexpr (kEarth) {  // read of those below the steepest plain ray, and so below the
                                   // steepest one
            const float plain_above = fmaf(-slope[j], range, above);
            plain_rx[j] = fmaxf(plain_rx[j], from_rx - bend);
            plain[j] = fmaxf(plain[j], plain_above);
          }
        }
      };
      is_whole = candidates >= 0 || posts_.each<kOrdered>(nearest_m, visit);
      for (int i = 0; i < candidates; ++i) {
        const PathPost post = candidates_[i];  // may be overwritten
        visit(post);
      }
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
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      most[j].edge = kBoth && !(slope[j] <= tx) ? nearest[j] : edge[j];
      most[j].plain_rx_slope = plain_rx[j];
      most[j].plain_height_m = plain[j];
    }
    return unknown == 0;
  }

  /// Range of which nearer posts are of no account to receivers in sight of a much higher transmitter: seen
  /// from it they are below the line of sight to the lowest receiver, with the clearance c sqrt(d1 d2) that
  /// is free of loss. With H the height of the highest post over the transmitter and u the root of the range,
  /// H + (d / (2 a) - slope) u^2 + c sqrt(d) u is larger than what such posts lack to that, and rises with u.
  EMSCAPE_HD float nearestOfAll_m(float slope, float clearance) const {
    const float above_m = task_.highest_msl_m - base_msl_m_ - tx_m_;
    if (!(above_m < 0)) return 0;
    const float square = fmaxf(half_curvature_ * distance_m_ - slope, 0);
    const float linear = clearance * std::sqrt(distance_m_);
    const float root = -2 * above_m / (linear + std::sqrt(linear * linear - 4 * square * above_m));
    constexpr float kRounding = 0.999f;
    return kRounding * root * root;
  }

  EMSCAPE_HD TerrainTrend<float> trend() const {
    return propagation::clearTrend(trend_start_m_, trend_end_m_, ground_m_);
  }
  /// False if the smooth earth has no loss for a receiver and those above; see LaneColumn.
  EMSCAPE_HD bool isInEarth(float rx_m) const {
    if (!has_earth_) return false;
    const EffectiveHeights<float> least = effectiveHeights(trend(), tx_m_, rx_m);
    return !isClearThroughout(task_.model.model.earth, distance_m_, least.tx_m, least.rx_m);
  }
  /// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
  EMSCAPE_HD float earthCorrectionDb(float rx_m, const Maxima& most) const {
    TerrainTrend<float> over = trend();
    over.highest_m = most.plain_height_m;
    over.tx_angle = plain_tx_slope_ - slopeTo(rx_m);
    over.rx_angle = most.plain_rx_slope;
    propagation::SphericalEarth<float> earth = task_.model.model.earth;
    earth.sea_fraction = sea_fraction_;
    propagation::DeltaBullington<float> result;
    result.effective = effectiveHeights(over, tx_m_, rx_m);
    result.addEarth(earth, distance_m_,
                    [&] { return smoothEarthNu(task_.model.model, posts_, distance_m_, result.effective); });
    return result.loss_db;
  }

  const DiffractionTask& task_;
  ColumnPosts& posts_;
  float base_msl_m_, distance_m_, ground_m_, tx_m_;
  float edge_scale_;  ///< from heights over sqrt(d1 d2) to nu
  float half_curvature_, sea_fraction_;
  CandidatePosts candidates_;          ///< for the next receivers
  bool has_earth_ = false;             ///< the ground alone does not prove that the smooth earth has no loss
  float tx_slope_ = -HUGE_VALF;        ///< largest slope from the transmitter to an obstacle
  float clear_slope_ = -HUGE_VALF;     ///< of the lowest line of sight that all obstacles are clear of
  float plain_tx_slope_ = -HUGE_VALF;  ///< tx_slope without the earth's bulge
  float trend_start_m_ = 0, trend_end_m_ = 0;  ///< the line fitted to the terrain, with has_earth_
};

}  // namespace diffraction_detail

/// Fills the voxels of a segment of a column.
/// @tparam kReceivers  at a time; 1: without a pass for all receivers
/// @return false if terrain is missing along the path
template <int kReceivers>
EMSCAPE_HD bool fillDiffraction(const DiffractionTask& task, const ExcessGrid& grid, int c, int segment) {
  using diffraction_detail::Receivers;
  constexpr bool kOnePass = kReceivers == 1;
  const auto column_index = static_cast<std::size_t>(c);
  const auto set = [&](int k, float excess_db) {
    task.out.excess.set(static_cast<std::size_t>(k) * grid.column_count + column_index, excess_db);
  };
  const int end = grid.firstLayer(segment + 1);
  int k = larger(grid.firstValid(column_index), grid.firstLayer(segment));
  if (k >= end) return true;
  const GridColumn column = grid.columns[column_index];
  const FastInverse path = grid.coordinatesOf(task.station, column_index, segment);
  const float ground_msl_m =
      grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(task.station, task.ground, path);
  const PathEnds ends(task.air, task.terminal, static_cast<float>(path.distance_m), ground_msl_m);
  const auto heightOf = [&](int layer) {
    return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[smaller(layer, end - 1)])));
  };
  const auto setWithEnds = [&](int layer, float loss_db) {
    set(layer, ends.areFree() ? loss_db : ends.added(loss_db, heightOf(layer)));
  };
  if (path.distance_m > 0) {  // not at the emitter itself
    ColumnPosts posts(task.station, task.ground, path, task.at_crossings);
    Receivers receivers(task, posts, path, ground_msl_m);
    typename Receivers::Maxima most[kReceivers];
    float rx_m[kReceivers];
    const auto receiverOf = [&](int layer) {
      const float height_msl_m = heightOf(layer);
      return receivers.receiver_m(
          task.station.refraction.exponential
              ? diffraction_detail::effectiveHeight_m(task.station, height_msl_m, path.distance_m)
              : height_msl_m);
    };
    const auto setReceivers = [&] {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) rx_m[j] = receiverOf(k + j);
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
        const float next_m = k + kReceivers < end ? receiverOf(k + kReceivers) : HUGE_VALF;
        receivers.find<kReceivers>(rx_m, receivers.isLossy(next_m) ? next_m : HUGE_VALF, most);
      }
      EMSCAPE_UNROLL_BY(1)
      for (int j = 0; j < kReceivers && k + j < end; ++j) {
        setWithEnds(k + j, receivers.isLossy(rx_m[j]) ? receivers.lossDb(rx_m[j], most[j]) : 0);
      }
      k += kReceivers;
      setReceivers();
    }
    if (!is_known) {
      for (; k < end; ++k) set(k, NAN);
      return false;
    }
  }
  if (ends.areFree()) {
    const ExcessStore to = task.out.excess;
    std::size_t voxel = static_cast<std::size_t>(k) * grid.column_count + column_index;
    for (; k < end; ++k, voxel += grid.column_count) to.set(voxel, 0);
  }
  for (; k < end; ++k) setWithEnds(k, 0);
  return true;
}

}  // namespace emscape::emfield
