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
/// Texts of the model's warning bits on the paths of an emitter, one line each, without missing terrain.
std::vector<std::string> itmWarningMessages(unsigned warnings);
Explanation explainItm(const PathInputs& inputs, PathColumn& path);

/// An emitter's link without the antennas' heights.
ItmLink<float> itmLink(const EmitterInputs& inputs);
ItmExcess itmExcess(const PathInputs& inputs);

}  // namespace emscape::propagation
