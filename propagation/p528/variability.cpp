#include "propagation/p528/variability.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/math/device_math.h"
#include "propagation/normal_deviate.h"

namespace emscape::propagation {
namespace {

// P.528-5 Annex 2, section 17: Nakagami-Rice distributions, one row per K, one column per percentage.
constexpr int kPercentages = 17;
constexpr int kCurves = 17;
constexpr double kPercentage[kPercentages] = {1,  2,  5,  10, 15, 20, 30, 40, 50,
                                              60, 70, 80, 85, 90, 95, 98, 99};
constexpr double kK_db[kCurves] = {-40, -25, -20, -18, -16, -14, -12, -10, -8, -6, -4, -2, 0, 2, 4, 6, 20};
// clang-format off
constexpr double kFading_db[kCurves][kPercentages] = {
    {-0.1417, -0.1252, -0.1004, -0.0784, -0.0634, -0.0515, -0.0321, -0.0155, 0.0000, 0.0156, 0.0323, 0.0518, 0.0639, 0.0791, 0.1016, 0.1271, 0.1441},
    {-0.7676, -0.6811, -0.5497, -0.4312, -0.3504, -0.2856, -0.1790, -0.0870, 0.0000, 0.0878, 0.1828, 0.2953, 0.3651, 0.4537, 0.5868, 0.7390, 0.8420},
    {-1.3183, -1.1738, -0.9524, -0.7508, -0.6121, -0.5003, -0.3151, -0.1537, 0.0000, 0.1564, 0.3269, 0.5308, 0.6585, 0.8218, 1.0696, 1.3572, 1.5544},
    {-1.6263, -1.4507, -1.1805, -0.9332, -0.7623, -0.6240, -0.3940, -0.1926, 0.0000, 0.1969, 0.4127, 0.6722, 0.8355, 1.0453, 1.3660, 1.7417, 2.0014},
    {-1.9963, -1.7847, -1.4573, -1.1557, -0.9462, -0.7760, -0.4916, -0.2410, 0.0000, 0.2478, 0.5209, 0.8519, 1.0615, 1.3326, 1.7506, 2.2463, 2.5931},
    {-2.4355, -2.1829, -1.7896, -1.4247, -1.1695, -0.9613, -0.6113, -0.3007, 0.0000, 0.3114, 0.6573, 1.0802, 1.3505, 1.7028, 2.2526, 2.9156, 3.3872},
    {-2.9491, -2.6507, -2.1831, -1.7455, -1.4375, -1.1846, -0.7567, -0.3737, 0.0000, 0.3903, 0.8281, 1.3698, 1.7198, 2.1808, 2.9119, 3.8143, 4.4714},
    {-3.5384, -3.1902, -2.6407, -2.1218, -1.7535, -1.4495, -0.9307, -0.4619, 0.0000, 0.4874, 1.0404, 1.7348, 2.1898, 2.7975, 3.7820, 5.0373, 5.9833},
    {-4.1980, -3.7974, -3.1602, -2.5528, -2.1180, -1.7565, -1.1345, -0.5662, 0.0000, 0.6045, 1.2999, 2.1887, 2.7814, 3.5868, 4.9288, 6.7171, 8.1319},
    {-4.9132, -4.4591, -3.7313, -3.0306, -2.5247, -2.1011, -1.3655, -0.6855, 0.0000, 0.7415, 1.6078, 2.7374, 3.5059, 4.5714, 6.4060, 8.9732, 11.0973},
    {-5.6559, -5.1494, -4.3315, -3.5366, -2.9578, -2.4699, -1.6150, -0.8154, 0.0000, 0.8935, 1.9530, 3.3611, 4.3363, 5.7101, 8.1216, 11.5185, 14.2546},
    {-6.3810, -5.8252, -4.9219, -4.0366, -3.3871, -2.8364, -1.8638, -0.9455, 0.0000, 1.0458, 2.2979, 3.9771, 5.1450, 6.7874, 9.6276, 13.4690, 16.4251},
    {-7.0247, -6.4249, -5.4449, -4.4782, -3.7652, -3.1580, -2.0804, -1.0574, 0.0000, 1.1723, 2.5755, 4.4471, 5.7363, 7.5266, 10.5553, 14.5401, 17.5511},
    {-7.5229, -6.8862, -5.8424, -4.8090, -4.0446, -3.3927, -2.2344, -1.1347, 0.0000, 1.2535, 2.7446, 4.7144, 6.0581, 7.9073, 11.0003, 15.0270, 18.0526},
    {-7.8532, -7.1880, -6.0963, -5.0145, -4.2145, -3.5325, -2.3227, -1.1774, 0.0000, 1.2948, 2.8268, 4.8377, 6.2021, 8.0724, 11.1869, 15.2265, 18.2566},
    {-8.0435, -7.3588, -6.2354, -5.1234, -4.3022, -3.6032, -2.3656, -1.1975, 0.0000, 1.3130, 2.8619, 4.8888, 6.2610, 8.1388, 11.2607, 15.3047, 18.3361},
    {-8.2238, -7.5154, -6.3565, -5.2137, -4.3726, -3.6584, -2.3979, -1.2121, 0.0000, 1.3255, 2.8855, 4.9224, 6.2992, 8.1814, 11.3076, 15.3541, 18.3864},
};
// clang-format on

/// Position of a value between two entries of an ascending list; values outside are clamped to its ends.
struct ListPosition {
  int below;  ///< the entry below; the next one exists
  double fraction;
};
template <int kCount>
ListPosition positionIn(const double (&list)[kCount], double value) {
  const double bounded = std::clamp(value, list[0], list[kCount - 1]);
  const auto above = std::upper_bound(std::begin(list) + 1, std::end(list) - 1, bounded);
  const int below = static_cast<int>(above - std::begin(list)) - 1;
  return {below, (bounded - list[below]) / (list[below + 1] - list[below])};
}

/// Curves of a statistic against the effective distance [TN101, vol. 2, III]: rise to a crest, then fall to a
/// limit.
struct DistanceCurve {
  double c1, c2, c3, n1, n2, n3, limit_db, crest_db;

