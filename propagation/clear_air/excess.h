/// Excess of ITU-R P.1812 and P.452 over columns.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/clear_air/column.h"
#include "propagation/clear_air/ground.h"
#include "propagation/column.h"
#include "propagation/height_bisection.h"

namespace emscape::propagation {

/// Warning bits of both models.
enum ClearAirWarning : unsigned {
  kClearAirTransmitterHeight = 1,  ///< antenna higher above its ground than the model's limit
  kClearAirVoxelHeight = 2         ///< the same for voxels
};

/// @tparam Model  P1812Model<float> or the like: `clear_air` and
///     float excessDb(const ClearAirColumn<float>&, float rx_msl_m) const
template <class Model>
struct ClearAirExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kInParts = true;
  static constexpr float kTolerance_db = 0.1f;

  Model model;
  ClearAirGround ground;
  float tx_msl_m = 0;

  /// On the CPU, by vector instructions: fillColumn(), compiled for several processors.
  /// @accuracy heights between evaluations: 99 % within 0.1 dB of the model
  unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const;
  unsigned fillColumn(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const {
    const unsigned warnings = begin(column, scratch, excess_db);
    if (warnings != 0) return warnings;
    return fill(column, scratch, {0, column.count, scratch.other_db}, excess_db);
  }
  // The same on a device.
  EMSCAPE_HD unsigned begin(const ExcessColumn& column, const ExcessScratch& scratch,
                            float* excess_db) const {
    const TerrainProfile& profile = column.profile;
    int unknown = 0;
    for (int i = 0; i < profile.count; ++i) {
      unknown |= profile.height_msl_m[i] == profile.height_msl_m[i] ? 0 : 1;
    }
    if (unknown != 0) {
      for (int k = 0; k < column.count; ++k) excess_db[k] = NAN;
      return kMissingTerrain;
    }
    const float wavelength_m = model.clear_air.median.earth.wavelength_m;
    if (ground.hasClutter(profile)) {
      postsOf(column, scratch).fill(wavelength_m, [&](int post) { return ground.clutterAt(profile, post); });
    } else {
      postsOf(column, scratch).fill(wavelength_m, [](int) { return 0.0f; });
    }
    return 0;
  }
  EMSCAPE_HD unsigned fill(const ExcessColumn& column, const ExcessScratch& scratch, const ColumnPart& part,
                           float* excess_db) const {
    if (column.profile.count < 2) {  // at the antenna itself
      for (int k = part.begin; k < part.end; ++k) excess_db[k] = 0;
      return 0;
    }
    const ClearAirColumn<float> path = clearAirColumn(model.clear_air, postsOf(column, scratch),
                                                      zonesOf(ground.zone, column.profile), tx_msl_m);
    fillByBisection([&](int k) { return model.excessDb(path, column.height_msl_m[part.begin + k]); },
                    part.reach(column.count), column.tolerance_db(kTolerance_db), part.memory_db);
    for (int k = part.begin; k < part.end; ++k) excess_db[k] = part.memory_db[k - part.begin];
    unsigned warnings = isHigh(path.tx_m) ? kClearAirTransmitterHeight : 0u;
    if (isHigh(column.height_msl_m[part.end - 1] - column.ground_msl_m)) warnings |= kClearAirVoxelHeight;
    return warnings;
  }

 private:
  static EMSCAPE_HD bool isHigh(float height_agl_m) {
    return height_agl_m > static_cast<float>(kClearAirHeight.max);
  }
  static EMSCAPE_HD ClearAirPosts<float> postsOf(const ExcessColumn& column, const ExcessScratch& scratch) {
    return {column.profile, scratch.even_ground_msl_m, scratch.post_numbers,
            scratch.post_numbers + scratch.posts};
  }
};

}  // namespace emscape::propagation
