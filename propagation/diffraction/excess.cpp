// Delta-Bullington for a column of receivers by vector instructions: lanes hold posts.
//
// The first pass over the posts gives the steepest slope from the transmitter, and the slope of the line of
// sight above which every post is clear: nu of a post falls linearly with the receiver's height. Only
// receivers below that, or not clear of the smooth earth, are computed; the others have no loss. A single
// receiver takes one pass. Of many below the steepest ray some are computed first: the post that one sees
// highest is not farther from the transmitter than that of a lower one, so that those between need only the
// posts between.

#include "propagation/diffraction/excess.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/math/fast_math.h"
#include "base/math/simd.h"
#include "propagation/diffraction/bullington_lanes.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {
namespace {

constexpr int kLanes = 16;
static_assert(ExcessScratch::kMinPosts >= kLanes);
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using LaneBits = std::uint32_t __attribute__((vector_size(kLanes * sizeof(float))));

// Lanes are parameters by reference: as values they have no calling convention on all processors.

void load(const float* numbers, Lanes& lanes) {
  std::memcpy(&lanes, numbers, sizeof lanes);
}
void store(const Lanes& lanes, float* numbers) {
  std::memcpy(numbers, &lanes, sizeof lanes);
}
void setAll(float number, Lanes& lanes) {
  lanes = Lanes{} + number;
}
void takeLarger(const Lanes& other, Lanes& largest) {
  largest = other > largest ? other : largest;
}
float largestOf(const Lanes& lanes) {
  float numbers[kLanes];
  store(lanes, numbers);
  float largest = numbers[0];
#pragma omp simd reduction(max : largest)
  for (int i = 0; i < kLanes; ++i) largest = numbers[i] > largest ? numbers[i] : largest;
  return largest;
}

/// 1 / sqrt(x) for normal x > 0. @accuracy 2e-7 of itself
void inverseRoot(const Lanes& x, Lanes& root) {
  LaneBits bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits = 0x5f375a86u - (bits >> 1);
  std::memcpy(&root, &bits, sizeof root);
  const Lanes half = 0.5f * x;
  for (int i = 0; i < 3; ++i) root *= 1.5f - half * root * root;
}

/// The posts of a profile between the transmitter and the receivers over its end. Heights are above the first
/// post unless stated otherwise; "plain" values leave out the earth's bulge.
class LaneColumn {
 public:
  LaneColumn(const DiffractionExcess& excess, const ExcessColumn& column, const ExcessScratch& scratch)
      : model_(excess.model),
        column_(column),
        count_(column.profile.count - 2),
        base_msl_m_(column.profile.height_msl_m[0]),
        distance_m_(static_cast<float>(column.profile.range_m[count_ + 1])),
        ground_m_(column.profile.height_msl_m[count_ + 1] - base_msl_m_),
        tx_m_(model_.raised_m(excess.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / model_.earth.wavelength_m)),
        range_m_(scratch.even_ground_msl_m),
        above_tx_m_(scratch.post_numbers),
        rx_height_(above_tx_m_ + scratch.posts),
        rx_range_(rx_height_ + scratch.posts) {
    setPosts();
  }

  /// False if terrain is missing along the profile.
  bool isKnown() const { return is_known_; }

  /// Sets the losses (dB) of the first receivers. @return their number; the others have none
  int fill(float* loss_db) {
    if (column_.count == 1) {
      fillOne(*loss_db);
      return 1;
    }
    visitFirst<false>(0);
    const int lossy = firstOf(column_.count, [this](int k) {
      const float rx_m = heightOf(k);
      return slopeTo(rx_m) >= clear_slope_ && isClearOfEarth(rx_m);
    });
    if (lossy == 0) return 0;
    // Receivers at or below the ground are one and the same.
    const float ground_m = heightOf(0);
    const int lowest = std::max(firstOf(lossy, [&](int k) { return heightOf(k) > ground_m; }) - 1, 0);
    const int blocked = firstOf(lossy, [this](int k) { return slopeTo(heightOf(k)) > tx_slope_; });
    const int clear = firstOf(lossy, [this](int k) { return slopeTo(heightOf(k)) >= clear_slope_; });
    findRxSlopes(lowest, blocked, loss_db);
    eachGroup<4, Relative::nearest>(std::max(lowest, blocked), clear, 1, count_, loss_db);
    std::fill(loss_db + std::max(clear, lowest), loss_db + lossy, -HUGE_VALF);
    setLosses(lowest, lossy, loss_db);
    const int in_earth = firstOf(lossy, [this](int k) { return isClearOfEarth(heightOf(k)); });
    addEarth(lowest, in_earth, loss_db);
    std::fill(loss_db, loss_db + lowest, loss_db[lowest]);
    return lossy;
  }

