/// A path's budget summarised in one sentence.
#pragma once

#include <string>

#include "emscape/emfield/link/path_budget.h"

namespace emscape::emfield {

/// Gain of an antenna, relative to its maximum, below which its beam misses a point.
constexpr double kBeamMisses_db = -6;
/// Probability from which on a verdict calls a target detected.
constexpr double kDetected = 0.5;
constexpr double kFree_radii = 0.6;  ///< clearance of a free path

/// Whether an obstacle decides and is above the ray or close below it.
bool isNear(const PathObstacle& obstacle);

/// Whether the loss is that of the parabolic equation's floor, and may be larger.
bool isAtFloor(const PathBudget& budget);

/// Names the dominant cause: inactive emitter, jamming that takes the detection away, obstacle, antenna
/// pattern, or distance.
std::string verdictOf(const PathBudget& budget);

/// The same without the antenna's pattern and without detection.
std::string pathVerdictOf(const PathBudget& budget);

}  // namespace emscape::emfield
