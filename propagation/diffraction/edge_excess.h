/// Excess of the model `diffraction` with the options single edge and Deygout (three edges).
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/column.h"
#include "propagation/diffraction/edges.h"
#include "propagation/height_bisection.h"

namespace emscape::propagation {

struct EdgeExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kOnEffectiveEarth = true;
  static constexpr bool kInParts = true;
  static constexpr float kTolerance_db = 0.1f;

  DiffractionModel<float> model;
  float tx_msl_m = 0;
  bool three_edges = false;

  /// @accuracy heights between evaluations: 99 % within 0.1 dB of the model
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                 float* excess_db) const {
    const unsigned remarks = begin(column, scratch, excess_db);
    if (remarks == 0) fill(column, scratch, {0, column.count, scratch.other_db}, excess_db);
    return remarks;
  }
  EMSCAPE_HD unsigned begin(const ExcessColumn& column, const ExcessScratch&, float* excess_db) const {
    float terrain = 0;  // NaN where it is missing
    for (int i = 0; i < column.profile.count; ++i) terrain += column.profile.height_msl_m[i] * 0;
    if (terrain == 0) return 0;
    for (int k = 0; k < column.count; ++k) excess_db[k] = NAN;
    return kMissingTerrain;
  }
  EMSCAPE_HD unsigned fill(const ExcessColumn& column, const ExcessScratch&, const ColumnPart& part,
                           float* excess_db) const {
    const TerrainProfile& profile = column.profile;
    const float tx_m = model.raised_m(tx_msl_m, profile.height_msl_m[0]);
    const auto lossAt = [&](int k) {
      if (profile.count < 2) return 0.0f;
      const float rx_m = model.raised_m(column.height_msl_m[part.begin + k], column.ground_msl_m);
      return three_edges ? deygoutLossDb(model, profile, tx_m, rx_m)
                         : singleEdgeLossDb(model, profile, tx_m, rx_m);
    };
    fillByBisection(lossAt, part.reach(column.count), column.tolerance_db(kTolerance_db), part.memory_db);
    for (int k = part.begin; k < part.end; ++k) excess_db[k] = part.memory_db[k - part.begin];
    return 0;
  }
};

}  // namespace emscape::propagation