 private:
  /// Measures of an obstacle's height above a line of sight, linear in the slope of the line.
  enum class Relative {
    rx_slope,        ///< slope from the receiver
    nearest,         ///< over sqrt(d1 d2)
    plain_rx_slope,  ///< rx_slope without the earth's bulge
    plain_height
  };
  /// Maxima of a receiver.
  struct Maxima {
    float rx_slope = -HUGE_VALF, nearest = -HUGE_VALF;
    float plain_rx_slope = -HUGE_VALF, plain_height_m = -HUGE_VALF;
  };

  /// The first number for which `is` holds, and with it for those above; count: for none.
  template <class Is>
  static int firstOf(int count, const Is& is) {
    int begin = 0;
    while (begin < count) {
      const int middle = (begin + count) / 2;
      if (is(middle)) {
        count = middle;
      } else {
        begin = middle + 1;
      }
    }
    return begin;
  }
  float heightOf(int k) const { return model_.raised_m(column_.height_msl_m[k] - base_msl_m_, ground_m_); }
  float slopeTo(float rx_m) const { return (rx_m - tx_m_) / distance_m_; }

  void setPosts() {
    const double* const ranges_m = column_.profile.range_m + 1;
    const float* const heights_msl_m = column_.profile.height_msl_m + 1;
    float *const range_m = range_m_, *const above_tx_m = above_tx_m_;
    const float base_msl_m = base_msl_m_, tx_m = tx_m_;
    const float farthest_m = distance_m_ * (1 - 2.4e-7f);  // a post may be at the receivers in float
    const int count = count_;
    float unknown = base_msl_m - base_msl_m + (heights_msl_m[count] - heights_msl_m[count]);
#pragma omp simd reduction(+ : unknown)
    for (int i = 0; i < count; ++i) {
      const auto exact = static_cast<float>(ranges_m[i]);
      range_m[i] = exact < farthest_m ? exact : farthest_m;
      above_tx_m[i] = heights_msl_m[i] - base_msl_m - tx_m;
      unknown += above_tx_m[i] - above_tx_m[i];
    }
    for (int i = count; count > 0 && i < kLanes; ++i) {
      range_m[i] = range_m[count - 1];
      above_tx_m[i] = above_tx_m[count - 1];
    }
    is_known_ = !std::isnan(unknown);
  }
  /// Calls visitOne(index) for the first of each kLanes posts among first..last, counted from 1; and perhaps
  /// for others.
  template <class Visit>
  void visit(int first, int last, const Visit& visitOne) const {
    const int farthest = std::max(count_ - kLanes, 0);
    for (int i = first - 1; i < last; i += kLanes) visitOne(std::min(i, farthest));
  }

