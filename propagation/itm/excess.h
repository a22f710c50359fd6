/// Excess of the model `itm`: ITM within its limits, `diffraction` elsewhere.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/excess.h"
#include "propagation/height_bisection.h"
#include "propagation/itm/itm.h"

namespace emscape::propagation {

/// Warning bit, besides those of ItmWarning: ITM refused a path within its limits, and diffraction was used.
constexpr unsigned kItmRefused = 1u << 30;

/// ITM is for antennas near the ground: a voxel's loss (dB) is a weighted mean of ITM and diffraction. For
/// the height of either end, the weight of ITM is 1 up to kItmFull_m above the ground and falls linearly to 0
/// at the model's limit. Along the ground it increases linearly from 0 at kItmNearest_m, where the model's
/// data begin, to 1 at twice that distance.
constexpr double kItmFull_m = 2000;
constexpr double kItmNearest_m = kItmDistance.min * kItmDistance.si_per_unit;

EMSCAPE_HD inline float itmHeightWeight(double height_agl_m) {
  const double part = (kItmHeight.max - height_agl_m) / (kItmHeight.max - kItmFull_m);
  return part < 0 ? 0.0f : part > 1 ? 1.0f : static_cast<float>(part);
}
EMSCAPE_HD inline float itmRangeWeight(double range_m) {
  const double part = range_m / kItmNearest_m - 1;
  return part < 0 ? 0.0f : part > 1 ? 1.0f : static_cast<float>(part);
}

struct ItmExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kInParts = true;
  static constexpr float kTolerance_db = 0.1f;

  DiffractionExcess diffraction;
  ItmLink<float> link;  ///< without the antennas' heights
  ItmQuantiles<float> quantiles;
  bool is_area = false;
  ItmArea<float> area;  ///< without the distance
  double step_m = 0;    ///< of profiles; reduced to give whole steps

  /// Loss relative to free space along the ground; the field applies it relative to free space along the
  /// path. On the CPU, by vector instructions.
  /// @accuracy heights between evaluations: 99 % within 0.1 dB of the model, except at its jumps
  unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const;
  /// The same on a device.
  /// @param excess_db  holds the excess of `diffraction`, NaN over missing terrain
  EMSCAPE_HD unsigned begin(const ExcessColumn& column, const ExcessScratch& scratch,
                            float* excess_db) const {
    const unsigned warnings = std::isnan(excess_db[column.count - 1]) ? kMissingTerrain : 0;
    if (warnings == 0 && pathWeight(column) > 0) spaceEvenly(column.profile, scratch.even_ground_msl_m);
    return warnings;
  }
  EMSCAPE_HD unsigned fill(const ExcessColumn& column, const ExcessScratch& scratch, const ColumnPart& part,
                           float* excess_db) const {
    if (pathWeight(column) == 0) return 0;
    const ItmProfile<float> even = evenProfile(column, scratch);
    itm_detail::ProfileStatistics<float, float> statistics{even};
    const unsigned warnings = evaluate(column, even, statistics, part);
    blend(column, part, excess_db);
    return warnings;
  }

