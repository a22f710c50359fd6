/// Delta-Bullington for one column of receivers at the end of one profile, without memory for hulls: for
/// devices where a thread has little of it and posts are cheap to read again.
///
/// Agrees with deltaBullington (diffraction.h) path by path. What depends on the posts alone is found in one
/// walk; what depends on the receiver as well is found for several receivers at a time in another.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "emfield/models/diffraction.h"
#include "emfield/models/diffraction_smooth_earth.h"

namespace emscape::emfield {

/// @tparam Posts  the profile, to be read more than once:
///     int count() const                 posts before the receivers, the transmitter's among them, >= 1
///     double range_m(int) const         of a post, rising strictly from 0
///     float height_msl_m(int) const     of the terrain there; NaN: missing
///     double distance_m() const         of the receivers, beyond the last post
///     float ground_msl_m() const        below them
///     int lastBefore(double) const      post nearer than a range
template <class Real, class Posts>
class DiffractionColumn {
 public:
  /// @param posts     stays alive
  /// @param tx_msl_m  of the antenna; see kDiffractionAboveGround
  EMSCAPE_HD DiffractionColumn(const DiffractionModel<Real>& model, const Posts& posts, Real tx_msl_m);

  /// Terrain is missing on the way: nothing is known of the losses.
  EMSCAPE_HD bool isUnknown() const { return std::isnan(unknown_); }

  /// Losses (dB) of some receivers.
  /// @param rx_msl_m  heights (m), rising; see kDiffractionAboveGround
  /// @return whether receivers above the last one have no loss
  template <int kReceivers>
  EMSCAPE_HD bool losses(const Real (&rx_msl_m)[kReceivers], Real (&loss_db)[kReceivers]);

 private:
  /// A receiver, and the largest values of all obstacles.
  struct Found {
    Real rx_m, slope;     ///< slope: of the line of sight
    Real rx_slope;        ///< from the receiver, over the chord
    Real nu;              ///< of a clear path
    Real highest_m;       ///< over the line of sight, without the earth's bulge
    Real rx_plain_slope;  ///< from the receiver, without the bulge
  };

  EMSCAPE_HD Real heightOf(int i) const { return Real(posts_.height_msl_m(i)) - base_; }
  EMSCAPE_HD bool isClearOfEarth(Real rx_m) const;
  EMSCAPE_HD Real lackingDb(const Found& at);

