/// Delta-Bullington for a whole plane: one walk along an azimuth, a column of receivers at each post.
///
/// Agrees with deltaBullington (diffraction.h) path by path, and takes a fraction of its time, as nothing
/// that depends on the posts before a receiver is looked for anew:
/// - The transmitter's steepest ray, and the terrain's trend, are running values.
/// - The receiver's steepest ray touches the upper hull of the terrain before it, lowered by the earth's
///   bulge d^2 / (2 a) below the transmitter's horizontal plane, in which rays to all receivers are straight.
///   Going up a column, the point of contact only moves toward the transmitter. The same holds for the hull
///   of the plain heights, which the effective heights ask for.
/// - On clear paths nu of each post falls linearly with the receiver's height, the more steeply the nearer
///   the post: the largest nu of all is the upper envelope of these lines, already sorted. Posts whose nu
///   is below -0.78 at the lowest clear receiver matter to none and are passed over.
/// - Over the smooth earth the slopes and nu have one largest value, found from the last one by walking.
/// - Once a receiver is clear of everything with the greatest reserve, those above it are too.
#pragma once

#include <cmath>
#include <vector>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {

/// Memory of a sweep: arrays of as many elements as the profile has posts.
template <class Real>
struct DiffractionScratch {
  Real* inverse_range = nullptr;
  Real* lowered_m = nullptr;  ///< height less the bulge
  Real* slope = nullptr;      ///< from the transmitter, lowered
  Real* line_nu = nullptr;    ///< the envelope's lines at the lowest clear receiver,
  Real* line_fall = nullptr;  ///< and how much they fall for each metre
  int* lowered_hull = nullptr;
  int* plain_hull = nullptr;
};

/// Holds it on the host.
template <class Real>
class DiffractionMemory {
 public:
  explicit DiffractionMemory(int posts)
      : posts_(posts), reals_(5 * std::size_t(posts)), ints_(2 * std::size_t(posts)) {}

  DiffractionScratch<Real> scratch() {
    Real* r = reals_.data();
    return {
        r, r + posts_, r + 2 * posts_, r + 3 * posts_, r + 4 * posts_, ints_.data(), ints_.data() + posts_};
  }

 private:
  int posts_;
  std::vector<Real> reals_;
  std::vector<int> ints_;
};

/// The upper hull of points given from left to right.
template <class Real>
struct UpperHull {
  int* points = nullptr;
  int count = 0;

  template <class X, class Y>
  EMSCAPE_HD void add(int point, X x, Y y) {
    while (count >= 2) {
      const int a = points[count - 2], b = points[count - 1];
      if ((y(b) - y(a)) * (x(point) - x(a)) > (y(point) - y(a)) * (x(b) - x(a))) break;
      --count;
    }
    points[count++] = point;
  }

  /// Goes from position `at` toward the hull's start as long as a function of the point rises.
  /// @return the largest value
  template <class Value>
  EMSCAPE_HD Real climb(int& at, Value value) const {
    Real best = value(points[at]);
    while (at > 0) {
      const Real next = value(points[at - 1]);
      if (next < best) break;
      best = next;
      --at;
    }
    return best;
  }
};

/// A walk along one azimuth. Plain data: one thread an azimuth.
template <class Real>
class DiffractionSweep {
 public:
  /// Stands at the profile's first post, the transmitter.
  /// @param profile   stays alive, as does the scratch memory
  /// @param tx_msl_m  of the antenna; see kDiffractionAboveGround
  EMSCAPE_HD DiffractionSweep(const DiffractionModel<Real>& model, const TerrainProfile& profile,
                              Real tx_msl_m, const DiffractionScratch<Real>& scratch)
      : model_(model), profile_(profile), scratch_(scratch), base_(Real(profile.height_msl_m[0])) {
    tx_ = model.raised_m(tx_msl_m - base_, 0);
    lowered_hull_.points = scratch.lowered_hull;
    plain_hull_.points = scratch.plain_hull;
  }

  /// The post above which the receivers stand.
  EMSCAPE_HD int post() const { return post_; }

