// Delta-Bullington for a column of receivers by vector instructions: lanes hold posts.
//
// One pass over the posts gives the steepest slope from the transmitter, and the slope of the line of sight
// above which every post is clear: nu of a post falls linearly with the receiver's height. Only receivers
// below that, or not clear of the smooth earth, are computed, some at each further pass; the others have no
// loss. Of many receivers below the steepest ray some are computed first: the post that one sees highest is
// not farther from the transmitter than that of a lower one, so that those between need only the posts
// between.

#include "propagation/diffraction/excess.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/math/fast_math.h"
#include "base/math/simd.h"
#include "propagation/diffraction/bullington_lanes.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {
namespace {

constexpr int kLanes = 16;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

// Lanes are parameters by reference: as values they have no calling convention on all processors.

void load(const float* numbers, Lanes& lanes) {
  std::memcpy(&lanes, numbers, sizeof lanes);
}
void setAll(float number, Lanes& lanes) {
  lanes = Lanes{} + number;
}
void takeLarger(const Lanes& other, Lanes& largest) {
  largest = other > largest ? other : largest;
}
float largestOf(const Lanes& lanes) {
  float numbers[kLanes];
  std::memcpy(numbers, &lanes, sizeof lanes);
  float largest = numbers[0];
#pragma omp simd reduction(max : largest)
  for (int i = 0; i < kLanes; ++i) largest = numbers[i] > largest ? numbers[i] : largest;
  return largest;
}

/// 1 / sqrt(x) for a normal x > 0. @accuracy 2e-7 of itself
float inverseRoot(float x) {
  float root = fast_math_detail::floatOf(0x5f375a86u - (fast_math_detail::bitsOf(x) >> 1));
  const float half = 0.5f * x;
  for (int i = 0; i < 3; ++i) root = root * (1.5f - half * root * root);
  return root;
}

/// Posts between the transmitter and the receivers; heights above the first post of the profile.
struct Obstacles {
  Lanes range_m;
  Lanes inverse_root;  ///< 1 / sqrt(d1 d2)
  Lanes height_m;
  Lanes bulge_m;  ///< of the effective earth
  Lanes index;    ///< of the posts in the profile
};

/// Measures of an obstacle's height above a line of sight, linear in the slope of the line.
enum class Relative {
  rx_slope,        ///< slope from the receiver
  nearest,         ///< over sqrt(d1 d2)
  plain_rx_slope,  ///< rx_slope without the earth's bulge
  plain_height
};

/// Some receivers: heights above the first post, slopes of the lines of sight.
template <int kReceivers>
struct SomeReceivers {
  float rx_m[kReceivers], slope[kReceivers];
  int count;  ///< that count; the others are repetitions
};

/// The posts of a profile, and the receivers over its end.
/// @tparam kReceivers  that are computed at once
template <int kReceivers>
class LaneColumn {
 public:
  using Receivers = SomeReceivers<kReceivers>;

  LaneColumn(const DiffractionExcess& excess, const ExcessColumn& column, const ExcessScratch& scratch)
      : model_(excess.model),
        column_(column),
        count_(column.profile.count - 2),
        base_msl_m_(column.profile.height_msl_m[0]),
        distance_m_(static_cast<float>(column.profile.range_m[count_ + 1])),
        ground_m_(column.profile.height_msl_m[count_ + 1] - base_msl_m_),
        tx_m_(model_.raised_m(excess.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / model_.earth.wavelength_m)) {
    const bool is_short = count_ < kLanes;
    range_m_ = is_short ? few_[0] : scratch.even_ground_msl_m;
    inverse_root_ = is_short ? few_[1] : scratch.post_numbers;
    height_m_ = is_short ? few_[2] : scratch.post_numbers + scratch.posts;
    setPosts();
  }

  /// False if terrain is missing along the profile.
  bool isKnown() const { return is_known_; }

  /// Sets the losses (dB) of the first receivers. @return their number; the others have none
  int fill(float* loss_db) {
    findCommon();
    const int lossy = firstOf(column_.count, [this](int k) {
      const float rx_m = heightOf(k);
      return slopeTo(rx_m) >= clear_slope_ && isClearOfEarth(rx_m);
    });
    const int blocked = firstOf(lossy, [this](int k) { return slopeTo(heightOf(k)) > tx_slope_; });
    int k = 0;
    const auto fillTo = [&](int end) {
      for (; k < end; k += kReceivers) {
        const Receivers to = receivers(k, 1, std::min(kReceivers, lossy - k));
        setLosses(to, 1, count_, loss_db + k, 1);
      }
    };
    fillTo(firstOf(blocked, [this](int at) { return isClearOfEarth(heightOf(at)); }));
    if constexpr (kReceivers > 2) {
      constexpr int kGaps = kReceivers - 1;
      const int step = (blocked - 1 - k) / kGaps;
      if (step > 2) {
        int highest[kReceivers];
        const Receivers some = receivers(k, step, kReceivers);
        setLosses(some, findHighest(some, highest), loss_db + k, step);
        for (int gap = 0; gap < kGaps; ++gap) {
          const int first = k + gap * step, end = first + step;
          const int nearer = std::min(highest[gap], highest[gap + 1]);
          const int farther = std::max(highest[gap], highest[gap + 1]);
          for (int at = first + 1; at < end; at += kReceivers) {
            const Receivers between = receivers(at, 1, std::min(kReceivers, end - at));
            setLosses(between, nearer, farther, loss_db + at, 1);
          }
        }
        k += kGaps * step + 1;
      }
    }
    fillTo(lossy);
    return lossy;
  }

