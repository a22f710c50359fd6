/// Model `p528` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/p528/excess.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> p528Settings();
InputFaults checkP528(const EmitterInputs& inputs);
std::vector<std::string> p528PathWarnings(const PathInputs& inputs);
/// Computes the curve of the path's two heights, as p528ExcessAt() does; volumes interpolate between such
/// curves.
Explanation explainP528(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
