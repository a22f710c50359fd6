/// Whether the models that a scenario's emitters choose can compute what they are asked for. All limits come
/// from the models' own tables (models/model_limits.h).
#pragma once

#include <string>
#include <vector>

#include "emfield/excess/air_loss.h"
#include "emscape/scenario/snapshot.h"

namespace emscape::emfield {

/// What can be said before anything is computed.
/// @return warnings, each naming its emitter
/// @throws Error (bad_input) at the place in the scenario for a value that a model refuses
std::vector<std::string> checkModels(const scenario::Scenario& scenario);
/// The same of one emitter.
std::vector<std::string> checkModel(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// What can be said of an emitter where it stands, and of where its paths end.
/// @param remarks  of the model on the paths (remarkMessages)
/// @return warnings, each naming the emitter
std::vector<std::string> pathWarnings(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                      const scenario::EmitterState& state, const PathExtent& extent,
                                      const scenario::Terrain* terrain, unsigned remarks);

}  // namespace emscape::emfield
