/// Model `diffraction` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/diffraction/edge_excess.h"
#include "propagation/diffraction/excess.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> diffractionSettings();
InputFaults checkDiffraction(const EmitterInputs& inputs);
std::vector<std::string> diffractionPathWarnings(const PathInputs& inputs);
Explanation explainDiffraction(const PathInputs& inputs, PathColumn& path);

/// By the method delta_bullington, whatever the settings.
DiffractionExcess diffractionExcess(const PathInputs& inputs);
/// By the methods single_edge and deygout.
EdgeExcess edgeExcess(const PathInputs& inputs);

}  // namespace emscape::propagation
