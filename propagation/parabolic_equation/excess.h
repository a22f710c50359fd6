/// Excess loss of `parabolic_equation` in columns, from the losses of a march over all azimuths.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "propagation/column.h"
#include "propagation/parabolic_equation/others.h"

namespace emscape::propagation {

/// Warning bits.
enum PeWarning : unsigned {
  kPePointwiseAir = 1,
  kPeDuctOverLand = 2,  ///< the path has land, over which the evaporation duct is left out
  kPeProfileEnds = 4,   ///< the air was measured up to less than the antenna's or the field's height
  kPeNearObstacle = 8   ///< of a single path: ground above the ray within two steps of an end
};

/// Interpolates in dB between azimuths, ranges (cubic) and heights; outside the equation's limits other
/// models are used.
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
  /// A cell has the mean of the march's steps in it, the last of which is at its end, or the value of that
  /// step. first_range_m is the range of the first cell, if it were as long as the others.
  float first_range_m = 0, range_step_m = 0;
  float bottom_m = 0, height_step_m = 0;
  float top_msl_m = 0;  ///< above it: extended along the ray
  unsigned warnings = 0;

  /// @param excess_db  one per voxel; NaN over missing terrain
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db,
                                 const MechanismStore& mechanisms = {}) const {
    const PeSight sight =
        others.sightOf(column, {scratch.post_numbers, scratch.post_numbers + scratch.posts});
    if (!sight.isKnown()) {
      for (int k = 0; k < column.count; ++k) excess_db[k] = NAN;
      return kMissingTerrain;
    }
    const Neighbours beside = azimuthsAt(column.azimuth_rad);
    bool has_others = false;
    for (int k = 0; k < column.count; ++k) {
      const auto ground_msl_m = [&](float range_m) { return groundOf(column.profile, range_m); };
      const PeLoss loss = lossAt(column, beside, sight, column.height_msl_m[k], ground_msl_m, [&] {
        if (!has_others) others.fill(column, scratch, scratch.other_db);
        has_others = true;
        return scratch.other_db[k];
      });
      mechanisms.set(k, loss.mechanism(others.over_terrain));
      excess_db[k] = loss.loss_db();
    }
    return warnings;
  }

  /// Four neighbours in a row; the position is between the first and the second. kNone: no neighbour.
  struct Neighbours {
    static constexpr int kNone = -1;
    int before, first, second, behind;
    float part;  ///< weight of the second
  };
  /// Neighbouring azimuths of a column.
  EMSCAPE_HD Neighbours azimuthsAt(double azimuth_rad) const {
    if (azimuths == 1) return between(0, 1);
    double from_first = azimuth_rad - first_azimuth_rad;
    from_first -= 2 * kPi * std::floor(from_first / (2 * kPi));
    if (is_around) {
      const double at = from_first / azimuth_step_rad;
      const int first = static_cast<int>(at) % azimuths;
      return {(first + azimuths - 1) % azimuths, first, (first + 1) % azimuths, (first + 2) % azimuths,
              static_cast<float>(at - std::floor(at))};
    }
    const double span_rad = azimuth_step_rad * (azimuths - 1);
    if (from_first > span_rad + (2 * kPi - span_rad) / 2) from_first = 0;  // before the first
    return between(static_cast<float>(from_first / azimuth_step_rad), azimuths);
  }

  /// Contributions to the loss at a height of a column.
  /// @param beside        azimuthsAt() the column's
  /// @param ground_msl_m  gives the ground at a nearer range
  /// @param other_db      gives the other model's loss
  template <class Ground, class Other>
  EMSCAPE_HD PeLoss lossAt(const ExcessColumn& column, const Neighbours& beside, const PeSight& sight,
                           float height_msl_m, const Ground& ground_msl_m, const Other& other_db) const {
    const float ridge_rad = others.ridgeAngle(static_cast<float>(column.range_m), sight, height_msl_m);
    PeLoss loss = equationAt(column, beside, height_msl_m, ridge_rad, ground_msl_m);
    if (loss.equation_part < 1) loss.other_db = other_db();
    others.addScatter(static_cast<float>(column.range_m), sight, height_msl_m, loss);
    return loss;
  }

  /// Contribution of the equation only.
  template <class Ground>
  EMSCAPE_HD PeLoss equationAt(const ExcessColumn& column, const Neighbours& beside, float height_msl_m,
                               float horizon_rad, const Ground& ground_msl_m) const {
    const auto range_m = static_cast<float>(column.range_m);
    PeLoss loss;
    loss.equation_part = others.equationPart(range_m, height_msl_m, column.ground_msl_m, horizon_rad);
    if (loss.equation_part <= 0) return loss;
    float at_m = range_m, height_m = height_msl_m, datum_msl_m = above_ground ? column.ground_msl_m : 0;
    if (height_msl_m > top_msl_m) {
      loss.is_extended = true;
      height_m = top_msl_m;
      at_m = others.crossing_m(range_m, height_msl_m, top_msl_m);
      if (above_ground && at_m < range_m) datum_msl_m = ground_msl_m(at_m);
    }
    others.setEquation(cells_db(beside, at_m, height_m - datum_msl_m), range_m, height_msl_m, loss);
    if (!(loss.equation_db == loss.equation_db)) loss.equation_part = 0;
    return loss;
  }

  /// Ground between the posts of a profile that begins at the antenna.
  static EMSCAPE_HD float groundOf(const TerrainProfile& profile, float range_m) {
    int low = 0, high = profile.count - 1;
    while (low + 1 < high) {
      const int middle = (low + high) / 2;
      (profile.range_m[middle] < range_m ? low : high) = middle;
    }
    return groundBetween(profile.range_m[low], profile.height_msl_m[low], profile.range_m[high],
                         profile.height_msl_m[high], range_m);
  }
  /// Ground between two posts.
  static EMSCAPE_HD float groundBetween(double low_m, float low_msl_m, double high_m, float high_msl_m,
                                        float range_m) {
    const auto length_m = static_cast<float>(high_m - low_m);
    if (!(length_m > 0)) return high_msl_m;
    const float part = static_cast<float>(range_m - low_m) / length_m;
    return low_msl_m + std::fmin(std::fmax(part, 0.0f), 1.0f) * (high_msl_m - low_msl_m);
  }

 private:
  /// If the position is within kNext of a neighbour, only that one is used, which saves reading the other.
  static EMSCAPE_HD Neighbours between(float at, int count) {
    constexpr float kNext = 1e-3f;
    constexpr int kNone = Neighbours::kNone;
    const float limited =
        at > 0 ? at < static_cast<float>(count - 1) ? at : static_cast<float>(count - 1) : 0;
    const int first = static_cast<int>(limited + kNext);
    const float part = limited - static_cast<float>(first);
    if (!(part > kNext)) return {kNone, first, first, kNone, 0};
    return {first - 1, first, first + 1, first + 2 < count ? first + 2 : kNone, part};
  }
  /// Catmull-Rom interpolation between the middle two of four losses (dB) at equal distances: at a null
  /// between two azimuths the loss is larger than at both. Linear if one of the outer two is NaN; if one of
  /// the middle two is NaN, the value of the other.
  static EMSCAPE_HD float curve_db(float before, float first, float second, float behind, float part) {
    constexpr float kLargestBend_db = 2;  // from linear: at the edge of a shadow the cubic overshoots
    if (!(first == first)) return second;
    if (!(second == second)) return first;
    const float line = first + part * (second - first);
    const float bend = part * (1 - part) / 2 *
                       ((1 - part) * (2 * first - before - second) + part * (2 * second - first - behind));
    if (!(bend == bend)) return line;
    return line + std::fmin(std::fmax(bend, -kLargestBend_db), kLargestBend_db);
  }
  /// NaN if no neighbouring cell is known.
  EMSCAPE_HD float cells_db(const Neighbours& a, float range_m, float height_m) const {
    const Neighbours r = between((range_m - first_range_m) / range_step_m, ranges);
    const Neighbours h = between((height_m - bottom_m) / height_step_m - 0.5f, heights);
    if (!(r.part > 0)) return azimuths_db(a, r.first, h);
    return curve_db(outer_db(a, r.before, h), azimuths_db(a, r.first, h), azimuths_db(a, r.second, h),
                    outer_db(a, r.behind, h), r.part);
  }
  /// From the cells of a range.
  EMSCAPE_HD float azimuths_db(const Neighbours& a, int range, const Neighbours& h) const {
    const float first = cell_db(a.first, range, h);
    if (!(a.part > 0)) return first;
    return curve_db(cell_db(a.before, range, h), first, cell_db(a.second, range, h),
                    cell_db(a.behind, range, h), a.part);
  }
  /// From the cells of an outer range of the cubic: linear between two azimuths.
  EMSCAPE_HD float outer_db(const Neighbours& a, int range, const Neighbours& h) const {
    const float first = cell_db(a.first, range, h);
    return a.part > 0 ? first + a.part * (cell_db(a.second, range, h) - first) : first;
  }
  EMSCAPE_HD const float* columnOf(int azimuth, int range) const {
    return tables + (static_cast<std::size_t>(azimuth) * ranges + range) * heights;
  }
  /// Below the ground: the loss of the lowest cell above it, so that the loss is continuous in height. NaN if
  /// there is no such column, or none of its cells is known.
  EMSCAPE_HD float cell_db(int azimuth, int range, const Neighbours& h) const {
    if (azimuth < 0 || range < 0) return NAN;
    const float* const cells = columnOf(azimuth, range);
    const float low = cells[h.first];
    const float db = h.part > 0 ? low + h.part * (cells[h.second] - low) : low;
    if (db == db) return db;
    for (int j = h.first; j < heights; ++j) {
      if (cells[j] == cells[j]) return cells[j];
    }
    return NAN;
  }
};

}  // namespace emscape::propagation
