// Delta-Bullington for a column of receivers by vector instructions.
//
// The first pass over the posts, in lanes, gives the steepest slope from the transmitter, and the slope of
// the line of sight above which every post is clear: nu of a post falls linearly with the receiver's height.
// Only receivers below that, or not clear of the smooth earth, are computed; the others have no loss. Posts
// that are the highest for none of them are left out. Then lanes hold receivers, for one remaining post after
// another.

#include "propagation/diffraction/excess.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/math/fast_math.h"
#include "base/math/lanes.h"
#include "base/math/simd.h"
#include "propagation/diffraction/bullington_lanes.h"
#include "propagation/diffraction/smooth_earth.h"

namespace emscape::propagation {
namespace {

/// Vectors of some lanes. Not wider than the processor's: g++ 12 computes the maxima of others one by one.
template <int kLanes>
struct LaneTypes;
template <>
struct LaneTypes<16> {
  using Floats = float __attribute__((vector_size(64)));
  using Bits = std::uint32_t __attribute__((vector_size(64)));
};
template <>
struct LaneTypes<8> {
  using Floats = float __attribute__((vector_size(32)));
  using Bits = std::uint32_t __attribute__((vector_size(32)));
};
constexpr int kMostLanes = 16;

template <class Lanes>
void setAll(float number, Lanes& lanes) {
  lanes = Lanes{} + number;
}
template <class Lanes>
void takeLarger(const Lanes& other, Lanes& largest) {
  largest = other > largest ? other : largest;
}
/// The larger numbers of two halves.
template <class Vector>
void halve(const float* numbers, Vector& larger) {
  Vector other;
  load(numbers, larger);
  load(numbers + sizeof larger / sizeof(float), other);
  larger = other > larger ? other : larger;
}
template <class Lanes>
float largestOf(const Lanes& lanes) {
  float numbers[sizeof lanes / sizeof(float)];
  float __attribute__((vector_size(32))) eight;
  float __attribute__((vector_size(16))) four;
  store(lanes, numbers);
  if constexpr (sizeof lanes > sizeof eight) {
    halve(numbers, eight);
    store(eight, numbers);
  }
  halve(numbers, four);
  const float first = four[0] > four[1] ? four[0] : four[1], second = four[2] > four[3] ? four[2] : four[3];
  return first > second ? first : second;
}

/// 1 / sqrt(x) for normal x > 0. @accuracy 2e-7 of itself
template <class LaneBits, class Lanes>
void inverseRoot(const Lanes& x, Lanes& root) {
  LaneBits bits;
  load(&x, bits);
  bits = 0x5f375a86u - (bits >> 1);
  store(bits, &root);
  const Lanes half = 0.5f * x;
  for (int i = 0; i < 3; ++i) root *= 1.5f - half * root * root;
}

/// The posts of a profile between the transmitter and the receivers over its end. Heights are above the first
/// post unless stated otherwise; "plain" values leave out the earth's bulge, and the clutter by which a
/// profile is raised.
template <int kLanes>
class LaneColumn {
 public:
  /// @param memory  kLaneArrays arrays
  /// @param size    of each: a multiple of kLanes, at least the number of the profile's posts
  LaneColumn(const DiffractionExcess& excess, const ExcessColumn& column, float* memory, std::size_t size)
      : model_(excess.model),
        column_(column),
        count_(column.profile.count - 2),
        base_msl_m_(column.profile.height_msl_m[0]),
        distance_m_(static_cast<float>(column.profile.range_m[count_ + 1])),
        ground_m_(column.profile.height_msl_m[count_ + 1] - base_msl_m_),
        tx_m_(model_.raised_m(excess.tx_msl_m - base_msl_m_, 0)),
        edge_scale_(std::sqrt(2 * distance_m_ / model_.earth.wavelength_m)),
        range_m_(memory),
        posts_{memory + size,     memory + 2 * size, memory + 3 * size,
               memory + 4 * size, memory + 5 * size, memory + 6 * size},
        is_raised_(column.profile.bare_msl_m != nullptr) {
    if (!is_raised_) posts_.plain_tx_m = posts_.above_tx_m;
    setPosts();
  }

  /// False if terrain is missing along the profile.
  bool isKnown() const { return is_known_; }