  /// The first pass: maxima that are the same for all receivers, and those of one receiver, or what further
  /// passes read.
  /// @param slope  of the one receiver's line of sight
  template <bool kOne>
  Maxima visitFirst(float slope) {
    const float clearance = -kKnifeEdgeClear<float> / edge_scale_;
    Lanes tx, clear, plain_tx, rx, nearest, plain_rx, plain;
    setAll(-HUGE_VALF, tx);
    clear = plain_tx = rx = nearest = plain_rx = plain = tx;
    visit(1, count_, [&](int i) {
      Lanes range, above, root;
      load(range_m_ + i, range);
      load(above_tx_m_ + i, above);
      const Lanes beyond = distance_m_ - range, product = range * beyond;
      inverseRoot(product, root);
      const Lanes bulged = above + model_.half_curvature * product;
      const Lanes per_range = beyond * root, per_beyond = root * root * range;
      takeLarger(per_range * (bulged * root), tx);
      takeLarger(per_range * (above * root), plain_tx);
      if constexpr (kOne) {
        const Lanes line = slope * range, height = bulged - line;
        takeLarger(height * per_beyond, rx);
        takeLarger(height * root, nearest);
        takeLarger((above - line) * per_beyond, plain_rx);
        takeLarger(above - line, plain);
      } else {
        takeLarger(per_range * (bulged * root + clearance), clear);
        store(bulged * per_beyond, rx_height_ + i);
        store(range * per_beyond, rx_range_ + i);
      }
    });
    tx_slope_ = largestOf(tx);
    clear_slope_ = largestOf(clear);
    plain_tx_slope_ = largestOf(plain_tx);
    return {largestOf(rx), largestOf(nearest), largestOf(plain_rx), largestOf(plain)};
  }

  void fillOne(float& loss_db) {
    const float rx_m = heightOf(0), slope = slopeTo(rx_m);
    const Maxima maxima = visitFirst<true>(slope);
    loss_db = slope <= tx_slope_ ? maxima.rx_slope : maxima.nearest;
    setLosses(0, 1, &loss_db);
    if (!isClearOfEarth(rx_m)) {
      loss_db += earthCorrectionDb(rx_m, maxima.plain_rx_slope, maxima.plain_height_m);
    }
  }

  /// The terms of a measure for kLanes posts: height - slope * range.
  template <Relative kRelative>
  void findTerms(int i, Lanes& height, Lanes& range) const {
    constexpr bool is_rx = kRelative == Relative::rx_slope || kRelative == Relative::plain_rx_slope;
    load((is_rx ? rx_height_ : above_tx_m_) + i, height);
    load((is_rx ? rx_range_ : range_m_) + i, range);
    if constexpr (kRelative == Relative::plain_rx_slope) {
      Lanes range_m;
      load(range_m_ + i, range_m);
      height -= model_.half_curvature * range_m;
    } else if constexpr (kRelative == Relative::nearest) {
      const Lanes product = range * (distance_m_ - range);
      Lanes root;
      inverseRoot(product, root);
      height = (height + model_.half_curvature * product) * root;
      range *= root;
    }
  }
  /// Maxima over the posts first..last of receivers begin..end - 1, some at a time.
  template <int kReceivers, Relative kRelative>
  void eachGroup(int begin, int end, int first, int last, float* largest) const {
    for (int k = begin; k < end; k += kReceivers) {
      float slope[kReceivers];
      Lanes most[kReceivers];
      for (int j = 0; j < kReceivers; ++j) {
        slope[j] = slopeTo(heightOf(std::min(k + j, end - 1)));
        setAll(-HUGE_VALF, most[j]);
      }
      visit(first, last, [&](int i) {
        Lanes height, range;
        findTerms<kRelative>(i, height, range);
        for (int j = 0; j < kReceivers; ++j) takeLarger(height - slope[j] * range, most[j]);
      });
      for (int j = 0; j < kReceivers && k + j < end; ++j) largest[k + j] = largestOf(most[j]);
    }
  }

