/// Excess of the model `p528`: in volumes from curves computed once for an emitter's height, over surfaces
/// from a table that is as fine as the points need.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "emscape/base/host_device.h"
#include "propagation/column.h"
#include "propagation/inputs.h"

namespace emscape::propagation {

/// A table of the loss minus free space. Heights are tabulated by their square root, in which the horizon's
/// distance is almost linear; ranges by their ratio to that of the horizon, so that lobes and horizon of
/// neighbouring curves are at the same ratio, and by the grazing angle, which determines the reflection near
/// the station's nadir. The nodes are densest near the horizon and near the nadir.
struct P528Excess {
  static constexpr bool kNeedsTerrain = false;
  static constexpr bool kInParts = false;

  /// Distance (m) of the horizon, height_count; range (m) to which rays are steep, height_count; then the
  /// excess (dB), height_count x range_count, range fastest.
  const float* tables = nullptr;
  int height_count = 0, range_count = 0;
  float lowest_root = 0, heights_per_root = 0;
  float farthest_ratio = 0;  ///< of range to that of the horizon
  double surface_msl_m = 0;
  /// For a surface: the tables are the excess (dB) of each point, positions x heights, position fastest; 0:
  /// tables as above.
  std::size_t position_count = 0;

  /// @accuracy see docs/models.md
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch&, float* excess) const {
    for (int k = 0; k < column.count; ++k) {
      if (position_count > 0) {
        excess[k] = tables[static_cast<std::size_t>(k) * position_count + column.position];
        continue;
      }
      excess[k] = at(static_cast<float>(column.range_m),
                     static_cast<float>(static_cast<double>(column.height_msl_m[k]) - surface_msl_m));
    }
    return 0;
  }

  /// Position of a range among the nodes, 0..1: half of them are before the horizon, and they are densest on
  /// both sides of it and within the steep range.
  template <class Real>
  static EMSCAPE_HD Real positionOf(Real range_m, Real horizon_m, Real steep_m, Real farthest_ratio) {
    constexpr Real kSteepPart = Real(0.4);
    const Real ratio = range_m / horizon_m;
    if (ratio <= 1) {
      const Real steep = ratio * (horizon_m + steep_m) / (range_m + steep_m);
      const Real level = 1 - std::sqrt(1 - ratio);
      return Real(0.5) * (level + kSteepPart * (steep - level));
    }
    const Real beyond = (ratio - 1) / (farthest_ratio - 1);
    return Real(0.5) + Real(0.5) * std::sqrt(beyond < 1 ? beyond : Real(1));
  }

 private:
  EMSCAPE_HD float at(float range_m, float height_m) const {
    const float last = static_cast<float>(height_count - 1);
    float row = (std::sqrt(height_m > 0 ? height_m : 0.0f) - lowest_root) * heights_per_root;
    row = row < 0 ? 0.0f : row > last ? last : row;
    const int lower = static_cast<int>(row) < height_count - 2 ? static_cast<int>(row) : height_count - 2;
    const float upwards = row - static_cast<float>(lower);
    const auto between = [&](const float* of_heights) {
      return of_heights[lower] + upwards * (of_heights[lower + 1] - of_heights[lower]);
    };
    const float position =
        positionOf(range_m, between(tables), between(tables + height_count), farthest_ratio) *
        static_cast<float>(range_count - 1);
    const int before =
        static_cast<int>(position) < range_count - 2 ? static_cast<int>(position) : range_count - 2;
    const float outwards = position - static_cast<float>(before);
    const float* const low = tables + 2 * height_count + lower * range_count + before;
    const float* const high = low + range_count;
    const float on_low = low[0] + outwards * (low[1] - low[0]);
    const float on_high = high[0] + outwards * (high[1] - high[0]);
    return on_low + upwards * (on_high - on_low);
  }
};

/// Range over the sum of both heights to which a ray is steep: at larger ones the reflection changes slowly.
constexpr double kP528SteepRatio = 3;
/// The inverse of P528Excess::positionOf (m).
double p528RangeAt(double position, double horizon_m, double steep_m, double farthest_ratio);

/// @param tables  receives the tables to which the result points
P528Excess p528Excess(const PathInputs& inputs, std::vector<float>& tables);
/// The same over a surface: the excess of every point.
/// @accuracy see P528PointTable
P528Excess p528ExcessAt(const PathInputs& inputs, const PathPoints& points, std::vector<float>& tables);

}  // namespace emscape::propagation
