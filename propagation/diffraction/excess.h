/// Excess of the model `diffraction` over columns.
#pragma once

#include "emscape/base/host_device.h"
#include "propagation/column.h"
#include "propagation/diffraction/sweep.h"

namespace emscape::propagation {

/// Delta-Bullington: one walk along the column's own profile, all its heights at its end.
struct DiffractionExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kInParts = false;

  DiffractionModel<float> model;
  float tx_msl_m = 0;

  /// @param excess_db  one a voxel; NaN over missing terrain
  /// @accuracy within 0.001 dB of deltaBullington in double over the same profile
  EMSCAPE_HD unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch,
                                 float* excess_db) const {
    DiffractionSweep<float> sweep(model, column.profile, tx_msl_m, sweepMemory(scratch));
    while (sweep.post() + 1 < column.profile.count) sweep.advance();
    sweep.column(column.height_msl_m, column.count, excess_db);
    return excess_db[0] == excess_db[0] ? 0 : kMissingTerrain;
  }

 private:
  static EMSCAPE_HD DiffractionScratch<float> sweepMemory(const ExcessScratch& scratch) {
    const auto numbers = [&scratch](int n) { return scratch.post_numbers + n * scratch.posts; };
    return {numbers(0),
            numbers(1),
            numbers(2),
            numbers(3),
            numbers(4),
            scratch.post_indices,
            scratch.post_indices + scratch.posts};
  }
};

}  // namespace emscape::propagation