  /// Sets the largest slopes from receivers begin..end - 1, which are below the steepest ray.
  void findRxSlopes(int begin, int end, float* rx_slope) const {
    constexpr int kFirst = 8, kGaps = kFirst - 1;
    const int step = (end - 1 - begin) / kGaps;
    if (step < 2) return eachGroup<4, Relative::rx_slope>(begin, end, 1, count_, rx_slope);
    int highest[kFirst];
    findHighest<kFirst>(begin, step, rx_slope, highest);
    for (int gap = 0; gap < kGaps; ++gap) {
      const int at = begin + gap * step;
      eachGroup<4, Relative::rx_slope>(at + 1, at + step, std::min(highest[gap], highest[gap + 1]),
                                       std::max(highest[gap], highest[gap + 1]), rx_slope);
    }
    eachGroup<4, Relative::rx_slope>(begin + kGaps * step + 1, end, 1, highest[kGaps], rx_slope);
  }
  /// The same for receivers begin, begin + step and so on. @param at  receives the posts seen highest
  template <int kReceivers>
  void findHighest(int begin, int step, float* rx_slope, int (&at)[kReceivers]) const {
    float slope[kReceivers], lane[kLanes];
    Lanes most[kReceivers], at_lanes[kReceivers], of_lane;
    for (int i = 0; i < kLanes; ++i) lane[i] = static_cast<float>(i + 1);
    load(lane, of_lane);
    for (int j = 0; j < kReceivers; ++j) {
      slope[j] = slopeTo(heightOf(begin + j * step));
      setAll(-HUGE_VALF, most[j]);
      setAll(0, at_lanes[j]);
    }
    visit(1, count_, [&](int i) {
      Lanes height, range;
      findTerms<Relative::rx_slope>(i, height, range);
      const Lanes index = of_lane + static_cast<float>(i);
      for (int j = 0; j < kReceivers; ++j) {
        const Lanes here = height - slope[j] * range;
        at_lanes[j] = here > most[j] ? index : at_lanes[j];
        takeLarger(here, most[j]);
      }
    });
    for (int j = 0; j < kReceivers; ++j) {
      const float largest = largestOf(most[j]);
      Lanes number = at_lanes[j];
      number = most[j] == largest ? number : Lanes{};
      at[j] = std::clamp(static_cast<int>(largestOf(number)), 1, count_);
      rx_slope[begin + j * step] = largest;
    }
  }

  /// Replaces maxima of receivers begin..end - 1 by Bullington's losses (dB): rx_slope of those below the
  /// steepest ray, nearest of the others.
  void setLosses(int begin, int end, float* loss_db) const {
    const float* const height_msl_m = column_.height_msl_m;
    const float lowest_m = model_.raised_m(-HUGE_VALF, ground_m_);
    const float tx_slope = tx_slope_, tx_m = tx_m_, base_msl_m = base_msl_m_, distance_m = distance_m_;
    const float edge_scale = edge_scale_;
#pragma omp simd
    for (int k = begin; k < end; ++k) {
      const float height_m = height_msl_m[k] - base_msl_m;
      const float rx_m = height_m > lowest_m ? height_m : lowest_m;
      const float above = tx_slope - (rx_m - tx_m) / distance_m, largest = loss_db[k];
      const float product = above * largest;
      const float relative = above >= 0 ? std::sqrt(product > 0 ? product : 0.0f) : largest;
      loss_db[k] = bullingtonLossInLoopDb(edge_scale * relative, distance_m);
    }
  }
  /// Adds the smooth-earth correction of receivers begin..end - 1.
  void addEarth(int begin, int end, float* loss_db) {
    constexpr int kReceivers = 4;
    for (int first = begin; first < end; first += kReceivers) {
      const int count = std::min(kReceivers, end - first);
      float plain_rx_slope[kReceivers], height_m[kReceivers];
      std::fill_n(plain_rx_slope, kReceivers, -HUGE_VALF);
      std::fill_n(height_m, kReceivers, -HUGE_VALF);
      if (slopeTo(heightOf(first)) < plain_tx_slope_) {
        eachGroup<4, Relative::plain_rx_slope>(first, first + count, 1, count_, plain_rx_slope - first);
        eachGroup<4, Relative::plain_height>(first, first + count, 1, count_, height_m - first);
      }
      for (int j = 0; j < count; ++j) {
        loss_db[first + j] += earthCorrectionDb(heightOf(first + j), plain_rx_slope[j], height_m[j]);
      }
    }
  }

