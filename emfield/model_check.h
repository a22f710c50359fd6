/// Whether the models that a scenario's emitters choose can compute what they are asked for. What they say
/// comes from their rows in the registry; here it gets the emitter's name and the line in the scenario.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/snapshot.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// What can be said before anything is computed.
/// @return warnings, each naming its emitter
/// @throws Error (bad_input) at the place in the scenario for a value that a model refuses
std::vector<std::string> checkModels(const scenario::Scenario& scenario);
/// The same of one emitter.
std::vector<std::string> checkModel(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// What can be said of an emitter where it stands, and of where its paths end.
/// @param inputs   of the emitter's paths, extent included
/// @param remarks  of the model on the paths
/// @return warnings, each naming the emitter
std::vector<std::string> pathWarnings(const scenario::Emitter& emitter, const propagation::PathInputs& inputs,
                                      unsigned remarks);

}  // namespace emscape::emfield
