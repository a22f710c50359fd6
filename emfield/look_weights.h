/// What a radar's look weighs each voxel with, apart from all powers.
#pragma once

#include <cstddef>
#include <vector>

namespace emscape::emfield {

/// Weights of all voxels, dense order: written by a pass, or read by it in place of being computed. Null:
/// neither.
struct WeightArray {
  float* values = nullptr;
  bool is_known = false;
};

/// The weights of a RadarPass that outlive it.
struct LookWeights {
  WeightArray echo;                  ///< echoWeight() with the excess loss of the path
  std::vector<WeightArray> jammers;  ///< jammingWeight() of each jammer; empty: none outlives it
};

}  // namespace emscape::emfield