  /// Goes on to the next post, which must exist.
  EMSCAPE_HD void advance() {
    if (post_ > 0) addObstacle(post_);
    ++post_;
    sums_.add(profile_, post_);
  }

  /// Losses (dB) of receivers above the current post.
  /// @param rx_msl_m  `count` heights (m), rising; see kDiffractionAboveGround
  /// @param loss_db   `count` results; 0 at the first post, NaN from missing terrain (NaN) on
  EMSCAPE_HD void column(const Real* rx_msl_m, int count, Real* loss_db);

 private:
  /// A column of receivers, on the way up.
  struct Column {
    Real distance_m = 0;
    TerrainTrend<Real> trend{};                         ///< as long as no obstacle is over the line of sight
    int touching = 0, highest = 0, touching_plain = 0;  ///< positions on the hulls
    bool has_envelope = false;                          ///< of nu, for the clear receivers
    int line = -1;
    Real lowest_clear_m = 0;
  };

  EMSCAPE_HD Real heightOf(int i) const { return Real(profile_.height_msl_m[i]) - base_; }
  EMSCAPE_HD Real rangeOf(int i) const { return Real(profile_.range_m[i]); }
  EMSCAPE_HD void addObstacle(int i);
  EMSCAPE_HD Real terrainNu(Column& column, Real rx_m, Real slope);
  EMSCAPE_HD int firstClearOfEarth(const Column& column, const Real* rx_msl_m, int count);
  EMSCAPE_HD Real lackingDb(Column& column, Real rx_m, Real slope);
  EMSCAPE_HD int makeEnvelope(Real distance_m, Real lowest_m);

  DiffractionModel<Real> model_;
  TerrainProfile profile_;
  DiffractionScratch<Real> scratch_;
  Real base_;  ///< all heights are from the first post's
  Real tx_;
  int post_ = 0;
  TerrainSums sums_;
  UpperHull<Real> lowered_hull_, plain_hull_;
  Real steepest_ = -Real(HUGE_VAL);        ///< slope from the transmitter to an obstacle, lowered
  Real steepest_plain_ = -Real(HUGE_VAL);  ///< the same to the plain heights
  // what was found last time: it moves little from post to post
  int first_clear_ = 0;
  SmoothEarthPosts smooth_;
};

template <class Real>
EMSCAPE_HD void DiffractionSweep<Real>::addObstacle(int i) {
  const Real range_m = rangeOf(i), height_m = heightOf(i);
  const Real lowered_m = height_m - model_.half_curvature * range_m * range_m;
  const Real slope = (lowered_m - tx_) / range_m, plain_slope = (height_m - tx_) / range_m;
  scratch_.inverse_range[i] = 1 / range_m;
  scratch_.lowered_m[i] = lowered_m;
  scratch_.slope[i] = slope;
  steepest_ = slope > steepest_ ? slope : steepest_;
  steepest_plain_ = plain_slope > steepest_plain_ ? plain_slope : steepest_plain_;
  const auto x = [&](int post) { return rangeOf(post); };
  lowered_hull_.add(i, x, [&](int post) { return scratch_.lowered_m[post]; });
  plain_hull_.add(i, x, [&](int post) { return heightOf(post); });
}

