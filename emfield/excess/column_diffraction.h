/// `diffraction` over a column of receivers by one thread of the device; also on the host, for tests.
///
/// The first pass over a path's posts gives the steepest slope from the transmitter, and the slope of the
/// line of sight above which every post is clear: nu of a post falls linearly with the receiver's height.
/// Only receivers below that, or not clear of the smooth earth, are computed; the others have no loss. Few
/// receivers, as those of a map, take one pass. Of many the first pass keeps the posts that may decide.
/// The same formulas as propagation/diffraction/excess.cpp.
#pragma once

#include <cmath>

#include "base/math/device_loop.h"
#include "emfield/excess/fill_excess.h"
#include "emfield/ground/column_posts.h"
#include "propagation/diffraction/excess.h"

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

/// Bullington's nu over a smooth earth with posts at the same ranges, as propagation::bullingtonNu. A
/// separate call.
/// @param heights  of the antennas above it
EMSCAPE_NOINLINE EMSCAPE_HD inline float smoothEarthNu(const DiffractionModel<float>& model,
                                                       ColumnPosts& posts, float distance_m,
                                                       const EffectiveHeights<float>& heights) {
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

/// A post seen from the transmitter. Heights are above it; "plain" ones leave out the earth's bulge.
struct SeenPost {
  float range_m, plain_m, height_m;
  float root;        ///< 1 / sqrt(d1 d2)
  float per_beyond;  ///< 1 / d2

  EMSCAPE_HD SeenPost(const PathPost& post, float distance_m, float base_msl_m, float tx_m,
                      float half_curvature)
      : range_m(post.range_m), plain_m(post.height_msl_m - base_msl_m - tx_m) {
    const float product = range_m * (distance_m - range_m);
    root = approximateReciprocalRoot(product);
    per_beyond = root * root * range_m;
    height_m = fmaf(half_curvature, product, plain_m);
  }
};

/// Posts of a path among which are those of all maxima of the receivers from a lowest to a highest one.
///
/// Each measure of a post seen from a receiver is linear in the slope of the line of sight, and falls faster
/// for farther posts. A post that does not exceed all nearer ones for the lowest receiver therefore exceeds
/// none of them for a higher one, and one that does not exceed all farther ones for the highest receiver none
/// of those for a lower one. Only posts that do both, each in some measure, are kept.
class CandidatePosts {
 public:
  static constexpr int kMost = 224;

  /// The largest measures of the posts so far, seen from a receiver.
  /// @tparam kBackwards  from the farthest post to the nearest one
  template <bool kBackwards>
  class Records {
   public:
    EMSCAPE_HD explicit Records(float slope) : slope_(slope) {}

    /// @tparam kPlain  also those without the earth's bulge
    /// @return true if the next post exceeds one
    template <bool kPlain>
    EMSCAPE_HD bool add(const SeenPost& post) {
      if (kBackwards ? post.range_m > last_m_ : post.range_m < last_m_)  // posts come in runs
        *this = Records(slope_);
      last_m_ = post.range_m;
      const float line = fmaf(-slope_, post.range_m, post.height_m);
      const bool exceeds = exceed(line * post.per_beyond, rx_slope_) | exceed(line * post.root, nearest_);
      if (!kPlain) return exceeds;
      const float plain_line = fmaf(-slope_, post.range_m, post.plain_m);
      return exceeds | exceed(plain_line * post.per_beyond, plain_rx_slope_) | exceed(plain_line, plain_m_);
    }

   private:
    static EMSCAPE_HD bool exceed(float here, float& record) {
      const bool exceeds = here > record;
      record = fmaxf(record, here);
      return exceeds;
    }

    float slope_, last_m_ = 0;
    float rx_slope_ = -HUGE_VALF, nearest_ = -HUGE_VALF, plain_rx_slope_ = -HUGE_VALF, plain_m_ = -HUGE_VALF;
  };

  EMSCAPE_HD void clear() {
    first_ = 0;
    end_ = 0;
  }
  EMSCAPE_HD void add(const PathPost& post) {
    if (end_ < kMost) posts_[end_] = post;
    ++end_;
  }
  /// False if there was no room for all: they are incomplete.
  EMSCAPE_HD bool areComplete() const { return end_ <= kMost; }
  EMSCAPE_HD int count() const { return end_ - first_; }
  /// Calls visit(PathPost) for each of them, which are complete.
  template <class Visit>
  EMSCAPE_HD void each(const Visit& visit) const {
    EMSCAPE_UNROLL_BY(1)
    for (int i = first_; i < end_; ++i) visit(posts_[i]);
  }
  /// Keeps those for which is_needed(PathPost), called from the last one to the first one.
  template <class IsNeeded>
  EMSCAPE_HD void keepBackwards(const IsNeeded& is_needed) {
    first_ = end_;
    EMSCAPE_UNROLL_BY(1)
    for (int i = end_ - 1; i >= 0; --i) {
      const PathPost post = posts_[i];
      if (is_needed(post)) posts_[--first_] = post;
    }
  }

 private:
  PathPost posts_[kMost];
  int first_ = 0, end_ = kMost + 1;  ///< nothing was looked for
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

  /// The pass over all posts.
  /// @param lowest_m   of the lowest receiver
  /// @param highest_m  of the highest one
  /// @param rx_m       of receivers whose maxima are found; without any, the posts for find() are
  /// @return false if terrain is missing along the profile
  template <int kReceivers>
  EMSCAPE_HD bool survey(float lowest_m, float highest_m, const float* rx_m, Maxima* most) {
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    has_earth_ =
        !isClearThroughout(earth, distance_m_, sightLine(earth, distance_m_, tx_m_, lowest_m - ground_m_));
    const float slope = slopeTo(lowest_m);
    const bool for_any = isForAnyLane(has_earth_);  // one loop for all threads
    const bool is_known =
        for_any ? pass<kReceivers, true>(rx_m, slope, most) : pass<kReceivers, false>(rx_m, slope, most);
    if (kReceivers == 0 && candidates_.areComplete()) {
      const float clear_m = fmaf(clear_slope_, distance_m_, tx_m_);
      const float end_slope = isInEarth(clear_m) ? slopeTo(highest_m) : clear_slope_;
      for_any ? thin<true>(end_slope) : thin<false>(end_slope);
    }
    return is_known;
  }
  /// The maxima of receivers, lowest first, from the posts that survey() kept.
  template <int kReceivers>
  EMSCAPE_HD void find(const float* rx_m, Maxima* most) const {
    const bool in_earth = isInEarth(rx_m[0]) && slopeTo(rx_m[0]) < plain_tx_slope_;
    isForAnyLane(in_earth) ? findAmongCandidates<kReceivers, true>(rx_m, most)
                           : findAmongCandidates<kReceivers, false>(rx_m, most);
  }
  /// False: there are too many posts for find().
  EMSCAPE_HD bool canFind() const { return candidates_.areComplete(); }

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

  EMSCAPE_HD SeenPost seen(const PathPost& post) const {
    return {post, distance_m_, base_msl_m_, tx_m_, half_curvature_};
  }

  /// Maxima of receivers.
  /// @tparam kEarth  also for the smooth earth
  /// @tparam kBoth   it is not known which are below the steepest ray
  template <int kReceivers, bool kEarth, bool kBoth>
  struct Several {
    static constexpr int kRoom = kReceivers > 0 ? kReceivers : 1;
    float slope[kRoom], edge[kRoom], nearest[kRoom], plain_rx[kRoom], plain[kRoom];
    bool is_below[kRoom];

    EMSCAPE_HD Several(const Receivers& of, const float* rx_m) {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        slope[j] = of.slopeTo(rx_m[j]);
        is_below[j] = slope[j] <= of.tx_slope_;
      }
      clear();
    }
    EMSCAPE_HD void clear() {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) edge[j] = nearest[j] = plain_rx[j] = plain[j] = -HUGE_VALF;
    }
    EMSCAPE_HD void add(const SeenPost& post, float half_curvature) {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        const float above_line = fmaf(-slope[j], post.range_m, post.height_m);
        const float from_rx = above_line * (kBoth || is_below[j] ? post.per_beyond : post.root);
        edge[j] = fmaxf(edge[j], from_rx);
        if constexpr (kBoth) nearest[j] = fmaxf(nearest[j], above_line * post.root);
        if constexpr (kEarth) {  // read of those below the steepest plain ray, and so below the steepest one
          plain_rx[j] = fmaxf(plain_rx[j], from_rx - half_curvature * post.range_m);
          plain[j] = fmaxf(plain[j], fmaf(-slope[j], post.range_m, post.plain_m));
        }
      }
    }
    EMSCAPE_HD void get(float tx_slope, Maxima* most) const {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j)
        most[j] = {kBoth && !(slope[j] <= tx_slope) ? nearest[j] : edge[j], plain_rx[j], plain[j]};
    }
  };

  /// @tparam kEarth  also for the smooth earth
  /// @param lowest_slope  of the line of sight to the lowest receiver
  template <int kReceivers, bool kEarth>
  EMSCAPE_NOINLINE EMSCAPE_HD bool pass(const float* rx_m, float lowest_slope, Maxima* most) {
    constexpr bool kKeeps = kReceivers == 0;
    const float clearance = -propagation::kKnifeEdgeClear<float> / edge_scale_;
    const float d = distance_m_, base_msl_m = base_msl_m_, half_curvature = half_curvature_;
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
    const float nearest_m = kEarth ? 0 : nearestOfAll_m(lowest_slope, clearance);
    Several<kReceivers, kEarth, true> several(*this, rx_m);
    CandidatePosts::Records<false> records(lowest_slope);
    do {
      tx = clear = plain_tx = -HUGE_VALF;
      unknown = base_msl_m - base_msl_m + (ground_m_ - ground_m_);
      v1 = v2 = v1_rest = v2_rest = sea_m = 0;
      before = {0, base_msl_m};
      several.clear();
      if constexpr (kKeeps) {
        records = CandidatePosts::Records<false>(lowest_slope);
        candidates_.clear();
      }
      is_whole = posts_.each<kEarth>(nearest_m, [&](const PathPost& post) {
        unknown += post.height_msl_m - post.height_msl_m;
        const SeenPost seen = this->seen(post);
        const float per_range = (d - seen.range_m) * seen.root;
        tx = fmaxf(tx, per_range * (seen.height_m * seen.root));
        clear = fmaxf(clear, per_range * fmaf(seen.height_m, seen.root, clearance));
        if constexpr (kEarth) {
          plain_tx = fmaxf(plain_tx, per_range * (seen.plain_m * seen.root));
          addToTrend(post);
        }
        if constexpr (kKeeps) {
          if (records.template add<kEarth>(seen)) candidates_.add(post);
        }
        several.add(seen, half_curvature);
      });
    } while (!is_whole);
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
    several.get(tx, most);
    return unknown == 0;
  }
  /// Leaves out the candidates that exceed no farther ones for a receiver at that slope and those below.
  template <bool kEarth>
  EMSCAPE_NOINLINE EMSCAPE_HD void thin(float highest_slope) {
    CandidatePosts::Records<true> records(highest_slope);
    candidates_.keepBackwards([&](const PathPost& post) { return records.template add<kEarth>(seen(post)); });
  }
  template <int kReceivers, bool kEarth>
  EMSCAPE_NOINLINE EMSCAPE_HD void findAmongCandidates(const float* rx_m, Maxima* most) const {
    Several<kReceivers, kEarth, false> several(*this, rx_m);
    candidates_.each([&](const PathPost& post) { several.add(seen(post), half_curvature_); });
    several.get(tx_slope_, most);
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
    TerrainTrend<float> trend;
    trend.start_msl_m = trend_start_m_;
    trend.end_msl_m = trend_end_m_;
    trend.highest_m = trend.tx_angle = trend.rx_angle = -HUGE_VALF;
    trend.tx_ground_msl_m = 0;
    trend.rx_ground_msl_m = ground_m_;
    return trend;
  }
  /// False if the smooth earth has no loss for a receiver and those above; see LaneColumn.
  EMSCAPE_HD bool isInEarth(float rx_m) const {
    if (!has_earth_) return false;
    const EffectiveHeights<float> least = effectiveHeights(trend(), tx_m_, rx_m);
    const propagation::SphericalEarth<float>& earth = task_.model.model.earth;
    return !isClearThroughout(earth, distance_m_, sightLine(earth, distance_m_, least.tx_m, least.rx_m));
  }
  /// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
  EMSCAPE_HD float earthCorrectionDb(float rx_m, const Maxima& most) const {
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
  const propagation::AirColumn air(task.air, static_cast<float>(path.distance_m));
  const auto heightOf = [&](int layer) {
    return static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[smaller(layer, end - 1)])));
  };
  const auto addOthers = [&](int layer, float loss_db) {
    if (task.terminal.isSet())
      loss_db = task.terminal.withLossDb(loss_db, static_cast<float>(path.distance_m),
                                         heightOf(layer) - ground_msl_m);
    if (!task.air.isClear()) loss_db += air.lossDb(heightOf(layer));
    set(layer, loss_db);
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
    const float highest_m = receiverOf(end - 1);
    if constexpr (!kOnePass) is_known = receivers.survey<0>(rx_m[0], highest_m, nullptr, nullptr);
    while (k < end && is_known) {
      if (!kOnePass && !receivers.isLossy(rx_m[0])) break;
      if (kOnePass || !receivers.canFind()) {
        is_known = receivers.survey<kReceivers>(rx_m[0], highest_m, rx_m, most);
        if (!is_known) break;
      } else {
        receivers.find<kReceivers>(rx_m, most);
      }
      EMSCAPE_UNROLL_BY(1)
      for (int j = 0; j < kReceivers && k + j < end; ++j) {
        addOthers(k + j, receivers.isLossy(rx_m[j]) ? receivers.lossDb(rx_m[j], most[j]) : 0);
      }
      k += kReceivers;
      setReceivers();
    }
    if (!is_known) {
      for (; k < end; ++k) set(k, NAN);
      return false;
    }
  }
  if (task.air.isClear() && !task.terminal.isSet()) {
    const ExcessStore to = task.out.excess;
    std::size_t voxel = static_cast<std::size_t>(k) * grid.column_count + column_index;
    for (; k < end; ++k, voxel += grid.column_count) to.set(voxel, 0);
  }
  for (; k < end; ++k) addOthers(k, 0);
  return true;
}

}  // namespace emscape::emfield