 private:
  EMSCAPE_HD ItmProfile<float> evenProfile(const ExcessColumn& column, const ExcessScratch& scratch) const {
    ItmProfile<float> even;
    even.heights_msl_m = scratch.even_ground_msl_m;
    even.intervals = evenIntervals(column.profile);
    even.step_m = evenStep_m(column.range_m, even.intervals);
    return even;
  }
  /// Number of a part's heights for which ITM counts, of those that the bisection reaches.
  EMSCAPE_HD int inZone(const ExcessColumn& column, const ColumnPart& part) const {
    const int most = part.reach(column.count);
    int in_zone = 0;
    while (in_zone < most && itmHeightWeight(heightAgl(column, part.begin + in_zone)) > 0) ++in_zone;
    return in_zone;
  }
  /// Sets part.memory_db to the excess of ITM alone; NaN where it refuses.
  template <class Statistics>
  EMSCAPE_HD unsigned evaluate(const ExcessColumn& column, const ItmProfile<float>& even,
                               Statistics& statistics, const ColumnPart& part) const {
    unsigned warnings = 0;
    const auto lossAt = [&](int k) {
      ItmLink<float> here = link;
      here.height_agl_m[0] = txAgl(column);
      here.height_agl_m[1] = static_cast<float>(heightAgl(column, part.begin + k));
      ItmResult<float> result;
      if (is_area) {
        ItmArea<float> over = area;
        over.distance_m = static_cast<float>(column.range_m);
        result = itmAreaMode(over, here, quantiles);
      } else {
        result = itmPointToPoint(even, here, quantiles, statistics);
      }
      warnings |= result.refused() ? kItmRefused : result.warnings;
      return result.loss_db - result.free_space_db;
    };
    fillByBisection(lossAt, inZone(column, part), column.tolerance_db(kTolerance_db), part.memory_db);
    return warnings;
  }
  /// Blends the excess of ITM into that of diffraction.
  EMSCAPE_HD void blend(const ExcessColumn& column, const ColumnPart& part, float* excess_db) const {
    const float path_weight = pathWeight(column);
    const int in_zone = part.begin + inZone(column, part);
    for (int k = part.begin; k < part.end && k < in_zone; ++k) {
      const float other = part.memory_db[k - part.begin];
      if (!(other == other)) continue;  // refused
      const float weight = path_weight * itmHeightWeight(heightAgl(column, k));
      excess_db[k] += weight * (other - excess_db[k]);
    }
  }
  EMSCAPE_HD float txAgl(const ExcessColumn& column) const {
    return above(diffraction.tx_msl_m, column.profile.height_msl_m[0]);
  }
  EMSCAPE_HD float pathWeight(const ExcessColumn& column) const {
    return itmHeightWeight(static_cast<double>(txAgl(column))) * itmRangeWeight(column.range_m);
  }
  /// Height above ground, at least the model's minimum.
  static EMSCAPE_HD float above(float height_msl_m, float ground_msl_m) {
    const float above_m = height_msl_m - ground_msl_m, least_m = static_cast<float>(kItmHeight.min);
    return above_m > least_m ? above_m : least_m;
  }
  static EMSCAPE_HD double heightAgl(const ExcessColumn& column, int k) {
    return static_cast<double>(above(column.height_msl_m[k], column.ground_msl_m));
  }
  /// At least 2, at most as many as the profile has.
  EMSCAPE_HD int evenIntervals(const TerrainProfile& profile) const {
    const int last = profile.count - 1;
    int intervals = static_cast<int>(profile.range_m[last] / step_m) + 1;
    intervals = intervals < last ? intervals : last;
    return intervals > 2 ? intervals : 2;
  }
  /// Distance between the posts of a path. It has so few digits that multiples and tenths of it are exact,
  /// because the method truncates such distances to whole posts, and two computations of a path's length may
  /// differ in the last digit.
  static EMSCAPE_HD double evenStep_m(double range_m, int intervals) {
    constexpr double kParts = 1 << 24;  // parts of a metre
    return std::floor(range_m / intervals * kParts + 0.5) / kParts;
  }
  static void spaceEvenlyInLanes(const TerrainProfile& profile, int intervals, float* heights_msl_m);
  EMSCAPE_HD void spaceEvenly(const TerrainProfile& profile, float* heights_msl_m) const {
    const int last = profile.count - 1;
    const double length_m = profile.range_m[last];
    const int intervals = evenIntervals(profile);
    int after = 1;
    for (int i = 0; i <= intervals; ++i) {
      const double at_m = length_m * i / intervals;
      while (after < last && profile.range_m[after] < at_m) ++after;
      const double before_m = profile.range_m[after - 1];
      const auto part = static_cast<float>((at_m - before_m) / (profile.range_m[after] - before_m));
      const float before = profile.height_msl_m[after - 1];
      heights_msl_m[i] = before + part * (profile.height_msl_m[after] - before);
    }
  }
};

}  // namespace emscape::propagation
