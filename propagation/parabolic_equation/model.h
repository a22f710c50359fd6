/// Model `parabolic_equation` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/choice.h"
#include "propagation/parabolic_equation/excess.h"
#include "propagation/parabolic_equation/field_march.h"
#include "propagation/path_column.h"
#include "propagation/radial.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> peSettings();
InputFaults checkPe(const EmitterInputs& inputs);
std::vector<ModelChoice> peChoices(const PathInputs& inputs, const RadialInputs& radials);
/// Excess of an emitter's field without its tables, and the marches that compute them.
struct PeField {
  PeExcess excess;
  FieldMarch march;
};
/// @throws Error (bad_input) as planMarch()
PeField peField(const PathInputs& inputs, const RadialInputs& radials);
/// Marches along the path in double precision; the field at its end, not averaged.
Explanation explainPe(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
