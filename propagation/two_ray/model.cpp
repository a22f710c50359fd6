#include "propagation/two_ray/model.h"

#include <fmt/core.h>

namespace emscape::propagation {

std::vector<Setting> twoRaySettings() {
  return {choiceSetting<&ModelSettings::two_ray, &TwoRaySettings::sum>(
              "sum",
              "coherent: lobes and nulls; envelope: the maxima of the lobes, for voxels larger than lobes"),
          choiceSetting<&ModelSettings::two_ray, &TwoRaySettings::roughness_model>(
              "roughness_model", "reduction of the reflection by roughness")};
}

InputFaults checkTwoRay(const EmitterInputs& inputs) {
  InputFaults faults;
  checkInput(kTwoRayFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kTwoRayRoughness, inputs.ground.roughness_m, InputOrigin::ground, faults);
  return faults;
}

std::vector<std::string> twoRayPathWarnings(const PathInputs& inputs) {
  return smoothHeightWarnings(kTwoRayHeight, inputs);
}

TwoRayExcess twoRayExcess(const PathInputs& inputs) {
  const EmitterInputs& emitter = inputs.emitter;
  TwoRayParameters parameters;
  parameters.frequency_hz = emitter.frequency_hz;
  parameters.effective_earth_radius_m = inputs.site.effective_earth_radius_m;
  parameters.ground = groundConstants(emitter.ground, emitter.frequency_hz);
  parameters.roughness_m = emitter.ground.roughness_m;
  parameters.roughness_model = emitter.settings.two_ray.roughness_model;
  parameters.sum = emitter.settings.two_ray.sum;
  TwoRayExcess excess;
  excess.both = !isLinear(emitter.polarization);
  parameters.polarization = emitter.polarization == Polarization::vertical ? LinearPolarization::vertical
                                                                           : LinearPolarization::horizontal;
  excess.model = twoRayModel<double>(parameters);
  parameters.polarization = LinearPolarization::vertical;
  excess.vertical = twoRayModel<double>(parameters);
  excess.surface_msl_m = inputs.surface_msl_m;
  excess.tx_msl_m = inputs.site.effective_height_msl_m;
  return excess;
}

Explanation explainTwoRay(const PathInputs& inputs, PathColumn& path) {
  const TwoRayExcess excess = twoRayExcess(inputs);
  const double range_m = path.column().range_m;
  const auto end_msl_m = static_cast<double>(path.column().height_msl_m[0]);
  float loss_db = 0, same_db = 0;
  PathReflection reflection;
  static_cast<ReflectedRay&>(reflection) = excess.reflectedRay(range_m, excess.tx_msl_m, end_msl_m, loss_db);
  reflection.arrival_sine = excess.reflectedRay(range_m, end_msl_m, excess.tx_msl_m, same_db).depression_sine;
  Explanation explanation;
  explanation.add("two_ray", "interference with the reflected ray, horizon", static_cast<double>(loss_db));
  if (reflection.weight > 0) explanation.reflection = reflection;
  explanation.why = fmt::format(
      "over a smooth surface {:.1f} m above mean sea level; terrain has no part in it", inputs.surface_msl_m);
  return explanation;
}

}  // namespace emscape::propagation
