#include "propagation/diffraction/model.h"

#include <algorithm>

namespace emscape::propagation {

std::vector<Setting> diffractionSettings() {
  return {choiceSetting<&ModelSettings::diffraction, &DiffractionSettings::method>(
      "method",
      "delta_bullington: terrain as one edge, and the smooth earth; single_edge, deygout (three edges): "
      "terrain only")};
}

InputFaults checkDiffraction(const EmitterInputs& inputs) {
  InputFaults faults;
  checkInput(kDiffractionFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  return faults;
}

std::vector<std::string> diffractionPathWarnings(const PathInputs& inputs) {
  std::vector<std::string> messages;
  const auto check = [&](const ModelLimit& limit, double value_si) {
    if (!limit.holds(value_si)) messages.push_back(outsideMessage(limit, value_si));
  };
  const bool is_exponential = inputs.emitter.atmosphere.refraction == RefractionProfile::exponential &&
                              inputs.emitter.settings.model == PropagationModel::diffraction;
  if (!is_exponential)
    check(kDiffractionHeight, std::max(inputs.site.height_msl_m, inputs.extent.highest_msl_m));
  check(kDiffractionDistance, std::max(inputs.extent.farthest_m, 1e3));
  return messages;
}

DiffractionExcess diffractionExcess(const PathInputs& inputs) {
  DiffractionParameters parameters;
  parameters.frequency_hz = inputs.emitter.frequency_hz;
  parameters.effective_earth_radius_m = inputs.site.effective_earth_radius_m;
  parameters.polarization = linearPolarization(inputs.emitter.polarization);
  parameters.sea_by_height = inputs.emitter.ground.sea_by_height;
  parameters.land = groundConstants(inputs.emitter.ground, inputs.emitter.frequency_hz);
  return {diffractionModel<float>(parameters), static_cast<float>(inputs.site.effective_height_msl_m)};
}

EdgeExcess edgeExcess(const PathInputs& inputs) {
  const DiffractionExcess diffraction = diffractionExcess(inputs);
  return {diffraction.model, diffraction.tx_msl_m,
          inputs.emitter.settings.diffraction.method == DiffractionMethod::deygout};
}

Explanation explainDiffraction(const PathInputs& inputs, PathColumn& path) {
  Explanation explanation;
  if (inputs.emitter.settings.diffraction.method != DiffractionMethod::delta_bullington) {
    const EdgeExcess model = edgeExcess(inputs);
    explanation.add("edges", model.three_edges ? "three edges (Deygout)" : "the largest edge",
                    path.excess_db(model));
    explanation.why = "terrain as knife edges only, without the earth's bulge";
    return explanation;
  }
  const DiffractionExcess model = diffractionExcess(inputs);
  const double loss_db = path.excess_db(model);
  const double terrain_db = static_cast<double>(
      deltaBullington(model.model, path.column().profile, model.tx_msl_m, path.column().height_msl_m[0])
          .terrain_db);
  explanation.add("terrain_edge", "terrain as one edge (Bullington)", terrain_db);
  explanation.add("smooth_earth", "smooth-earth correction (P.526 4.5.3)", loss_db - terrain_db);
  explanation.why = "delta-Bullington over the terrain profile";
  return explanation;
}

}  // namespace emscape::propagation
