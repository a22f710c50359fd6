/// Model `two_ray` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"
#include "propagation/two_ray/excess.h"

namespace emscape::propagation {

std::vector<Setting> twoRaySettings();
InputFaults checkTwoRay(const EmitterInputs& inputs);
std::vector<std::string> twoRayPathWarnings(const PathInputs& inputs);
TwoRayExcess twoRayExcess(const PathInputs& inputs);
Explanation explainTwoRay(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