  /// The line fitted to the terrain.
  void findTrend() {
    if (has_trend_) return;
    has_trend_ = true;
    const double* const range_m = column_.profile.range_m;
    const float* const height_msl_m = column_.profile.height_msl_m;
    const auto base = static_cast<double>(base_msl_m_);
    const int last = count_ + 1;
    const double last_m = static_cast<double>(ground_m_) * (range_m[last] - range_m[last - 1]);
    double v1 = last_m, v2 = last_m * (2 * range_m[last] + range_m[last - 1]);
    // TerrainSums, post by post: each is in two intervals.
#pragma omp simd reduction(+ : v1, v2)
    for (int i = 1; i < last; ++i) {
      const double before = range_m[i - 1], beyond = range_m[i + 1];
      const double area = (static_cast<double>(height_msl_m[i]) - base) * (beyond - before);
      v1 += area;
      v2 += area * (before + range_m[i] + beyond);
    }
    const TerrainSums sums{v1, v2};
    trend_ = clearTrend(static_cast<float>(sums.start_m(range_m[last])),
                        static_cast<float>(sums.end_m(range_m[last])), ground_m_);
    if (model_.sea_by_height) {
      const double sea_m = lengthOverSea_m(
          count_ + 2, [=](int i) { return range_m[i]; }, [=](int i) { return height_msl_m[i]; });
      model_.earth.sea_fraction = static_cast<float>(sea_m / range_m[last]);
    }
  }

  /// True if the smooth earth has no loss for this receiver and those above. Obstacles above the line of
  /// sight only lower the smooth surface and so increase the heights of both antennas above it, which are at
  /// least those above their ground.
  bool isClearOfEarth(float rx_m) {
    if (isClearThroughout(model_.earth, distance_m_, tx_m_, rx_m - ground_m_)) return true;
    findTrend();
    const EffectiveHeights<float> least = effectiveHeights(trend_, tx_m_, rx_m);
    return isClearThroughout(model_.earth, distance_m_, least.tx_m, least.rx_m);
  }

  /// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
  /// @param plain_rx_slope, highest_m  the receiver's largest plain_rx_slope and plain_height
  /// @see P.526-15 eq. (68)
  float earthCorrectionDb(float rx_m, float plain_rx_slope, float highest_m) const {
    TerrainTrend<float> trend = trend_;
    trend.highest_m = highest_m;
    trend.tx_angle = plain_tx_slope_ - slopeTo(rx_m);
    trend.rx_angle = plain_rx_slope;
    const auto around = [this](float range_m) {
      const float* const first = range_m_;
      const float *const end = first + count_, *const after = std::lower_bound(first, end, range_m);
      PostsAround<float> found;
      if (after > first) found.before_m = after[-1];
      if (after < end) found.after_m = *after;
      return found;
    };
    DeltaBullington<float> earth;
    earth.effective = effectiveHeights(trend, tx_m_, rx_m);
    earth.addEarth(model_.earth, distance_m_,
                   [&] { return smoothEarthNu(model_, distance_m_, earth.effective, around); });
    return earth.loss_db;
  }

  DiffractionModel<float> model_;
  const ExcessColumn& column_;
  int count_;  ///< obstacles
  float base_msl_m_, distance_m_, ground_m_, tx_m_;
  float edge_scale_;  ///< from heights over sqrt(d1 d2) to nu
  bool is_known_ = true;
  // Of the obstacles, at least kLanes:
  float *range_m_, *above_tx_m_;
  float *rx_height_, *rx_range_;       ///< terms of rx_slope
  float tx_slope_ = -HUGE_VALF;        ///< largest slope from the transmitter to an obstacle
  float clear_slope_ = -HUGE_VALF;     ///< of the lowest line of sight that all obstacles are clear of
  float plain_tx_slope_ = -HUGE_VALF;  ///< tx_slope without the earth's bulge
  TerrainTrend<float> trend_{};
  bool has_trend_ = false;
};

EMSCAPE_SIMD_CLONES unsigned fillInLanes(const DiffractionExcess& excess, const ExcessColumn& column,
                                         const ExcessScratch& scratch, float* excess_db) {
  int lossy = 0;
  bool is_known = true;
  if (column.profile.count > 1) {
    LaneColumn receivers(excess, column, scratch);
    is_known = receivers.isKnown();
    if (is_known) lossy = receivers.fill(excess_db);
  }
  std::fill(excess_db + lossy, excess_db + column.count, is_known ? 0.0f : NAN);
  return is_known ? 0 : kMissingTerrain;
}

}  // namespace

unsigned DiffractionExcess::operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                       float* excess_db) const {
  return fillInLanes(*this, column, scratch, excess_db);
}

}  // namespace emscape::propagation
