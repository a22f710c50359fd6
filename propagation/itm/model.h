/// Model `itm` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/itm/excess.h"
#include "propagation/path_column.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> itmSettings();
InputFaults checkItm(const EmitterInputs& inputs);
/// What the model's remarks on the paths of an emitter mean, one line each; those on missing terrain left
/// out.
std::vector<std::string> itmRemarkMessages(unsigned remarks);
Explanation explainItm(const PathInputs& inputs, PathColumn& path);

/// An emitter's link but for the antennas' heights.
ItmLink<float> itmLink(const EmitterInputs& inputs);
ItmExcess itmExcess(const PathInputs& inputs);

}  // namespace emscape::propagation
