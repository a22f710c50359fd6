#include "emfield/excess/model_choices.h"

#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/radials.h"
#include "emscape/emfield/solver/field_solver.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {

std::vector<EmitterChoice> modelChoices(const scenario::Snapshot& snapshot,
                                        const scenario::Terrain* terrain) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  std::vector<EmitterChoice> all;
  GridColumns columns;
  for (std::size_t e = 0; e < scenario.emitters.size(); ++e) {
    const scenario::Emitter& emitter = scenario.emitters[e];
    const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
    if (model.choices == nullptr) continue;
    if (columns.count() == 0) columns = makeGridColumns(gridOf(scenario.region), terrain);
    const scenario::EmitterState& state = snapshot.emitters[e];
    const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere);
    const propagation::PathExtent extent = pathExtent(station, columns);
    inModel(emitter, [&] {
      const auto inputs = pathInputs(scenario, emitter, state.beam, station, terrain, extent);
      for (propagation::ModelChoice& choice :
           model.choices(inputs, radialInputs(station, columns, terrain, extent))) {
        all.push_back(
            {emitter.name, model.name, std::move(choice.name), std::move(choice.text), choice.time_s});
      }
    });
  }
  return all;
}

}  // namespace emscape::emfield