/// Lines of nu over the receiver's height above the lowest clear one, as far as they are ever the highest and
/// above -0.78; the one that is highest there comes last.
/// @return their number
template <class Real>
EMSCAPE_HD int DiffractionSweep<Real>::makeEnvelope(Real distance_m, Real lowest_m) {
  const Real slope = (lowest_m - tx_) / distance_m - model_.half_curvature * distance_m;  // lowered
  const Real inverse = 1 / distance_m;
  // (d1 (slope - slope_i))^2 2 d / (lambda d1 d2) <= 0.78^2
  const Real reach =
      kKnifeEdgeClear<Real> * kKnifeEdgeClear<Real> / 2 * model_.earth.wavelength_m * Real(1.001);
  int count = 0;
  for (int i = 1; i < post_; ++i) {
    const Real below = slope - scratch_.slope[i];
    if (below * below > reach * (scratch_.inverse_range[i] - inverse)) continue;
    const Real d1 = rangeOf(i), d2 = distance_m - d1;
    const Real factor = std::sqrt(2 * distance_m / (model_.earth.wavelength_m * d1 * d2));
    const Real nu = -below * d1 * factor;
    const Real fall = d1 * inverse * factor;
    // Falls grow with i: the new line is the highest to the left, from where it crosses the last.
    if (count > 0 && nu <= scratch_.line_nu[count - 1]) continue;
    while (count >= 2) {
      const Real fall_a = scratch_.line_fall[count - 2], fall_b = scratch_.line_fall[count - 1];
      const Real nu_a = scratch_.line_nu[count - 2], nu_b = scratch_.line_nu[count - 1];
      // b is under where a and the new line cross
      if ((nu - nu_b) * (fall_b - fall_a) < (nu_b - nu_a) * (fall - fall_b)) break;
      --count;
    }
    scratch_.line_nu[count] = nu;
    scratch_.line_fall[count] = fall;
    ++count;
  }
  return count;
}

/// nu of the terrain's edge; -infinity without a post between.
template <class Real>
EMSCAPE_HD Real DiffractionSweep<Real>::terrainNu(Column& column, Real rx_m, Real slope) {
  if (post_ < 2) return -Real(HUGE_VAL);
  const Real d = column.distance_m;
  const Real bulge = model_.half_curvature * d;  // between slopes over the chord and lowered ones
  const Real tx_slope = steepest_ + bulge;
  if (tx_slope >= slope) {
    const Real rx_lowered = rx_m - bulge * d;
    const auto rxSlope = [&](int i) { return (scratch_.lowered_m[i] - rx_lowered) / (d - rangeOf(i)); };
    const Real rx_slope = lowered_hull_.climb(column.touching, rxSlope) - bulge;
    return bullingtonEdgeNu(model_, d, slope, tx_slope, rx_slope);
  }
  if (!column.has_envelope) {
    column.has_envelope = true;
    column.lowest_clear_m = rx_m;
    column.line = makeEnvelope(d, rx_m) - 1;
  }
  if (column.line < 0) return -Real(HUGE_VAL);
  const Real above_m = rx_m - column.lowest_clear_m;
  const auto nuOn = [&](int l) { return scratch_.line_nu[l] - scratch_.line_fall[l] * above_m; };
  while (column.line > 0 && nuOn(column.line - 1) >= nuOn(column.line)) --column.line;
  return nuOn(column.line);
}

/// The first of the receivers from which on the smooth earth has no loss, or `count`.
template <class Real>
EMSCAPE_HD int DiffractionSweep<Real>::firstClearOfEarth(const Column& column, const Real* rx_msl_m,
                                                         int count) {
  // Obstacles over the line of sight would put the smooth surface lower, and both antennas higher above it:
  // what is clear without them is clear.
  const auto isClear = [&](int j) {
    const Real rx_m = model_.raised_m(rx_msl_m[j] - base_, column.trend.rx_ground_msl_m);
    const EffectiveHeights<Real> least = effectiveHeights(column.trend, tx_, rx_m);
    return isClearThroughout(model_.earth, column.distance_m,
                             sightLine(model_.earth, column.distance_m, least.tx_m, least.rx_m));
  };
  // From the last column's answer in doubling steps, then by halves.
  int begin = 0, end = count;
  int probe = first_clear_ < count ? first_clear_ : count - 1;
  for (int step = 1; begin < end; step *= 2) {
    if (isClear(probe)) {
      end = probe;
      const int middle = (begin + end) / 2;
      probe = end - step > middle ? end - step : middle;
    } else {
      begin = probe + 1;
      const int middle = (begin + end) / 2;
      probe = begin + step - 1 < middle ? begin + step - 1 : middle;
    }
  }
  first_clear_ = begin;
  return begin;
}