  DiffractionModel<Real> model_;
  const Posts& posts_;
  Real base_;  ///< all heights are from the first post's
  Real tx_;
  Real distance_m_;
  Real unknown_ = 0;
  TerrainTrend<Real> trend_{};       ///< as long as no obstacle is over the line of sight
  Real steepest_ = -Real(HUGE_VAL);  ///< slope from the transmitter to an obstacle less its bulge d^2 / (2 a)
  Real steepest_plain_ = -Real(HUGE_VAL);  ///< the same without the bulge
  SmoothEarthPosts smooth_{0, 0, 0};       ///< 0: not looked for yet
};

template <class Real, class Posts>
EMSCAPE_HD DiffractionColumn<Real, Posts>::DiffractionColumn(const DiffractionModel<Real>& model,
                                                             const Posts& posts, Real tx_msl_m)
    : model_(model),
      posts_(posts),
      base_(Real(posts.height_msl_m(0))),
      tx_(model.raised_m(tx_msl_m - base_, 0)),
      distance_m_(Real(posts.distance_m())) {
  TerrainSums sums;
  double before_m = 0;
  Real before_height_m = 0;
  for (int i = 1; i < posts.count(); ++i) {
    const double range_m = posts.range_m(i);
    const Real range = Real(range_m), height = heightOf(i);
    sums.add(before_m, double(before_height_m), range_m, double(height));
    before_m = range_m;
    before_height_m = height;
    const Real inverse = 1 / range;
    const Real plain = (height - tx_) * inverse;
    const Real lowered = (height - model_.half_curvature * range * range - tx_) * inverse;
    steepest_ = lowered > steepest_ ? lowered : steepest_;
    steepest_plain_ = plain > steepest_plain_ ? plain : steepest_plain_;
  }
  trend_.tx_ground_msl_m = 0;
  trend_.rx_ground_msl_m = Real(posts.ground_msl_m()) - base_;
  trend_.highest_m = -Real(HUGE_VAL);
  sums.add(before_m, double(before_height_m), posts.distance_m(), double(trend_.rx_ground_msl_m));
  trend_.start_msl_m = Real(sums.start_m(posts.distance_m()));
  trend_.end_msl_m = Real(sums.end_m(posts.distance_m()));
  unknown_ = Real(sums.v1) - Real(sums.v1) + base_ - base_;
}

/// Whether the smooth earth has no loss, for this receiver and those above. Obstacles over the line of sight
/// would put the smooth surface lower, and both antennas higher above it.
template <class Real, class Posts>
EMSCAPE_HD bool DiffractionColumn<Real, Posts>::isClearOfEarth(Real rx_m) const {
  const EffectiveHeights<Real> least = effectiveHeights(trend_, tx_, rx_m);
  return isClearThroughout(model_.earth, distance_m_,
                           sightLine(model_.earth, distance_m_, least.tx_m, least.rx_m));
}

/// What Bullington's loss lacks of the spherical earth's (dB).
template <class Real, class Posts>
EMSCAPE_HD Real DiffractionColumn<Real, Posts>::lackingDb(const Found& at) {
  TerrainTrend<Real> trend = trend_;
  trend.highest_m = at.highest_m;
  if (at.highest_m > 0) {
    trend.tx_angle = steepest_plain_ - at.slope;
    trend.rx_angle = at.slope + at.rx_plain_slope;
  }
  const EffectiveHeights<Real> heights = effectiveHeights(trend, tx_, at.rx_m);
  const Real spherical_db = sphericalEarthLossDb(model_.earth, distance_m_, heights.tx_m, heights.rx_m);
  if (spherical_db <= 0) return 0;
  if (smooth_.tx == 0) {
    const double d = double(distance_m_), k = double(model_.half_curvature);
    const double tx_m = double(heights.tx_m), height_m = double(heights.rx_m);
    const auto postAt = [&](double range_m) {
      const int post = posts_.lastBefore(range_m);
      return post < 1 ? 1 : post;
    };
    smooth_ = {postAt(std::sqrt(tx_m / k)), postAt(d - std::sqrt(height_m / k)),
               postAt(d * tx_m / (tx_m + height_m))};
  }
  const Real smooth_nu = smoothEarthNu(
      model_, [&](int i) { return Real(posts_.range_m(i)); }, posts_.count() - 1, distance_m_, heights,
      smooth_);
  const Real lacking_db = spherical_db - bullingtonLossDb(smooth_nu, distance_m_);
  return lacking_db > 0 ? lacking_db : Real(0);
}

template <class Real, class Posts>
template <int kReceivers>
EMSCAPE_HD bool DiffractionColumn<Real, Posts>::losses(const Real (&rx_msl_m)[kReceivers],
                                                       Real (&loss_db)[kReceivers]) {
  const Real infinity = Real(HUGE_VAL);
  const Real d = distance_m_, k = model_.half_curvature;
  const Real tx_slope = steepest_ + k * d;  // over the chord
  Real rx_m[kReceivers], slope[kReceivers];
  Real rx_slope[kReceivers], nu[kReceivers], highest_m[kReceivers], rx_plain_slope[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    rx_m[j] = model_.raised_m(rx_msl_m[j] - base_, trend_.rx_ground_msl_m);
    slope[j] = (rx_m[j] - tx_) / d;
    rx_slope[j] = nu[j] = highest_m[j] = rx_plain_slope[j] = -infinity;
  }
  // Slopes and clearance rise with the receiver: these hold for the lowest and the highest.
  const bool has_blocked = tx_slope >= slope[0], has_clear = !(tx_slope >= slope[kReceivers - 1]);
  const bool has_earth = !isClearOfEarth(rx_m[0]);
  const Real factor2 = 2 * d / model_.earth.wavelength_m;
  for (int i = 1; i < posts_.count(); ++i) {
    const Real range = Real(posts_.range_m(i)), beyond = d - range, height = heightOf(i);
    if (has_blocked || has_earth) {
      const Real inverse = 1 / beyond, bend = k * range;
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        const Real here = (height - rx_m[j]) * inverse;
        rx_slope[j] = here + bend > rx_slope[j] ? here + bend : rx_slope[j];
        rx_plain_slope[j] = here > rx_plain_slope[j] ? here : rx_plain_slope[j];
      }
    }
    if (has_earth) {
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        const Real above = height - tx_ - slope[j] * range;
        highest_m[j] = above > highest_m[j] ? above : highest_m[j];
      }
    }
    if (has_clear) {
      const Real factor = std::sqrt(factor2 / (range * beyond));
      const Real above = height - tx_ + k * range * beyond;
      EMSCAPE_UNROLL
      for (int j = 0; j < kReceivers; ++j) {
        const Real here = (above - slope[j] * range) * factor;
        nu[j] = here > nu[j] ? here : nu[j];
      }
    }
  }
  // What follows is long, and is there once: its loop is not unrolled.
  Found found[kReceivers];
  EMSCAPE_UNROLL
  for (int j = 0; j < kReceivers; ++j) {
    found[j] = {rx_m[j], slope[j], rx_slope[j], nu[j], highest_m[j], rx_plain_slope[j]};
  }
  bool is_free_above = false;
  for (int j = 0; j < kReceivers; ++j) {
    const Found& at = found[j];
    const Real edge_nu =
        tx_slope >= at.slope ? bullingtonEdgeNu(model_, d, at.slope, tx_slope, at.rx_slope) : at.nu;
    loss_db[j] = bullingtonLossDb(edge_nu, d);
    const bool is_clear_of_earth = !has_earth || isClearOfEarth(at.rx_m);
    if (!is_clear_of_earth) loss_db[j] += lackingDb(at);
    is_free_above = is_clear_of_earth && edge_nu <= kKnifeEdgeClear<Real>;
  }
  return is_free_above;
}

}  // namespace emscape::emfield