 private:
  struct Numbers {
    float of[kReceivers];
  };

  template <class Is>
  static int firstOf(int count, const Is& is) {
    int k = 0;
    while (k < count && !is(k)) ++k;
    return k;
  }
  float heightOf(int k) const { return model_.raised_m(column_.height_msl_m[k] - base_msl_m_, ground_m_); }
  float slopeTo(float rx_m) const { return (rx_m - tx_m_) / distance_m_; }
  Receivers receivers(int first, int step, int count) const {
    Receivers to;
    to.count = count;
    for (int j = 0; j < kReceivers; ++j) {
      to.rx_m[j] = heightOf(first + step * std::min(j, count - 1));
      to.slope[j] = slopeTo(to.rx_m[j]);
    }
    return to;
  }

  void setPosts() {
    const double* const ranges_m = column_.profile.range_m + 1;
    const float* const heights_msl_m = column_.profile.height_msl_m + 1;
    float *const range_m = range_m_, *const inverse_root = inverse_root_, *const height_m = height_m_;
    const float base_msl_m = base_msl_m_, distance_m = distance_m_;
    const float farthest_m = distance_m * (1 - 2.4e-7f);  // a post may be at the receivers in float
    const int count = count_;
    float unknown = base_msl_m - base_msl_m + (heights_msl_m[count] - heights_msl_m[count]);
#pragma omp simd reduction(+ : unknown)
    for (int i = 0; i < count; ++i) {
      const auto exact = static_cast<float>(ranges_m[i]);
      const float range = exact < farthest_m ? exact : farthest_m;
      range_m[i] = range;
      inverse_root[i] = inverseRoot(range * (distance_m - range));
      height_m[i] = heights_msl_m[i] - base_msl_m;
      unknown += height_m[i] - height_m[i];
    }
    for (int i = count; count > 0 && i < kLanes; ++i) {
      for (float* const of : {range_m, inverse_root, height_m}) of[i] = of[count - 1];
    }
    is_known_ = !std::isnan(unknown);
  }
  /// Calls visitOne(Obstacles) for the posts first..last, and perhaps for others.
  template <class Visit>
  void visit(int first, int last, const Visit& visitOne) const {
    const int farthest = std::max(count_ - kLanes, 0);
    float lane[kLanes];
    for (int i = 0; i < kLanes; ++i) lane[i] = static_cast<float>(i + 1);
    Obstacles posts;
    Lanes of_lane;
    load(lane, of_lane);
    for (int i = first - 1; i < last; i += kLanes) {
      const int begin = std::min(i, farthest);
      load(range_m_ + begin, posts.range_m);
      load(inverse_root_ + begin, posts.inverse_root);
      load(height_m_ + begin, posts.height_m);
      posts.bulge_m = model_.half_curvature * (posts.range_m * (distance_m_ - posts.range_m));
      posts.index = of_lane + static_cast<float>(begin);
      visitOne(posts);
    }
  }

  /// The first pass: maxima that are the same for all receivers.
  void findCommon() {
    const float clearance = -kKnifeEdgeClear<float> / edge_scale_;
    Lanes slope, clear, plain;
    setAll(-HUGE_VALF, slope);
    clear = plain = slope;
    visit(1, count_, [&](const Obstacles& posts) {
      const Lanes per_range = (distance_m_ - posts.range_m) * posts.inverse_root;
      const Lanes above = posts.height_m - tx_m_, here = (above + posts.bulge_m) * posts.inverse_root;
      takeLarger(per_range * here, slope);
      takeLarger(per_range * (here + clearance), clear);
      takeLarger(per_range * (above * posts.inverse_root), plain);
    });
    tx_slope_ = largestOf(slope);
    clear_slope_ = largestOf(clear);
    plain_tx_slope_ = largestOf(plain);
  }