/// What Bullington's loss lacks of the spherical earth's (dB).
template <class Real>
EMSCAPE_HD Real DiffractionSweep<Real>::lackingDb(Column& column, Real rx_m, Real slope) {
  const Real d = column.distance_m;
  TerrainTrend<Real> trend = column.trend;
  if (post_ > 1) {
    trend.highest_m =
        plain_hull_.climb(column.highest, [&](int i) { return heightOf(i) - tx_ - slope * rangeOf(i); });
    if (trend.highest_m > 0) {
      trend.tx_angle = steepest_plain_ - slope;
      trend.rx_angle = slope + plain_hull_.climb(column.touching_plain, [&](int i) {
        return (heightOf(i) - rx_m) / (d - rangeOf(i));
      });
    }
  }
  const EffectiveHeights<Real> heights = effectiveHeights(trend, tx_, rx_m);
  const Real spherical_db = sphericalEarthLossDb(model_.earth, d, heights.tx_m, heights.rx_m);
  if (spherical_db <= 0) return 0;
  const int last = post_ - 1;
  const auto ranges = [&](int i) { return rangeOf(i); };
  const Real smooth_nu = smoothEarthNu(
      model_, ranges, [&](Real range_m) { return walkTo(smooth_.tx, range_m, last, ranges); },
      [&](Real range_m) { return walkTo(smooth_.rx, range_m, last, ranges); }, last, d, heights,
      smooth_.clear);
  const Real lacking_db = spherical_db - bullingtonLossDb(smooth_nu, d);
  return lacking_db > 0 ? lacking_db : Real(0);
}

template <class Real>
EMSCAPE_HD void DiffractionSweep<Real>::column(const Real* rx_msl_m, int count, Real* loss_db) {
  const bool is_unknown = std::isnan(sums_.v1) || std::isnan(base_);
  if (post_ == 0 || is_unknown) {
    for (int j = 0; j < count; ++j) loss_db[j] = is_unknown ? Real(NAN) : Real(0);
    return;
  }
  const double distance_m = profile_.range_m[post_];
  Column column;
  column.distance_m = Real(distance_m);
  column.trend.start_msl_m = Real(sums_.start_m(distance_m));
  column.trend.end_msl_m = Real(sums_.end_m(distance_m));
  column.trend.tx_ground_msl_m = 0;
  column.trend.rx_ground_msl_m = heightOf(post_);
  column.trend.highest_m = -Real(HUGE_VAL);
  column.touching = lowered_hull_.count - 1;
  column.highest = column.touching_plain = plain_hull_.count - 1;
  Real below_m = -Real(HUGE_VAL);  // the last receiver
  const int first_clear = firstClearOfEarth(column, rx_msl_m, count);
  for (int j = 0; j < count; ++j) {
    const Real rx_m = model_.raised_m(rx_msl_m[j] - base_, column.trend.rx_ground_msl_m);
    if (rx_m == below_m) {
      loss_db[j] = loss_db[j - 1];
      continue;
    }
    below_m = rx_m;
    const Real slope = (rx_m - tx_) / column.distance_m;
    const Real nu = terrainNu(column, rx_m, slope);
    loss_db[j] = bullingtonLossDb(nu, column.distance_m);
    if (j < first_clear) {
      loss_db[j] += lackingDb(column, rx_m, slope);
    } else if (nu <= kKnifeEdgeClear<Real>) {
      for (++j; j < count; ++j) loss_db[j] = 0;
    }
  }
}

/// A plane of losses: receivers at the same heights above every post.
/// @param heights_msl_m  `height_count` heights (m), rising
/// @param loss_db        posts x height_count, height fastest; see DiffractionSweep::column
template <class Real>
EMSCAPE_HD void diffractionPlane(const DiffractionModel<Real>& model, const TerrainProfile& profile,
                                 Real tx_msl_m, const Real* heights_msl_m, int height_count,
                                 const DiffractionScratch<Real>& scratch, Real* loss_db) {
  DiffractionSweep<Real> sweep(model, profile, tx_msl_m, scratch);
  for (int post = 0; post < profile.count; ++post) {
    if (post > 0) sweep.advance();
    sweep.column(heights_msl_m, height_count, loss_db + std::size_t(post) * std::size_t(height_count));
  }
}

}  // namespace emscape::propagation