  /// Sets the losses (dB) of the first receivers. @return their number; the others have none
  int fill(float* loss_db) {
    visitFirst();
    const int lossy = firstOf(column_.count, [this](int k) {
      const float rx_m = heightOf(k);
      return slopeTo(rx_m) >= clear_slope_ && isClearOfEarth(rx_m);
    });
    if (lossy == 0) return 0;
    // Receivers at or below the ground are one and the same.
    const float ground_m = heightOf(0);
    const int lowest = std::max(firstOf(lossy, [&](int k) { return heightOf(k) > ground_m; }) - 1, 0);
    const int in_earth =
        isClearOfEarth(ground_m) ? 0 : firstOf(lossy, [this](int k) { return isClearOfEarth(heightOf(k)); });
    thin(slopeTo(heightOf(lowest)), slopeTo(heightOf(lossy - 1)), in_earth > lowest);
    for (int first = lowest; first < lossy; first += kLanes)
      setLosses(first, std::min(first + kLanes, lossy), in_earth, loss_db);
    std::fill(loss_db, loss_db + lowest, loss_db[lowest]);
    return lossy;
  }

 private:
  using Lanes = typename LaneTypes<kLanes>::Floats;
  using LaneBits = typename LaneTypes<kLanes>::Bits;

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

  /// Sets ranges and heights of the posts, and of copies of the last one to whole lanes.
  void setPosts() {
    const double* const ranges_m = column_.profile.range_m + 1;
    const float* const heights_msl_m = column_.profile.height_msl_m + 1;
    float *const range_m = range_m_, *const above_tx_m = posts_.above_tx_m;
    const float base_msl_m = base_msl_m_, tx_m = tx_m_;
    const float farthest_m = distance_m_ * static_cast<float>(kBeforeReceivers);
    const int count = count_;
    float unknown = base_msl_m - base_msl_m + (heights_msl_m[count] - heights_msl_m[count]);
#pragma omp simd reduction(+ : unknown)
    for (int i = 0; i < count; ++i) {
      const auto exact = static_cast<float>(ranges_m[i]);
      range_m[i] = exact < farthest_m ? exact : farthest_m;
      above_tx_m[i] = heights_msl_m[i] - base_msl_m - tx_m;
      unknown += above_tx_m[i] - above_tx_m[i];
    }
    if (is_raised_) {
      const float* const bare_msl_m = column_.profile.bare_msl_m + 1;
      float* const plain_tx_m = posts_.plain_tx_m;
#pragma omp simd
      for (int i = 0; i < count; ++i) plain_tx_m[i] = bare_msl_m[i] - base_msl_m - tx_m;
    }
    for (int i = count; i % kLanes != 0; ++i) {
      range_m[i] = range_m[count - 1];
      above_tx_m[i] = above_tx_m[count - 1];
      posts_.plain_tx_m[i] = posts_.plain_tx_m[count - 1];
    }
    is_known_ = !std::isnan(unknown);
  }

  /// The first pass: maxima that are the same for all receivers, and what further passes read.
  void visitFirst() {
    const float clearance = -kKnifeEdgeClear<float> / edge_scale_;
    Lanes tx, clear, plain_tx;
    setAll(-HUGE_VALF, tx);
    clear = plain_tx = tx;
    for (int i = 0; i < count_; i += kLanes) {
      Lanes range, above, plain, root;
      load(range_m_ + i, range);
      load(posts_.above_tx_m + i, above);
      load(posts_.plain_tx_m + i, plain);
      const Lanes beyond = distance_m_ - range, product = range * beyond;
      inverseRoot<LaneBits>(product, root);
      const Lanes over_root = (above + model_.half_curvature * product) * root, per_range = beyond * root;
      takeLarger(per_range * over_root, tx);
      takeLarger(per_range * (over_root + clearance), clear);
      takeLarger(per_range * (plain * root), plain_tx);
      store(over_root, posts_.height + i);
      store(range * root, posts_.range + i);
      store(range * root * root, posts_.per_beyond + i);
    }
    tx_slope_ = largestOf(tx);
    clear_slope_ = largestOf(clear);
    plain_tx_slope_ = largestOf(plain_tx);
  }