  template <Relative kRelative>
  void measure(const Obstacles& posts, Lanes& height, Lanes& range) const {
    constexpr bool is_plain = kRelative == Relative::plain_rx_slope || kRelative == Relative::plain_height;
    height = posts.height_m - tx_m_;
    range = posts.range_m;
    if constexpr (!is_plain) height += posts.bulge_m;
    if constexpr (kRelative == Relative::nearest) {
      height *= posts.inverse_root;
      range *= posts.inverse_root;
    } else if constexpr (kRelative != Relative::plain_height) {
      const Lanes per_beyond = posts.inverse_root * posts.inverse_root * posts.range_m;
      height *= per_beyond;
      range *= per_beyond;
    }
  }
  /// Maxima over the posts first..last.
  template <Relative kRelative>
  Numbers largest(const Receivers& to, int first, int last) const {
    Lanes most[kReceivers];
    for (Lanes& lanes : most) setAll(-HUGE_VALF, lanes);
    visit(first, last, [&](const Obstacles& posts) {
      Lanes height, range;
      measure<kRelative>(posts, height, range);
      for (int j = 0; j < kReceivers; ++j) takeLarger(height - to.slope[j] * range, most[j]);
    });
    Numbers largest;
    for (int j = 0; j < kReceivers; ++j) largest.of[j] = largestOf(most[j]);
    return largest;
  }
  /// rx_slope over all posts. @param at  receives the posts where it is largest
  Numbers findHighest(const Receivers& to, int (&at)[kReceivers]) const {
    Lanes most[kReceivers], at_lanes[kReceivers];
    for (int j = 0; j < kReceivers; ++j) {
      setAll(-HUGE_VALF, most[j]);
      setAll(0, at_lanes[j]);
    }
    visit(1, count_, [&](const Obstacles& posts) {
      Lanes height, range;
      measure<Relative::rx_slope>(posts, height, range);
      for (int j = 0; j < kReceivers; ++j) {
        const Lanes here = height - to.slope[j] * range;
        at_lanes[j] = here > most[j] ? posts.index : at_lanes[j];
        takeLarger(here, most[j]);
      }
    });
    Numbers largest;
    for (int j = 0; j < kReceivers; ++j) {
      float values[kLanes], numbers[kLanes];
      std::memcpy(values, &most[j], sizeof values);
      std::memcpy(numbers, &at_lanes[j], sizeof numbers);
      largest.of[j] = largestOf(most[j]);
      float number = 0;
      for (int i = 0; i < kLanes; ++i) number = values[i] == largest.of[j] ? numbers[i] : number;
      at[j] = std::clamp(static_cast<int>(number), 1, count_);
    }
    return largest;
  }

  /// @param first, last  for blocked receivers: the posts among which is the one that each sees highest
  void setLosses(const Receivers& to, int first, int last, float* loss_db, int step) {
    Numbers rx_slope{};
    if (to.slope[0] <= tx_slope_) rx_slope = largest<Relative::rx_slope>(to, first, last);
    setLosses(to, rx_slope, loss_db, step);
  }
  /// @param rx_slope  of blocked receivers
  void setLosses(const Receivers& to, const Numbers& rx_slope, float* loss_db, int step) {
    Numbers nearest, plain_rx_slope, highest_m;
    if (to.slope[0] < clear_slope_ && to.slope[kReceivers - 1] > tx_slope_) {
      nearest = largest<Relative::nearest>(to, 1, count_);
    } else {
      std::fill_n(nearest.of, kReceivers, -HUGE_VALF);
    }
    const bool has_earth = !isClearOfEarth(to.rx_m[0]);
    if (has_earth && to.slope[0] < plain_tx_slope_) {
      plain_rx_slope = largest<Relative::plain_rx_slope>(to, 1, count_);
      highest_m = largest<Relative::plain_height>(to, 1, count_);
    } else {
      std::fill_n(plain_rx_slope.of, kReceivers, -HUGE_VALF);
      std::fill_n(highest_m.of, kReceivers, -HUGE_VALF);
    }
    float found_db[kReceivers];
#pragma omp simd
    for (int j = 0; j < kReceivers; ++j) {
      const float tx_slope = tx_slope_ - to.slope[j];
      const float product = tx_slope * rx_slope.of[j];
      const float relative = tx_slope >= 0 ? std::sqrt(product > 0 ? product : 0.0f) : nearest.of[j];
      found_db[j] = bullingtonLossInLoopDb(edge_scale_ * relative, distance_m_);
    }
    for (int j = 0; j < to.count; ++j) {
      if (has_earth) {
        found_db[j] += earthCorrectionDb(to.rx_m[j], to.slope[j], plain_rx_slope.of[j], highest_m.of[j]);
      }
      loss_db[j * step] = found_db[j];
    }
  }

