/// Excess of the model `diffraction` over columns.
#pragma once

#include "emfield/excess/excess_column.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

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
    DiffractionSweep<float> sweep(model, column.profile, tx_msl_m, scratch.diffraction);
    while (sweep.post() + 1 < column.profile.count) sweep.advance();
    sweep.column(column.height_msl_m, column.count, excess_db);
    return excess_db[0] == excess_db[0] ? 0 : kMissingTerrain;
  }
};

}  // namespace emscape::emfield
