/// Limit of rounding of heights.
#pragma once

namespace emscape::scenario {

/// A platform may be this far below the ground, by rounding.
constexpr double kGroundTolerance_m = 1e-3;

}  // namespace emscape::scenario