  /// The line fitted to the terrain.
  void findTrend() {
    if (has_trend_) return;
    has_trend_ = true;
    const double* const range_m = column_.profile.range_m;
    const float* const height_msl_m = column_.profile.height_msl_m;
    const auto base = static_cast<double>(base_msl_m_);
    double v1 = 0, v2 = 0;
#pragma omp simd reduction(+ : v1, v2)
    for (int i = 1; i <= count_ + 1; ++i) {
      const double before = range_m[i - 1], here = range_m[i];
      const double h_before = static_cast<double>(height_msl_m[i - 1]) - base;
      const double h = static_cast<double>(height_msl_m[i]) - base;
      v1 += (here - before) * (h + h_before);
      v2 += (here - before) * (h * (2 * here + before) + h_before * (here + 2 * before));
    }
    const TerrainSums sums{v1, v2};
    trend_.start_msl_m = static_cast<float>(sums.start_m(range_m[count_ + 1]));
    trend_.end_msl_m = static_cast<float>(sums.end_m(range_m[count_ + 1]));
    trend_.tx_ground_msl_m = 0;
    trend_.rx_ground_msl_m = ground_m_;
    trend_.highest_m = -HUGE_VALF;
    if (model_.sea_by_height) {
      const double sea_m = lengthOverSea_m(
          count_ + 2, [=](int i) { return range_m[i]; }, [=](int i) { return height_msl_m[i]; });
      model_.earth.sea_fraction = static_cast<float>(sea_m / range_m[count_ + 1]);
    }
  }

  /// True if the smooth earth has no loss for this receiver and those above. Obstacles above the line of
  /// sight only lower the smooth surface and so increase the heights of both antennas above it, which are at
  /// least those above their ground.
  bool isClearOfEarth(float rx_m) {
    const auto isClear = [this](float tx, float rx) {
      return isClearThroughout(model_.earth, distance_m_, sightLine(model_.earth, distance_m_, tx, rx));
    };
    if (isClear(tx_m_, rx_m - ground_m_)) return true;
    findTrend();
    const EffectiveHeights<float> least = effectiveHeights(trend_, tx_m_, rx_m);
    return isClear(least.tx_m, least.rx_m);
  }

  /// Smooth-earth correction (dB): the spherical earth's loss minus Bullington's, at least 0.
  /// @param plain_rx_slope, highest_m  the receiver's largest plain_rx_slope and plain_height
  /// @see P.526-15 eq. (68)
  float earthCorrectionDb(float rx_m, float slope, float plain_rx_slope, float highest_m) const {
    TerrainTrend<float> trend = trend_;
    trend.highest_m = highest_m;
    trend.tx_angle = plain_tx_slope_ - slope;
    trend.rx_angle = plain_rx_slope;
    const EffectiveHeights<float> heights = effectiveHeights(trend, tx_m_, rx_m);
    const float spherical_db = sphericalEarthLossDb(model_.earth, distance_m_, heights.tx_m, heights.rx_m);
    if (!(spherical_db > 0)) return 0;
    if (count_ < 1) return spherical_db;
    const auto lastBefore = [this](float range_m) {
      const int nearer = static_cast<int>(std::lower_bound(range_m_, range_m_ + count_, range_m) - range_m_);
      return std::max(nearer, 1);
    };
    int clear = lastBefore(distance_m_ * heights.tx_m / (heights.tx_m + heights.rx_m));
    const float nu = smoothEarthNu(
        model_, [this](int i) { return range_m_[i - 1]; }, lastBefore, count_, distance_m_, heights, clear);
    return std::max(spherical_db - bullingtonLossDb(nu, distance_m_), 0.0f);
  }

  DiffractionModel<float> model_;
  const ExcessColumn& column_;
  int count_;  ///< obstacles
  float base_msl_m_, distance_m_, ground_m_, tx_m_;
  float edge_scale_;  ///< from heights over sqrt(d1 d2) to nu
  bool is_known_ = true;
  float *range_m_, *inverse_root_, *height_m_;  ///< of the obstacles, at least kLanes
  float few_[3][kLanes];
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
  const auto fill = [&](auto&& receivers) {
    is_known = receivers.isKnown();
    if (is_known) lossy = receivers.fill(excess_db);
  };
  if (column.profile.count > 1) {
    if (column.count == 1) {
      fill(LaneColumn<1>(excess, column, scratch));
    } else {
      fill(LaneColumn<8>(excess, column, scratch));
    }
  }
  std::fill(excess_db + lossy, excess_db + column.count, is_known ? 0.0f : NAN);
  return is_known ? 0 : kMissingTerrain;
}

}  // namespace

unsigned DiffractionExcess::fillCpu(const ExcessColumn& column, const ExcessScratch& scratch,
                                    float* excess_db) const {
  return fillInLanes(*this, column, scratch, excess_db);
}

}  // namespace emscape::propagation
