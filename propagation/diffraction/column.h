/// Delta-Bullington for one column of receivers at the end of one terrain profile, by one thread of a GPU. On
/// the CPU: excess.cpp.
///
/// Computes the losses of deltaBullington (diffraction.h) in a fraction of its time:
/// - Posts are visited in blocks. The maxima of a block, computed beforehand, bound every slope and nu in it;
///   most blocks cannot exceed the values of a few peaks and are skipped.
/// - Several receivers share each visit.
/// - With increasing height of the receiver, the post of the largest slope or nu only moves toward the
///   transmitter: the posts beyond it are not visited again.
/// - If a receiver has no loss with the largest margin, those above it have none.
/// Memory per column: two numbers per block.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {

/// Posts per block.
constexpr int kDiffractionBlock = 16;
/// Number of receivers that are processed together at each post.
constexpr int kDiffractionReceivers = 8;

/// @tparam Posts  the profile: int count() const                      number of posts before the receivers,
/// including the transmitter's, >= 1
///     double range_m(int) const              range of a post, rising strictly from 0
///     float height_msl_m(int) const          height of the terrain there; NaN: missing
///     float highest_msl_m(int block) const   upper bound of the heights in a block
///     float lowered_msl_m(int block) const   the same for heights less the earth's bulge d^2 / (2 a)
///     TerrainSums sumsBefore(int block) const  sums over the intervals that end before the block; heights
///                                              relative to the first post. Only read for the last block
///     double distance_m() const              range of the receivers, beyond the last post
///     float ground_msl_m() const             height of the ground below them
///     double sea_m() const                   length over sea up to the receivers (lengthOverSea_m); read if
///     the model needs it int lastBefore(double range_m) const   last post nearer than a range; 0 if there is
///     none
template <class Real, class Posts>
class DiffractionColumn {
 public:
  /// @param posts     must outlive this object
  /// @param tx_msl_m  height of the antenna; see kDiffractionAboveGround
  EMSCAPE_HD DiffractionColumn(const DiffractionModel<Real>& model, const Posts& posts, Real tx_msl_m);

  /// True if terrain is missing along the profile, so that the losses are unknown.
  EMSCAPE_HD bool isUnknown() const { return std::isnan(unknown_); }

  /// Losses (dB) of some receivers, which must be above those of the last call.
  /// @param rx_msl_m  heights (m), rising; see kDiffractionAboveGround
  /// @return true if all receivers above the last one have no loss
  template <int kReceivers>
  EMSCAPE_HD bool losses(const Real (&rx_msl_m)[kReceivers], Real (&loss_db)[kReceivers]);

 private:
  /// The obstacles of a block: its posts except the transmitter's.
  struct Block {
    int first, last;
    Real first_m, last_m;  ///< ranges
  };
  /// A receiver, and the maxima over all obstacles. "Plain" values leave out the earth's bulge.
  struct Receiver {
    Real rx_m;            ///< height
    Real slope;           ///< of the line of sight
    Real rx_slope;        ///< from the receiver to an obstacle, relative to the chord
    Real nu;              ///< of a clear path; at least kKnifeEdgeClear
    Real highest_m;       ///< height of an obstacle above the line of sight, plain
    Real rx_plain_slope;  ///< from the receiver to an obstacle, plain
  };

  static EMSCAPE_HD int maxOf(int a, int b) { return a > b ? a : b; }
  EMSCAPE_HD Real rangeOf(int i) const { return Real(posts_.range_m(i)); }
  EMSCAPE_HD Real heightOf(int i) const { return Real(posts_.height_msl_m(i)) - base_; }
  EMSCAPE_HD Block blockAt(int b) const;
  EMSCAPE_HD void findSteepest();
  template <int kReceivers>
  EMSCAPE_HD void findRxSlopes(Receiver (&receivers)[kReceivers]);
  template <int kReceivers>
  EMSCAPE_HD void findPlain(Receiver (&receivers)[kReceivers]);
  template <int kReceivers>
  EMSCAPE_HD void findNu(Receiver (&receivers)[kReceivers]);
  EMSCAPE_HD bool isBlocked(Real slope) const { return steepest_ + bulge_ >= slope; }
  EMSCAPE_HD bool isClearOfEarth(Real rx_m) const;
  EMSCAPE_HD Real smoothEarthCorrectionDb(const Receiver& at);

