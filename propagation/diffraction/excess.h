/// Excess of the model `diffraction` over columns.
#pragma once

#include "propagation/column.h"
#include "propagation/diffraction/diffraction.h"

namespace emscape::propagation {

/// Delta-Bullington over the column's own profile, several heights at a time.
struct DiffractionExcess {
  static constexpr bool kNeedsTerrain = true;
  static constexpr bool kOnEffectiveEarth = true;
  static constexpr bool kInParts = false;
  static constexpr bool kReadsCrossings = true;

  DiffractionModel<float> model;
  float tx_msl_m = 0;

  /// On the CPU, by vector instructions; on the device emfield/cuda/diffraction_kernels.cu.
  /// @param excess_db  one per voxel; NaN over missing terrain
  /// @accuracy within 0.002 dB of deltaBullington in double over the same profile
  unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const;
  /// The same on the CPU, with vectors of 8 or 16 numbers.
  unsigned fillByLanes(int lanes, const ExcessColumn& column, float* excess_db) const;
};

}  // namespace emscape::propagation
