/// Excess of `parabolic_equation` over columns, from the losses of a march over all azimuths.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "propagation/column.h"
#include "propagation/parabolic_equation/others.h"

namespace emscape::propagation {

/// Warning bits. The bits from kPeStaircaseShift to 30 hold the number of steps of the staircase.
enum PeWarning : unsigned {
  kPePointwiseAir = 1,
  kPeDuctOverLand = 2,  ///< an evaporation duct, and land, over which it is left out
  kPeProfileEnds = 4    ///< the air was measured up to less than the antenna's or the field's height
};
constexpr int kPeStaircaseShift = 4;

/// Warning bits of a number of pieces of the ground that are taken as steps of a staircase.
EMSCAPE_HD inline unsigned staircaseWarning(int staircases) {
  constexpr int kMost = (1 << (31 - kPeStaircaseShift)) - 1;
  return static_cast<unsigned>(staircases < kMost ? staircases : kMost) << kPeStaircaseShift;
}

/// Interpolates in dB between azimuths, ranges and heights; other models speak outside the equation's limits.
struct PeExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kInParts = false;
  static constexpr bool kHasMechanisms = true;

  PeOthers others;
  /// Losses over free space (dB) of the cells, azimuth slowest, height fastest; NaN below the ground and
  /// behind missing terrain.
  const float* tables = nullptr;
  int azimuths = 0, ranges = 0, heights = 0;
  bool is_around = false;  ///< the last azimuth's neighbour is the first
  bool above_ground = false;
  double first_azimuth_rad = 0, azimuth_step_rad = 0;
  /// A cell holds the mean of the march's steps in it, the last of which is at its end, or that one: that of
  /// the first cell, if it were as long as the others, is of first_range_m.
  float first_range_m = 0, range_step_m = 0;
  float bottom_m = 0, height_step_m = 0;
  float top_m = 0;  ///< as the cells' heights; above: along the ray from there
  unsigned warnings = 0;

  /// @param excess_db  one per voxel; NaN over missing terrain
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db,
                                 const MechanismStore& mechanisms = {}) const {
    static_assert(ExcessScratch::kPostNumbers == 4);  // `diffraction` has the first two
    float* const numbers = scratch.post_numbers + 2 * scratch.posts;
    const PeSight sight = others.sightOf(column, {numbers, numbers + scratch.posts});
    if (!sight.isKnown()) {
      for (int k = 0; k < column.count; ++k) excess_db[k] = NAN;
      return kMissingTerrain;
    }
    const Neighbours beside = azimuthsAt(column.azimuth_rad);
    bool has_others = false;
    for (int k = 0; k < column.count; ++k) {
      const PeLoss loss = lossAt(column, beside, sight, column.height_msl_m[k], [&] {
        if (!has_others) others.fill(column, scratch, scratch.other_db);
        has_others = true;
        return scratch.other_db[k];
      });
      mechanisms.set(k, loss.mechanism(others.over_terrain));
      excess_db[k] = loss.loss_db();
    }
    return warnings;
  }

  /// Two of a row and where a place is between them.
  struct Neighbours {
    int first, second;
    float part;  ///< of the second
  };
  /// The azimuths beside a column's.
  EMSCAPE_HD Neighbours azimuthsAt(double azimuth_rad) const {
    if (azimuths == 1) return {0, 0, 0};
    double from_first = azimuth_rad - first_azimuth_rad;
    from_first -= 2 * kPi * std::floor(from_first / (2 * kPi));
    if (is_around) {
      const double at = from_first / azimuth_step_rad;
      const int first = static_cast<int>(at) % azimuths;
      return {first, (first + 1) % azimuths, static_cast<float>(at - std::floor(at))};
    }
    const double span_rad = azimuth_step_rad * (azimuths - 1);
    if (from_first > span_rad + (2 * kPi - span_rad) / 2) from_first = 0;  // before the first
    return between(static_cast<float>(from_first / azimuth_step_rad), azimuths);
  }

  /// The parts of the loss at a height of a column.
  /// @param beside    azimuthsAt() the column's
  /// @param other_db  gives that of the other model
  template <class Other>
  EMSCAPE_HD PeLoss lossAt(const ExcessColumn& column, const Neighbours& beside, const PeSight& sight,
                           float height_msl_m, const Other& other_db) const {
    PeLoss loss = equationAt(column, beside, height_msl_m, sight.horizon_rad);
    if (loss.equation_part < 1) loss.other_db = other_db();
    others.addScatter(static_cast<float>(column.range_m), sight, height_msl_m, loss);
    return loss;
  }

  /// The equation's part alone.
  EMSCAPE_HD PeLoss equationAt(const ExcessColumn& column, const Neighbours& beside, float height_msl_m,
                               float horizon_rad) const {
    const auto range_m = static_cast<float>(column.range_m);
    const float datum_msl_m = above_ground ? column.ground_msl_m : 0;
    PeLoss loss;
    loss.equation_part = others.equationPart(range_m, height_msl_m, column.ground_msl_m, horizon_rad);
    if (loss.equation_part <= 0) return loss;
    float at_m = range_m, height_m = height_msl_m - datum_msl_m;
    if (height_m > top_m) {
      loss.is_extended = true;
      at_m = others.crossing_m(range_m, height_msl_m, top_m + datum_msl_m);
      height_m = top_m;
    }
    others.setEquation(cells_db(beside, at_m, height_m), range_m, height_msl_m, loss);
    if (!(loss.equation_db == loss.equation_db)) loss.equation_part = 0;
    return loss;
  }

 private:
  static EMSCAPE_HD Neighbours between(float at, int count) {
    if (!(at > 0)) return {0, 0, 0};
    if (at >= static_cast<float>(count - 1)) return {count - 1, count - 1, 0};
    const int first = static_cast<int>(at);
    return {first, first + 1, at - static_cast<float>(first)};
  }
  /// NaN where no cell around is known.
  EMSCAPE_HD float cells_db(const Neighbours& a, float range_m, float height_m) const {
    const Neighbours r = between((range_m - first_range_m) / range_step_m, ranges);
    float sum = 0, weights = 0;
    for (int i = 0; i < 4; ++i) {
      const int azimuth = i & 1 ? a.second : a.first, range = i & 2 ? r.second : r.first;
      const float weight = (i & 1 ? a.part : 1 - a.part) * (i & 2 ? r.part : 1 - r.part);
      if (!(weight > 0)) continue;
      const float db =
          columnOfCells_db(tables + (static_cast<std::size_t>(azimuth) * ranges + range) * heights, height_m);
      if (!(db == db)) continue;
      sum += weight * db;
      weights += weight;
    }
    return weights > 0 ? sum / weights : NAN;
  }
  /// Below the ground: the lowest cell above it.
  EMSCAPE_HD float columnOfCells_db(const float* cells, float height_m) const {
    const Neighbours h = between((height_m - bottom_m) / height_step_m - 0.5f, heights);
    const float low = cells[h.first], high = cells[h.second];
    if (low == low) return high == high ? low + h.part * (high - low) : low;
    for (int j = h.second; j < heights; ++j) {
      if (cells[j] == cells[j]) return cells[j];
    }
    return NAN;
  }
};

}  // namespace emscape::propagation
