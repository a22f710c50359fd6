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
};

namespace diffraction_detail {

using propagation::DiffractionModel;
using propagation::EffectiveHeights;
using propagation::TerrainTrend;

// Separate calls, so that their registers and their code are not part of those of the columns.
EMSCAPE_DEVICE_CALL EMSCAPE_HD inline float groundOf(const Station& station, const GroundPosts& ground,
                                                     const FastInverse& path) {
  return groundAt(station, ground, path);
}
EMSCAPE_DEVICE_CALL EMSCAPE_HD inline float effectiveHeight_m(const Station& station, float height_msl_m,
                                                              double range_m) {
  return static_cast<float>(
      station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m), station.height_msl_m, range_m));
}

EMSCAPE_DEVICE_CALL EMSCAPE_HD inline float smoothEarthNu(const DiffractionModel<float>& model,
                                                          ColumnPosts& posts, float distance_m,
                                                          const EffectiveHeights<float>& heights) {
  return propagation::smoothEarthNu(model, distance_m, heights,
                                    [&](float range_m) { return posts.around(range_m); });
}

/// A post seen from the transmitter. Heights are above it; "plain" ones leave out the earth's bulge and
/// clutter.
struct SeenPost {
  float range_m, plain_m, height_m;
  float root;        ///< 1 / sqrt(d1 d2)
  float per_beyond;  ///< 1 / d2
  float not_plain;   ///< what the earth's bulge and clutter add to the slope from the receivers

