/// Limits of a scenario that more than one of its parts needs.
#pragma once

namespace emscape::scenario {

inline constexpr int kMaxDim = 4096;  ///< voxels of the region along an axis
inline constexpr double kMaxVoxels = 2147483648.0;

}  // namespace emscape::scenario