  DiffractionModel<Real> model_;
  const Posts& posts_;
  Real base_;  ///< height of the first post, to which all others are relative
  Real tx_;
  Real distance_m_;
  Real bulge_;                       ///< difference of slopes relative to the chord and of lowered heights
  Real unknown_ = 0;                 ///< NaN if terrain is missing
  TerrainTrend<Real> trend_{};       ///< valid where no obstacle is above the line of sight
  Real steepest_ = -Real(HUGE_VAL);  ///< max slope from the transmitter to a lowered obstacle
  Real steepest_plain_ = -Real(HUGE_VAL);        ///< the same to a plain one
  int steepest_at_ = 0, steepest_plain_at_ = 0;  ///< their posts; 0: no obstacle
  /// Posts of the last receiver's maxima; 0: none. Posts beyond them are irrelevant for higher receivers.
  /// They are visited first, so that most blocks can be skipped.
  int slope_at_, plain_at_, highest_at_, nu_at_;
  int smooth_clear_ = 0;  ///< see smoothEarthNu; 0: not yet found
};

template <class Real, class Posts>
EMSCAPE_HD DiffractionColumn<Real, Posts>::DiffractionColumn(const DiffractionModel<Real>& model,
                                                             const Posts& posts, Real tx_msl_m)
    : model_(model),
      posts_(posts),
      base_(Real(posts.height_msl_m(0))),
      tx_(model.raised_m(tx_msl_m - base_, 0)),
      distance_m_(Real(posts.distance_m())),
      bulge_(model.half_curvature * distance_m_) {
  const int last_block = (posts.count() - 1) / kDiffractionBlock;
  slope_at_ = plain_at_ = highest_at_ = nu_at_ = posts.count() - 1;
  const double base = double(posts.height_msl_m(0));
  TerrainSums sums = posts.sumsBefore(last_block);
  int i = last_block * kDiffractionBlock;
  if (i > 0) --i;
  double before_m = posts.range_m(i), before_height_m = double(posts.height_msl_m(i)) - base;
  for (++i; i < posts.count(); ++i) {
    const double range_m = posts.range_m(i), height_m = double(posts.height_msl_m(i)) - base;
    sums.add(before_m, before_height_m, range_m, height_m);
    before_m = range_m;
    before_height_m = height_m;
  }
  trend_.tx_ground_msl_m = 0;
  trend_.rx_ground_msl_m = Real(posts.ground_msl_m()) - base_;
  trend_.highest_m = -Real(HUGE_VAL);
  sums.add(before_m, before_height_m, posts.distance_m(), double(trend_.rx_ground_msl_m));
  trend_.start_msl_m = Real(sums.start_m(posts.distance_m()));
  trend_.end_msl_m = Real(sums.end_m(posts.distance_m()));
  if (model_.sea_by_height) model_.earth.sea_fraction = Real(posts.sea_m() / posts.distance_m());
  unknown_ = Real(sums.v1) - Real(sums.v1) + base_ - base_;
  findSteepest();
}

template <class Real, class Posts>
EMSCAPE_HD typename DiffractionColumn<Real, Posts>::Block DiffractionColumn<Real, Posts>::blockAt(
    int b) const {
  const int begin = b * kDiffractionBlock, end = begin + kDiffractionBlock;
  const int first = begin > 0 ? begin : 1;
  const int last = end < posts_.count() ? end - 1 : posts_.count() - 1;
  return {first, last, rangeOf(first), rangeOf(last)};
}

template <class Real, class Posts>
EMSCAPE_HD void DiffractionColumn<Real, Posts>::findSteepest() {
  if (posts_.count() == 1) return;
  const int last_block = (posts_.count() - 1) / kDiffractionBlock;
  for (int b = 0; b <= last_block; ++b) {
    const Block block = blockAt(b);
    const Real above = Real(posts_.highest_msl_m(b)) - base_ - tx_;
    const Real lowered = Real(posts_.lowered_msl_m(b)) - base_ - tx_;
    const Real max_plain = above / (above > 0 ? block.first_m : block.last_m);
    const Real max_lowered = lowered / (lowered > 0 ? block.first_m : block.last_m);
    if (max_lowered <= steepest_ && max_plain <= steepest_plain_) continue;
    for (int i = block.first; i <= block.last; ++i) {
      const Real range = rangeOf(i), height = heightOf(i), inverse = 1 / range;
      const Real plain = (height - tx_) * inverse;
      const Real here = (height - model_.half_curvature * range * range - tx_) * inverse;
      if (here > steepest_) {
        steepest_ = here;
        steepest_at_ = i;
      }
      if (plain > steepest_plain_) {
        steepest_plain_ = plain;
        steepest_plain_at_ = i;
      }
    }
  }
}

/// True if the smooth earth has no loss for this receiver and those above. Obstacles above the line of sight
/// only lower the smooth surface and so increase the heights of both antennas above it.
template <class Real, class Posts>
EMSCAPE_HD bool DiffractionColumn<Real, Posts>::isClearOfEarth(Real rx_m) const {
  const EffectiveHeights<Real> least = effectiveHeights(trend_, tx_, rx_m);
  return isClearThroughout(model_.earth, distance_m_,
                           sightLine(model_.earth, distance_m_, least.tx_m, least.rx_m));
}

