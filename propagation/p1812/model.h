/// Model `p1812` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/p1812/excess.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> p1812Settings();
InputFaults checkP1812(const EmitterInputs& inputs);
std::vector<std::string> p1812PathWarnings(const PathInputs& inputs);
P1812Excess p1812Excess(const PathInputs& inputs);
/// Computes the loss of the path in double; the field interpolates linearly between some heights.
Explanation explainP1812(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
