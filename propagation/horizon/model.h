/// Model `horizon` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/path_column.h"

namespace emscape::propagation {

std::vector<std::string> horizonPathWarnings(const PathInputs& inputs);
Explanation explainHorizon(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
