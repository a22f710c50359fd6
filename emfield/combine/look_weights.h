/// Weights of the voxels for a radar's look, independent of all powers.
#pragma once

#include <vector>

namespace emscape::emfield {

/// Weights of all voxels, dense order: written by a pass, or read instead of computed. Null: neither.
struct WeightArray {
  float* values = nullptr;
  bool is_known = false;
};

/// The weights of a RadarPass that are kept after it.
struct LookWeights {
  WeightArray echo;                  ///< echoWeight() with the excess loss of the path
  std::vector<WeightArray> jammers;  ///< jammingWeight() of each jammer; empty: none is kept
};

}  // namespace emscape::emfield