  /// Keeps posts among which are those of all maxima of the receivers from a lowest to a highest one.
  ///
  /// The measures of a post, seen from a receiver, are its height above the line of sight over sqrt(d1 d2),
  /// its slope, and without the earth's bulge slope and height. Each falls faster with the slope for farther
  /// posts. A post that does not exceed all nearer ones for the lowest receiver therefore exceeds none of
  /// them for a higher one, and one that does not exceed all farther ones for the highest receiver none of
  /// those for a lower one. Posts are compared with those of other blocks of lanes only. Receivers below the
  /// steepest ray need the slopes, those above it the heights over sqrt(d1 d2).
  /// @param in_earth  also the plain measures
  void thin(float lowest_slope, float highest_slope, bool in_earth) {
    struct Largest {
      float nearest = -HUGE_VALF, rx_slope = -HUGE_VALF, plain_rx_slope = -HUGE_VALF, plain_m = -HUGE_VALF;
    };
    /// By how much the posts of a block exceed those so far in some measure: `over`. @return false: none does
    const auto exceed = [&](int i, float slope, float rx_slope_at, float nearest_at, Largest& so_far,
                            Lanes& over) {
      Lanes range, height, range_m, plain_tx_m, per_beyond, plain_rx_slope, plain_m;
      load(posts_.range + i, range);
      load(posts_.height + i, height);
      const Lanes nearest = height - nearest_at * range, rx_slope = (height - rx_slope_at * range) * range;
      over = nearest - so_far.nearest;
      takeLarger(rx_slope - so_far.rx_slope, over);
      if (in_earth) {
        load(range_m_ + i, range_m);
        load(posts_.plain_tx_m + i, plain_tx_m);
        load(posts_.per_beyond + i, per_beyond);
        plain_m = plain_tx_m - slope * range_m;
        plain_rx_slope = plain_m * per_beyond;
        takeLarger(plain_rx_slope - so_far.plain_rx_slope, over);
        takeLarger(plain_m - so_far.plain_m, over);
      }
      if (!(largestOf(over) >= 0)) return false;
      so_far.nearest = std::max(so_far.nearest, largestOf(nearest));
      so_far.rx_slope = std::max(so_far.rx_slope, largestOf(rx_slope));
      if (in_earth) {
        so_far.plain_rx_slope = std::max(so_far.plain_rx_slope, largestOf(plain_rx_slope));
        so_far.plain_m = std::max(so_far.plain_m, largestOf(plain_m));
      }
      return true;
    };
    float* const under = posts_.range_m;  // minus the smaller of both; a block that is left out: infinite
    Largest nearer, farther;
    Lanes over, before;
    const int blocks = (count_ + kLanes - 1) / kLanes;
    for (int i = 0; i < blocks * kLanes; i += kLanes) {
      if (exceed(i, lowest_slope, lowest_slope, std::max(lowest_slope, tx_slope_), nearer, over)) {
        store(-over, under + i);
      } else {
        under[i] = HUGE_VALF;
      }
    }
    for (int i = (blocks - 1) * kLanes; i >= 0; i -= kLanes) {
      if (under[i] == HUGE_VALF) continue;
      if (exceed(i, highest_slope, std::min(highest_slope, tx_slope_), highest_slope, farther, over)) {
        load(under + i, before);
        takeLarger(-over, before);
        store(before, under + i);
      } else {
        under[i] = HUGE_VALF;
      }
    }
    candidates_ = 0;
    for (int block = 0; block < count_; block += kLanes) {
      if (under[block] == HUGE_VALF) continue;
      for (int i = block; i < std::min(block + kLanes, count_); ++i) {
        const int to = candidates_;
        candidates_ += under[i] <= 0 ? 1 : 0;
        posts_.height[to] = posts_.height[i];
        posts_.range[to] = posts_.range[i];
        posts_.plain_tx_m[to] = posts_.plain_tx_m[i];
        posts_.per_beyond[to] = posts_.per_beyond[i];
        posts_.range_m[to] = range_m_[i];
      }
    }
  }

