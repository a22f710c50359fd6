/// Limits of a scenario that more than its schema needs.
#pragma once

namespace emscape::scenario {

inline constexpr int kMaxDim = 4096;  ///< voxels of the region along an axis

}  // namespace emscape::scenario
