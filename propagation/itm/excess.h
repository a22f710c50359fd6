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
  static constexpr bool kInParts = false;
  static constexpr float kTolerance_db = 0.1f;

  DiffractionExcess diffraction;
  ItmLink<float> link;  ///< without the antennas' heights
  ItmQuantiles<float> quantiles;
  bool is_area = false;
  ItmArea<float> area;  ///< without the distance
  double step_m = 0;    ///< of profiles; reduced to give whole steps

  /// Loss relative to free space along the ground; the field applies it relative to free space along the
  /// path. On the CPU, by vector instructions; on the device emfield/cuda/itm_kernels.cu.
  /// @accuracy heights between evaluations: 99 % within 0.1 dB of the model, except at its jumps
  unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const;

  /// Weight of ITM in a column; 0: its losses are those of `diffraction`.
  EMSCAPE_HD float pathWeight(const ExcessColumn& column) const {
    return itmHeightWeight(static_cast<double>(txAgl(column))) * itmRangeWeight(column.range_m);
  }
  /// @param weight  pathWeight()
  /// @param itm_db  excess of ITM alone, NaN where it refuses
  /// @param excess_db  that of `diffraction`
  EMSCAPE_HD float blended(const ExcessColumn& column, int k, float weight, float itm_db,
                           float excess_db) const {
    if (!(itm_db == itm_db)) return excess_db;
    return excess_db + weight * itmHeightWeight(heightAgl(column, k)) * (itm_db - excess_db);
  }
  EMSCAPE_HD ItmProfile<float> evenProfile(const ExcessColumn& column, const ExcessScratch& scratch) const {
    ItmProfile<float> even;
    even.heights_msl_m = scratch.even_ground_msl_m;
    even.intervals = evenIntervals(column.profile);
    even.step_m = evenStep_m(column.range_m, even.intervals);
    return even;
  }
  /// The link to a height above ground.
  EMSCAPE_HD ItmLink<float> linkTo(const ExcessColumn& column, double height_agl_m) const {
    ItmLink<float> here = link;
    here.height_agl_m[0] = txAgl(column);
    here.height_agl_m[1] = static_cast<float>(height_agl_m);
    return here;
  }
  EMSCAPE_HD ItmArea<float> areaTo(const ExcessColumn& column) const {
    ItmArea<float> over = area;
    over.distance_m = static_cast<float>(column.range_m);
    return over;
  }
  /// Height above ground, at least the model's minimum.
  static EMSCAPE_HD double heightAgl(const ExcessColumn& column, int k) {
    return static_cast<double>(above(column.height_msl_m[k], column.ground_msl_m));
  }
  /// True for the heights for which ITM counts: the lowest ones.
  static EMSCAPE_HD bool isInZone(const ExcessColumn& column, int k) {
    return itmHeightWeight(heightAgl(column, k)) > 0;
  }

 private:
  /// Sets itm_db to the excess of ITM alone at the column's `count` lowest heights; NaN where it refuses.
  template <class Statistics>
  EMSCAPE_HD unsigned evaluate(const ExcessColumn& column, int count, const ItmProfile<float>& even,
                               Statistics& statistics, float* itm_db) const {
    unsigned warnings = 0;
    const auto lossAt = [&](int k) {
      const ItmLink<float> here = linkTo(column, heightAgl(column, k));
      const ItmResult<float> result = is_area ? itmAreaMode(areaTo(column), here, quantiles)
                                              : itmPointToPoint(even, here, quantiles, statistics);
      warnings |= result.refused() ? kItmRefused : result.warnings;
      return result.loss_db - result.free_space_db;
    };
    fillByBisection(lossAt, count, column.tolerance_db(kTolerance_db), itm_db);
    return warnings;
  }
  EMSCAPE_HD float txAgl(const ExcessColumn& column) const {
    return above(diffraction.tx_msl_m, column.profile.height_msl_m[0]);
  }
  static EMSCAPE_HD float above(float height_msl_m, float ground_msl_m) {
    const float above_m = height_msl_m - ground_msl_m, least_m = static_cast<float>(kItmHeight.min);
    return above_m > least_m ? above_m : least_m;
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
};

}  // namespace emscape::propagation