/// Max slopes from the receivers to obstacles.
template <class Real, class Posts>
template <int kReceivers>
EMSCAPE_HD void DiffractionColumn<Real, Posts>::findRxSlopes(Receiver (&receivers)[kReceivers]) {
  const Real d = distance_m_, k = model_.half_curvature;
  Real rx_m[kReceivers], slope[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    rx_m[j] = receivers[j].rx_m;
    slope[j] = -Real(HUGE_VAL);
  }
  const int last_block = slope_at_ / kDiffractionBlock;
  const auto visit = [&](int i) {
    const Real range = rangeOf(i), height = heightOf(i), inverse = 1 / (d - range), bend = k * range;
    const Real last_before = slope[kReceivers - 1];
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real here = (height - rx_m[j]) * inverse + bend;
      slope[j] = here > slope[j] ? here : slope[j];
    }
    if (slope[kReceivers - 1] > last_before) slope_at_ = i;
  };
  const int before = slope_at_;
  visit(steepest_at_);
  visit(before);
  for (int b = last_block; b >= 0; --b) {
    const Block block = blockAt(b);
    const Real lowered = Real(posts_.lowered_msl_m(b)) - base_ + bulge_ * d;
    const Real to_first = 1 / (d - block.first_m), to_last = 1 / (d - block.last_m);
    bool matters = false;
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real above = lowered - rx_m[j];
      matters |= above * (above > 0 ? to_last : to_first) - bulge_ > slope[j];
    }
    if (!matters) continue;
    for (int i = block.last; i >= block.first; --i) visit(i);
  }
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) receivers[j].rx_slope = slope[j];
}

/// Max plain heights above the lines of sight and plain slopes from the receivers.
template <class Real, class Posts>
template <int kReceivers>
EMSCAPE_HD void DiffractionColumn<Real, Posts>::findPlain(Receiver (&receivers)[kReceivers]) {
  const Real d = distance_m_;
  Real rx_m[kReceivers], slope[kReceivers], highest_m[kReceivers], rx_slope[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    rx_m[j] = receivers[j].rx_m;
    slope[j] = receivers[j].slope;
    highest_m[j] = rx_slope[j] = -Real(HUGE_VAL);
  }
  const int slope_before = plain_at_, highest_before = highest_at_;
  const auto visit = [&](int i) {
    const Real range = rangeOf(i), height = heightOf(i), inverse = 1 / (d - range);
    const Real last_before = rx_slope[kReceivers - 1], last_highest_before = highest_m[kReceivers - 1];
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real here = (height - rx_m[j]) * inverse, above = height - tx_ - slope[j] * range;
      rx_slope[j] = here > rx_slope[j] ? here : rx_slope[j];
      highest_m[j] = above > highest_m[j] ? above : highest_m[j];
    }
    if (rx_slope[kReceivers - 1] > last_before) plain_at_ = i;
    if (highest_m[kReceivers - 1] > last_highest_before) highest_at_ = i;
  };
  visit(steepest_plain_at_);
  visit(slope_before);
  visit(highest_before);
  for (int b = maxOf(slope_before, highest_before) / kDiffractionBlock; b >= 0; --b) {
    const Block block = blockAt(b);
    const Real highest = Real(posts_.highest_msl_m(b)) - base_;
    const Real to_first = 1 / (d - block.first_m), to_last = 1 / (d - block.last_m);
    bool matters = false;
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real above = highest - rx_m[j];
      matters |= above * (above > 0 ? to_last : to_first) > rx_slope[j];
      matters |= highest - tx_ - slope[j] * (slope[j] > 0 ? block.first_m : block.last_m) > highest_m[j];
    }
    if (!matters) continue;
    for (int i = block.last; i >= block.first; --i) visit(i);
  }
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    receivers[j].highest_m = highest_m[j];
    receivers[j].rx_plain_slope = rx_slope[j];
  }
}