  double at(double effective_km) const {
    const double late_db = limit_db + (crest_db - limit_db) * std::exp(-c2 * std::pow(effective_km, n2));
    return (c1 * std::pow(effective_km, n1) - late_db) * std::exp(-c3 * std::pow(effective_km, n3)) + late_db;
  }
};
constexpr DistanceCurve kAt90{2.93e-4, 3.78e-8, 1.02e-7, 2.00, 2.88, 3.15, 3.2, 8.2};     // table III.4, A
constexpr DistanceCurve kAt10{5.25e-4, 1.57e-6, 4.70e-7, 1.97, 2.31, 2.90, 5.4, 10.0};    // table III.3, A
constexpr DistanceCurve kMedian{1.59e-5, 1.56e-11, 2.77e-8, 2.32, 4.08, 3.25, 0.0, 3.9};  // table III.5

// Below 10 % of the time: factor of the spread, and the largest level above free space.
constexpr double kRare[] = {1, 2, 5, 10};
constexpr double kRareFactor[] = {1.9507, 1.7166, 1.3265, 1.0000};
constexpr double kRareMost_db[] = {5.0, 4.5, 3.7, 0.0};

}  // namespace

P528Slow p528SlowVariability(double horizons_km, double distance_km, double frequency_mhz,
                             double time_percent, double angle_factor, double gain_db) {
  // effective distance (14-1) to (14-4)
  const double reach_km = horizons_km + 65 * std::cbrt(100 / frequency_mhz);
  const double effective_km =
      distance_km <= reach_km ? 130 * distance_km / reach_km : 130 + distance_km - reach_km;

  // (14-5), (14-6)
  double factor_10 = 1.05;
  double factor_90 = 1.05;
  if (frequency_mhz <= 1600) {
    const double wave = std::sin(5.22 * std::log10(frequency_mhz / 200));
    factor_10 = 0.21 * wave + 1.28;
    factor_90 = 0.18 * wave + 1.23;
  }
  const double median_db = kMedian.at(effective_km);
  const double spread_10_db = kAt10.at(effective_km) * factor_10;
  const double spread_90_db = kAt90.at(effective_km) * factor_90;

  const bool rare = time_percent < kRare[3];
  const ListPosition position = positionIn(kRare, time_percent);
  const auto rareValue = [&](const double(&values)[4]) {
    return lerp(values[position.below], values[position.below + 1], position.fraction);
  };
  double above_median_db = 0;
  if (rare) {
    above_median_db = rareValue(kRareFactor) * spread_10_db;
  } else if (time_percent < 50) {
    above_median_db = normalDeviate(time_percent / 100) / normalDeviate(0.1) * spread_10_db;
  } else if (time_percent > 50) {
    above_median_db = -normalDeviate(time_percent / 100) / normalDeviate(0.9) * spread_90_db;
  }

  // (14-20) to (14-25)
  const double excess_db = gain_db + angle_factor * (spread_10_db + median_db) - 3;
  const double adjustment_db = std::max(0.0, excess_db);
  double slow_db = angle_factor * (above_median_db + median_db) - adjustment_db;
  if (rare) slow_db = std::min(slow_db, rareValue(kRareMost_db) - gain_db);
  return {slow_db, adjustment_db};
}

double p528Fading_db(double k_db, double time_percent) {
  const ListPosition curve = positionIn(kK_db, k_db);
  const ListPosition column = positionIn(kPercentage, time_percent);
  const auto at = [&](int percentage) {
    return lerp(kFading_db[curve.below][percentage], kFading_db[curve.below + 1][percentage], curve.fraction);
  };
  return lerp(at(column.below), at(column.below + 1), column.fraction);
}

double p528KOfLossAt99Percent_db(double loss_db) {
  double losses_db[kCurves];
  for (int i = 0; i < kCurves; ++i) losses_db[i] = kFading_db[i][kPercentages - 1];
  const ListPosition position = positionIn(losses_db, loss_db);
  return lerp(kK_db[position.below], kK_db[position.below + 1], position.fraction);
}

double p528Combined_db(double slow_median_db, double slow_db, double fading_db, double time_percent) {
  const double spread_db = std::hypot(slow_db - slow_median_db, fading_db);
  return time_percent < 50 ? slow_median_db + spread_db : slow_median_db - spread_db;
}

}  // namespace emscape::propagation
