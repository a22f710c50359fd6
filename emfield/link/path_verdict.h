/// A path's budget in one plain sentence.
#pragma once

#include <string>

#include "emscape/emfield/path_budget.h"

namespace emscape::emfield {

/// What decides over the path: the emitter's silence, an obstacle, the antenna's pattern, the distance.
std::string verdictOf(const PathBudget& budget);

}  // namespace emscape::emfield
