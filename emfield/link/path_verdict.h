/// A path's budget in one plain sentence.
#pragma once

#include <string>

#include "emscape/emfield/path_budget.h"

namespace emscape::emfield {

/// Names the dominant cause: the emitter is silent, an obstacle, the antenna's pattern, or the distance.
std::string verdictOf(const PathBudget& budget);

/// The same without the antenna's pattern and without detection.
std::string pathVerdictOf(const PathBudget& budget);

}  // namespace emscape::emfield