/// Max nu of clear paths.
template <class Real, class Posts>
template <int kReceivers>
EMSCAPE_HD void DiffractionColumn<Real, Posts>::findNu(Receiver (&receivers)[kReceivers]) {
  const Real d = distance_m_, k = model_.half_curvature;
  const Real factor2 = 2 * d / model_.earth.wavelength_m;
  Real slope[kReceivers], nu[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    slope[j] = receivers[j].slope;
    nu[j] = kKnifeEdgeClear<Real>;
  }
  const int before = nu_at_;
  nu_at_ = 0;
  const auto visit = [&](int i) {
    const Real range = rangeOf(i), beyond = d - range;
    const Real factor = std::sqrt(factor2 / (range * beyond));
    const Real above = heightOf(i) - tx_ + k * range * beyond;
    const Real last_before = nu[kReceivers - 1];
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real here = (above - slope[j] * range) * factor;
      nu[j] = here > nu[j] ? here : nu[j];
    }
    if (nu[kReceivers - 1] > last_before) nu_at_ = i;
  };
  if (before > 0) {
    visit(steepest_at_);
    visit(before);
  }
  for (int b = before > 0 ? before / kDiffractionBlock : -1; b >= 0; --b) {
    const Block block = blockAt(b);
    const Real lowered = Real(posts_.lowered_msl_m(b)) - base_ - tx_;
    // the range in the block with the widest first Fresnel zone
    const Real half = d / 2;
    const Real widest = half < block.first_m ? block.first_m : half > block.last_m ? block.last_m : half;
    const Real width2 = widest * (d - widest);
    bool matters = false;
    EMSCAPE_UNROLL
    for (int j = 0; j < kReceivers; ++j) {
      const Real rise = bulge_ - slope[j];
      const Real above = lowered + rise * (rise > 0 ? block.last_m : block.first_m);
      matters |= !isBlocked(slope[j]) && (above >= 0 || above * above * factor2 < nu[j] * nu[j] * width2);
    }
    if (!matters) continue;
    for (int i = block.last; i >= block.first; --i) visit(i);
  }
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) receivers[j].nu = nu[j];
}

/// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
/// @see P.526-15 eq. (68)
template <class Real, class Posts>
EMSCAPE_HD Real DiffractionColumn<Real, Posts>::smoothEarthCorrectionDb(const Receiver& at) {
  TerrainTrend<Real> trend = trend_;
  trend.highest_m = at.highest_m;
  if (at.highest_m > 0) {
    trend.tx_angle = steepest_plain_ - at.slope;
    trend.rx_angle = at.slope + at.rx_plain_slope;
  }
  const EffectiveHeights<Real> heights = effectiveHeights(trend, tx_, at.rx_m);
  const Real spherical_db = sphericalEarthLossDb(model_.earth, distance_m_, heights.tx_m, heights.rx_m);
  if (spherical_db <= 0) return 0;
  const auto find = [&](Real range_m) {
    const int post = posts_.lastBefore(double(range_m));
    return post < 1 ? 1 : post;
  };
  if (smooth_clear_ == 0) {
    smooth_clear_ = find(distance_m_ * heights.tx_m / (heights.tx_m + heights.rx_m));
  }
  const Real smooth_nu = smoothEarthNu(
      model_, [&](int i) { return rangeOf(i); }, find, posts_.count() - 1, distance_m_, heights,
      smooth_clear_);
  const Real correction_db = spherical_db - bullingtonLossDb(smooth_nu, distance_m_);
  return correction_db > 0 ? correction_db : Real(0);
}

template <class Real, class Posts>
template <int kReceivers>
EMSCAPE_HD bool DiffractionColumn<Real, Posts>::losses(const Real (&rx_msl_m)[kReceivers],
                                                       Real (&loss_db)[kReceivers]) {
  const Real infinity = Real(HUGE_VAL);
  Receiver receivers[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    const Real rx_m = model_.raised_m(rx_msl_m[j] - base_, trend_.rx_ground_msl_m);
    receivers[j] = {rx_m, (rx_m - tx_) / distance_m_, -infinity, -infinity, -infinity, -infinity};
  }
  // Slopes and clearance increase with the receiver's height, so the lowest or the highest receiver decides
  // for all.
  const bool has_earth = !isClearOfEarth(receivers[0].rx_m);
  if (steepest_at_ > 0) {
    if (isBlocked(receivers[0].slope)) findRxSlopes(receivers);
    if (!isBlocked(receivers[kReceivers - 1].slope)) findNu(receivers);
    if (has_earth) findPlain(receivers);
  }
  // Not unrolled: the body is long, and inlined once it stays in the instruction cache.
  bool is_free_above = false;
  for (int j = 0; j < kReceivers; ++j) {
    const Receiver& at = receivers[j];
    const Real nu = isBlocked(at.slope)
                        ? bullingtonEdgeNu(model_, distance_m_, at.slope, steepest_ + bulge_, at.rx_slope)
                        : at.nu;
    loss_db[j] = bullingtonLossDb(nu, distance_m_);
    const bool is_clear_of_earth = !has_earth || isClearOfEarth(at.rx_m);
    if (!is_clear_of_earth) loss_db[j] += smoothEarthCorrectionDb(at);
    is_free_above = is_clear_of_earth && nu <= kKnifeEdgeClear<Real>;
  }
  return is_free_above;
}

}  // namespace emscape::propagation
