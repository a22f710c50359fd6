/// Model `parabolic_equation` in the registry.
#pragma once

#include "emscape/propagation/explanation.h"
#include "emscape/propagation/steep_ground.h"
#include "propagation/checks.h"
#include "propagation/choice.h"
#include "propagation/parabolic_equation/excess.h"
#include "propagation/parabolic_equation/field_march.h"
#include "propagation/path_column.h"
#include "propagation/radial.h"
#include "propagation/setting.h"

namespace emscape::propagation {

std::vector<Setting> peSettings();
std::vector<std::string> peWarningMessages(unsigned warnings);
InputFaults checkPe(const EmitterInputs& inputs);
std::vector<ModelChoice> peChoices(const PathInputs& inputs, const RadialInputs& radials);
/// Excess of an emitter's field without its tables, and the marches that compute them.
struct PeField {
  PeExcess excess;
  FieldMarch march;
  std::optional<SteepGround> steep;  ///< none: no terrain
};
/// @throws Error (bad_input) as planMarch()
PeField peField(const PathInputs& inputs, const RadialInputs& radials);
/// Loss (dB over free space) of a path by troposcatter alone, in half of the time, P.1812-8 eq. (44);
/// infinite within line of sight.
/// @param column     of the path; its heights are not read
/// @param end_msl_m  height of the path's end
double troposcatterDb(const PathInputs& inputs, const ExcessColumn& column, double end_msl_m);
/// Marches along the path in double precision; the field at its end, not averaged.
Explanation explainPe(const PathInputs& inputs, PathColumn& path);

}  // namespace emscape::propagation
