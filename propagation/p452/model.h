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
/// By the path's own loss in double; the field draws lines between some of its heights.
Explanation explainP452(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