  EMSCAPE_HD SeenPost(const PathPost& post, float distance_m, float base_msl_m, float tx_m,
                      float half_curvature)
      : range_m(post.range_m), plain_m(post.height_msl_m - base_msl_m - tx_m - post.raised_m) {
    const float product = range_m * (distance_m - range_m);
    root = approximateReciprocalRoot(product);
    per_beyond = root * root * range_m;
    height_m = fmaf(half_curvature, product, plain_m + post.raised_m);
    not_plain = fmaf(half_curvature, range_m, post.raised_m * per_beyond);
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
  static constexpr int kMost = 512;

  /// @param are_raised  by clutter
  EMSCAPE_HD explicit CandidatePosts(bool are_raised) : are_raised_(are_raised) {}

  /// The largest measures of the posts so far, in order of their ranges, seen from a receiver.
  struct Records {
    float slope;    ///< of the line of sight
    float nearest;  ///< at first that of a post that is clear
    float rx_slope, plain_rx_slope, plain_m;

    /// Those of the posts beyond all.
    EMSCAPE_HD explicit Records(float slope_)
        : slope(slope_),
          nearest(-HUGE_VALF),
          rx_slope(-HUGE_VALF),
          plain_rx_slope(-HUGE_VALF),
          plain_m(-HUGE_VALF) {}
    /// For the lowest receiver: posts below its line of sight decide only on its clearance, as they do for
    /// those above.
    /// @param clear  of a post that is clear, its height over sqrt(d1 d2)
    EMSCAPE_HD Records(float slope_, float clear)
        : slope(slope_), nearest(clear), rx_slope(0), plain_rx_slope(0), plain_m(0) {}

    /// @tparam kPlain  also those without the earth's bulge
    /// @return true if the next post exceeds one
    template <bool kPlain>
    EMSCAPE_HD bool add(const SeenPost& post) {
      const float line = fmaf(-slope, post.range_m, post.height_m);
      const bool exceeds = exceed(line * post.per_beyond, rx_slope) | exceed(line * post.root, nearest);
      if (!kPlain) return exceeds;
      const float plain_line = fmaf(-slope, post.range_m, post.plain_m);
      return exceeds | exceed(plain_line * post.per_beyond, plain_rx_slope) | exceed(plain_line, plain_m);
    }

   private:
    static EMSCAPE_HD bool exceed(float here, float& record) {
      const bool exceeds = here > record;
      record = fmaxf(record, here);
      return exceeds;
    }
  };

  EMSCAPE_HD void set(int n, const PathPost& post) {
    if (n >= kMost) return;
    posts_[n] = {post.range_m, post.height_msl_m};
    if (are_raised_) raised_m_[n] = post.raised_m;
  }
  /// They are those that were set before n.
  EMSCAPE_HD void end(int n) {
    first_ = 0;
    end_ = n;
  }
  /// False if there was no room for all: they are incomplete.
  EMSCAPE_HD bool areComplete() const { return end_ <= kMost; }
  EMSCAPE_HD int count() const { return end_ - first_; }
  /// Calls visit(PathPost) for each of them, which are complete.
  template <class Visit>
  EMSCAPE_HD void each(const Visit& visit) const {
    EMSCAPE_UNROLL_BY(1)
    for (int i = first_; i < end_; ++i) visit(at(i));
  }
  /// Keeps those for which is_needed(PathPost), called from the last one to the first one.
  template <class IsNeeded>
  EMSCAPE_HD void keepBackwards(const IsNeeded& is_needed) {
    first_ = end_;
    EMSCAPE_UNROLL_BY(1)
    for (int i = end_ - 1; i >= 0; --i) {
      const PathPost post = at(i);
      if (is_needed(post)) set(--first_, post);
    }
  }

 private:
  struct Bare {
    float range_m, height_msl_m;
  };
  EMSCAPE_HD PathPost at(int i) const {
    return {posts_[i].range_m, posts_[i].height_msl_m, are_raised_ ? raised_m_[i] : 0.0f};
  }

  Bare posts_[kMost];
  float raised_m_[kMost];  ///< if are_raised_
  bool are_raised_;
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
        base_msl_m_(groundOf(task.station, task.ground, {0, path.sin_azimuth, path.cos_azimuth})),
        distance_m_(static_cast<float>(path.distance_m)),
        ground_m_(ground_msl_m - base_msl_m_),
        tx_m_(DiffractionModel<float>::raised_m(task.model.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / task.model.model.earth.wavelength_m)),
        half_curvature_(task.model.model.half_curvature),
        sea_fraction_(task.model.model.earth.sea_fraction),
        candidates_(task.ground.is_raised) {}

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
    has_earth_ = !isClearThroughout(task_.model.model.earth, distance_m_, tx_m_, lowest_m - ground_m_);
    const float slope = slopeTo(lowest_m);
    const bool for_any = isForAnyLane(has_earth_);  // one loop for all threads
    const bool is_known =
        for_any ? pass<kReceivers, true>(rx_m, slope, most) : pass<kReceivers, false>(rx_m, slope, most);
    has_earth_ = isInEarth(lowest_m);
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
    EMSCAPE_HD void add(const SeenPost& post) {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        const float above_line = fmaf(-slope[j], post.range_m, post.height_m);
        const float from_rx = above_line * (kBoth || is_below[j] ? post.per_beyond : post.root);
        edge[j] = fmaxf(edge[j], from_rx);
        if constexpr (kBoth) nearest[j] = fmaxf(nearest[j], above_line * post.root);
        if constexpr (kEarth) {  // read of those below the steepest plain ray, and so below the steepest one
          plain_rx[j] = fmaxf(plain_rx[j], from_rx - post.not_plain);
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

  /// Sums over the posts of a path for the line fitted to the bare terrain and the share of the sea.
  struct TrendSums {
    float base_msl_m, v1 = 0, v2 = 0;  ///< as propagation::TerrainSums
    float sea_m = 0, before_m = 0, before_height_m = 0;
    bool was_sea;

    EMSCAPE_HD explicit TrendSums(float base) : base_msl_m(base), was_sea(base <= 0) {}

    /// @param height_msl_m  NaN, beside a void: left out
    EMSCAPE_HD void add(float range_m, float height_msl_m) {
      if (std::isnan(height_msl_m)) return;
      const float length_m = range_m - before_m, height_m = height_msl_m - base_msl_m;
      const bool is_sea = height_msl_m <= 0;
      v1 = fmaf(length_m, before_height_m + height_m, v1);
      v2 = fmaf(length_m, fmaf(height_m, 2 * range_m + before_m, before_height_m * (range_m + 2 * before_m)),
                v2);
      sea_m = fmaf(length_m, (was_sea ? 0.5f : 0) + (is_sea ? 0.5f : 0), sea_m);
      before_m = range_m;
      before_height_m = height_m;
      was_sea = is_sea;
    }
  };
  EMSCAPE_HD void setTrend(TrendSums& sums) {
    sums.add(distance_m_, ground_m_ + base_msl_m_);
    const propagation::TerrainSums of_terrain{static_cast<double>(sums.v1), static_cast<double>(sums.v2)};
    trend_start_m_ = static_cast<float>(of_terrain.start_m(static_cast<double>(distance_m_)));
    trend_end_m_ = static_cast<float>(of_terrain.end_m(static_cast<double>(distance_m_)));
    if (task_.model.model.sea_by_height) sea_fraction_ = sums.sea_m / distance_m_;
  }

  /// What posts of a part of the path that are not higher than a height cannot exceed.
  struct Bounds {
    float tx_slope, clear_slope, rx_slope, nearest;
  };
  EMSCAPE_HD Bounds boundsOf(float from_m, float to_m, float highest_msl_m, float slope,
                             float clearance) const {
    constexpr float kRounding_m = 0.01f;
    const float d = distance_m_, middle_m = fminf(fmaxf(d / 2, from_m), to_m);
    const float plain_m = highest_msl_m - base_msl_m_ - tx_m_ + kRounding_m;
    const float widest = middle_m * (d - middle_m);
    const float height_m = fmaf(half_curvature_, widest, plain_m);
    const float rise_m = fmaxf(-slope * from_m, -slope * to_m);
    const float line_m = height_m + rise_m;
    const float per_from = approximateReciprocal(from_m), per_to = approximateReciprocal(to_m);
    const float beyond_from = d - from_m, beyond_to = d - to_m;
    const float narrowest = fminf(from_m * beyond_from, to_m * beyond_to);
    Bounds most;
    most.tx_slope = height_m * (height_m > 0 ? per_from : per_to);
    most.clear_slope = most.tx_slope + clearance * std::sqrt(beyond_from * per_from);
    most.rx_slope = line_m * approximateReciprocal(line_m > 0 ? beyond_to : beyond_from);
    most.nearest = line_m * approximateReciprocalRoot(line_m > 0 ? narrowest : widest);
    return most;
  }

  /// @tparam kEarth  also for the smooth earth
  /// @param lowest_slope  of the line of sight to the lowest receiver
  template <int kReceivers, bool kEarth>
  EMSCAPE_DEVICE_CALL EMSCAPE_HD bool pass(const float* rx_m, float lowest_slope, Maxima* most) {
    constexpr bool kKeeps = kReceivers == 0;
    const float clearance = -propagation::kKnifeEdgeClear<float> / edge_scale_;
    const float d = distance_m_, half_curvature = half_curvature_;
    const float base_msl_m = base_msl_m_, tx_m = tx_m_;
    int kept = 0;
    float tx, clear, plain_tx, unknown;
    bool is_whole;
    Several<kReceivers, kEarth, true> several(*this, rx_m);
    const float clear_of_all = -1.001f * clearance;
    CandidatePosts::Records records(lowest_slope, clear_of_all);
    TrendSums trend(base_msl_m);
    do {
      trend = TrendSums(base_msl_m);
      tx = clear = plain_tx = -HUGE_VALF;
      unknown = base_msl_m_ - base_msl_m_ + (ground_m_ - ground_m_);
      several.clear();
      records = CandidatePosts::Records(lowest_slope, clear_of_all);
      kept = 0;
      const auto skips = [&](float from_m, float to_m, float highest_msl_m) -> bool {
        if constexpr (kReceivers > 1) return false;  // after a first pass of too many candidates
        if constexpr (kEarth) return false;          // the line is fitted to all posts
        const Bounds bounds = boundsOf(from_m, to_m, highest_msl_m, lowest_slope, clearance);
        const bool is_below = (bounds.tx_slope <= tx) & (bounds.clear_slope <= clear) &
                              (bounds.rx_slope <= records.rx_slope) & (bounds.nearest <= records.nearest);
        return is_below | (bounds.nearest <= -clearance);  // or clear of the lowest line of sight
      };
      is_whole = posts_.each(skips, [&](const PathPost& post) {
        unknown += post.height_msl_m - post.height_msl_m;
        if constexpr (kEarth) trend.add(post.range_m, post.height_msl_m - post.raised_m);
        const SeenPost seen(post, d, base_msl_m, tx_m, half_curvature);
        const float per_range = (d - seen.range_m) * seen.root;
        tx = fmaxf(tx, per_range * (seen.height_m * seen.root));
        clear = fmaxf(clear, per_range * fmaf(seen.height_m, seen.root, clearance));
        if constexpr (kEarth) plain_tx = fmaxf(plain_tx, per_range * (seen.plain_m * seen.root));
        const bool is_record = records.template add<kEarth>(seen);
        if constexpr (kKeeps) {
          if (is_record) candidates_.set(kept++, post);
        }
        several.add(seen);
      });
    } while (!is_whole);
    if constexpr (kKeeps) candidates_.end(kept);
    if constexpr (kEarth) setTrend(trend);
    tx_slope_ = tx;
    clear_slope_ = clear;
    plain_tx_slope_ = plain_tx;
    several.get(tx, most);
    return unknown == 0;
  }
  /// Leaves out the candidates that exceed no farther ones for a receiver at that slope and those below.
  template <bool kEarth>
  EMSCAPE_DEVICE_CALL EMSCAPE_HD void thin(float highest_slope) {
    CandidatePosts::Records records(highest_slope);
    candidates_.keepBackwards([&](const PathPost& post) { return records.template add<kEarth>(seen(post)); });
  }
  template <int kReceivers, bool kEarth>
  EMSCAPE_DEVICE_CALL EMSCAPE_HD void findAmongCandidates(const float* rx_m, Maxima* most) const {
    Several<kReceivers, kEarth, false> several(*this, rx_m);
    candidates_.each([&](const PathPost& post) { several.add(seen(post)); });
    several.get(tx_slope_, most);
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
  bool has_earth_ = false;             ///< the smooth earth has a loss for the lowest receiver
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
  const ExcessStore to = task.out.excess;
  const auto set = [&](int k, float excess_db) {
    to.set(static_cast<std::size_t>(k) * grid.column_count + column_index, excess_db);
  };
  const int end = grid.firstLayer(segment + 1);
  int k = larger(grid.firstValid(column_index), grid.firstLayer(segment));
  if (k >= end) return true;
  const GridColumn column = grid.columns[column_index];
  const FastInverse path = grid.coordinatesOf(task.station, column_index, segment);
  const float ground_msl_m = grid.ground_msl_m != nullptr
                                 ? grid.ground_msl_m[c]
                                 : diffraction_detail::groundOf(task.station, task.ground, path);
  const AirLoss air = task.air;
  const propagation::TerminalClutter terminal = task.terminal;
  const PathEnds ends(air, terminal, static_cast<float>(path.distance_m), ground_msl_m);
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
      // Only high ones are changed; the call alone takes longer than the rest.
      const bool is_high =
          task.station.refraction.exponential && height_msl_m > static_cast<float>(Refraction::kLinear_m);
      return receivers.receiver_m(
          is_high ? diffraction_detail::effectiveHeight_m(task.station, height_msl_m, path.distance_m)
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
    std::size_t voxel = static_cast<std::size_t>(k) * grid.column_count + column_index;
    for (; k < end; ++k, voxel += grid.column_count) to.set(voxel, 0);
  }
  for (; k < end; ++k) setWithEnds(k, 0);
  return true;
}

}  // namespace emscape::emfield
