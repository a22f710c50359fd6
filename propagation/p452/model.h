/// Model `p452` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/p452/excess.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> p452Settings();
InputFaults checkP452(const EmitterInputs& inputs);
std::vector<std::string> p452PathWarnings(const PathInputs& inputs);
P452Excess p452Excess(const PathInputs& inputs);
/// Computes the loss of the path in double; the field interpolates linearly between some heights.
Explanation explainP452(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