  /// Sets the losses (dB) of receivers first..end - 1, at most kLanes.
  void setLosses(int first, int end, int in_earth, float* loss_db) {
    float number[kLanes];
    Lanes slope, nearest, rx_slope, plain_rx_slope, plain_m;
    for (int j = 0; j < kLanes; ++j) number[j] = slopeTo(heightOf(std::min(first + j, end - 1)));
    load(number, slope);
    setAll(-HUGE_VALF, nearest);
    rx_slope = plain_rx_slope = plain_m = nearest;
    const bool some_below = number[0] <= tx_slope_, some_above = !(number[kLanes - 1] <= tx_slope_);
    for (int i = 0; i < candidates_; ++i) {
      const float range = posts_.range[i];
      const Lanes above = posts_.height[i] - slope * range;
      if (some_above) takeLarger(above, nearest);
      if (some_below) takeLarger(above * range, rx_slope);
      if (first >= in_earth) continue;
      const Lanes plain = posts_.plain_tx_m[i] - slope * posts_.range_m[i];
      takeLarger(plain * posts_.per_beyond[i], plain_rx_slope);
      takeLarger(plain, plain_m);
    }
    float heights[kLanes], slopes[kLanes], loss_of[kLanes];
    store(nearest, heights);
    store(rx_slope, slopes);
    const float tx_slope = tx_slope_, edge_scale = edge_scale_, distance_m = distance_m_;
#pragma omp simd
    for (int j = 0; j < kLanes; ++j) {
      const float over = tx_slope - number[j], product = over * slopes[j];
      const float relative = over >= 0 ? std::sqrt(product > 0 ? product : 0.0f) : heights[j];
      loss_of[j] = bullingtonLossInLoopDb(edge_scale * relative, distance_m);
    }
    store(plain_rx_slope, slopes);
    store(plain_m, heights);
    for (int j = 0; j < end - first; ++j) {
      loss_db[first + j] = loss_of[j];
      if (first + j < in_earth)
        loss_db[first + j] += earthCorrectionDb(heightOf(first + j), slopes[j], heights[j]);
    }
  }

  /// The line fitted to the bare terrain.
  void findTrend() {
    if (has_trend_) return;
    has_trend_ = true;
    const double* const range_m = column_.profile.range_m;
    const float* const height_msl_m = column_.profile.ground_msl_m();
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
  float* range_m_;  ///< of the obstacles
  /// Of the obstacles; then of the candidates.
  struct {
    float* above_tx_m;
    float *height, *range;  ///< terms of the height above a line of sight over sqrt(d1 d2)
    float* range_m;         ///< of candidates alone
    float* plain_tx_m;      ///< above_tx_m of the bare ground
    float* per_beyond;      ///< 1 over the distance (m) from the receivers
  } posts_;
  bool is_raised_;
  int candidates_ = 0;
  float tx_slope_ = -HUGE_VALF;        ///< largest slope from the transmitter to an obstacle
  float clear_slope_ = -HUGE_VALF;     ///< of the lowest line of sight that all obstacles are clear of
  float plain_tx_slope_ = -HUGE_VALF;  ///< tx_slope without the earth's bulge
  TerrainTrend<float> trend_{};
  bool has_trend_ = false;
};

constexpr int kLaneArrays = 7;

template <int kLanes>
unsigned fillBy(const DiffractionExcess& excess, const ExcessColumn& column, float* memory, std::size_t size,
                float* excess_db) {
  int lossy = 0;
  bool is_known = true;
  if (column.profile.count > 1) {
    LaneColumn<kLanes> receivers(excess, column, memory, size);
    is_known = receivers.isKnown();
    if (is_known) lossy = receivers.fill(excess_db);
  }
  std::fill(excess_db + lossy, excess_db + column.count, is_known ? 0.0f : NAN);
  return is_known ? 0 : kMissingTerrain;
}

/// @param lanes  kMostLanes or 8
EMSCAPE_SIMD_CLONES unsigned fill(const DiffractionExcess& excess, const ExcessColumn& column, int lanes,
                                  float* memory, std::size_t size, float* excess_db) {
  return lanes == kMostLanes ? fillBy<kMostLanes>(excess, column, memory, size, excess_db)
                             : fillBy<8>(excess, column, memory, size, excess_db);
}

bool has16Lanes() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512vl") != 0;
#else
  return false;
#endif
}

}  // namespace

unsigned DiffractionExcess::fillByLanes(int lanes, const ExcessColumn& column, float* excess_db) const {
  thread_local std::vector<float> memory;
  const std::size_t size = (static_cast<std::size_t>(column.profile.count) / kMostLanes + 1) * kMostLanes;
  if (memory.size() < kLaneArrays * size) memory.resize(kLaneArrays * size);
  return fill(*this, column, lanes, memory.data(), size, excess_db);
}

unsigned DiffractionExcess::operator()(const ExcessColumn& column, const ExcessScratch&,
                                       float* excess_db) const {
  static const int lanes = has16Lanes() ? kMostLanes : 8;
  return fillByLanes(lanes, column, excess_db);
}

}  // namespace emscape::propagation
