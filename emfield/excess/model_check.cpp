#include "emfield/excess/model_check.h"

#include <fmt/format.h>

#include "emfield/excess/elevation_cut.h"
#include "emfield/excess/emitter_excess.h"
#include "emscape/base/error.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using propagation::InputOrigin;
using propagation::ModelInfo;
using scenario::Emitter;
using scenario::Scenario;

std::string inModel(const Emitter& emitter, const std::string& model, const std::string& message) {
  return fmt::format("emitter '{}': '{}': {}", emitter.name, model, message);
}

const SourceLocation& locationOf(InputOrigin origin, const Scenario& scenario, const Emitter& emitter) {
  switch (origin) {
    case InputOrigin::frequency:
      return emitter.frequency_location;
    case InputOrigin::ground:
      return scenario.ground.location;
    case InputOrigin::settings:
      return emitter.propagation.location;
  }
  return emitter.location;
}

}  // namespace

std::vector<std::string> checkModel(const Scenario& scenario, const Emitter& emitter) {
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  checkElevationCut(scenario, emitter);
  std::vector<std::string> warnings;
  for (const propagation::InputFault& fault : model.check(emitterInputs(scenario, emitter))) {
    const std::string message = inModel(emitter, model.name, fault.message);
    if (fault.is_refused) {
      throw Error(ErrorCode::bad_input, locationOf(fault.origin, scenario, emitter), message);
    }
    warnings.push_back(message);
  }
  return warnings;
}

std::vector<std::string> checkModels(const Scenario& scenario) {
  std::vector<std::string> warnings;
  for (const Emitter& emitter : scenario.emitters) {
    const std::vector<std::string> of_emitter = checkModel(scenario, emitter);
    warnings.insert(warnings.end(), of_emitter.begin(), of_emitter.end());
  }
  return warnings;
}

std::vector<std::string> pathWarnings(const Emitter& emitter, const propagation::PathInputs& inputs,
                                      unsigned warnings) {
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  std::vector<std::string> messages = model.warningMessages(warnings);
  for (std::string& warning : model.pathWarnings(inputs)) messages.push_back(std::move(warning));
  for (std::string& message : messages) message = inModel(emitter, model.name, message);
  return messages;
}

std::vector<std::string> seaWarnings(const Scenario& scenario, const Emitter& emitter, double lowest_m) {
  constexpr double kNoise_m = -2;  // heights of a calm sea in elevation files are this close to 0
  std::vector<std::string> warnings;
  if (!(lowest_m < kNoise_m)) return warnings;
  const auto warn = [&](const std::string& who, const std::string& remedy) {
    warnings.push_back(
        fmt::format("emitter '{}': ground lies down to {:.0f} m, and {} takes ground at or below mean sea "
                    "level for sea; where "
                    "it is land, {}",
                    emitter.name, lowest_m, who, remedy));
  };
  using propagation::ClearAirZone;
  using propagation::PropagationModel;
  const propagation::ModelSettings& settings = emitter.propagation;
  const PropagationModel model = emitter.propagation.model;
  if (model == PropagationModel::p1812 && settings.p1812.zone == ClearAirZone::by_height)
    warn("'p1812'", "'p1812: {zone: inland}' (or coastal_land) says so");
  if (model == PropagationModel::p452 && settings.p452.zone == ClearAirZone::by_height)
    warn("'p452'", "'p452: {zone: inland}' (or coastal_land) says so");
  if (model == PropagationModel::diffraction && scenario.ground.sea_by_height)
    warn("'diffraction'", "leave out 'ground: {sea_by_height: true}'");
  if (emitter.clutter && emitter.clutter->sea_state)
    warn("its clutter", "leave out 'sea_state' of the clutter");
  return warnings;
}

}  // namespace emscape::emfield
