#include "emfield/channels/categories.h"

#include <set>

#include "propagation/registry/model_info.h"

namespace emscape::emfield {

using scenario::Quantity;

std::vector<std::string> categoryNames(const scenario::Scenario& scenario, Quantity quantity) {
  if (quantity == Quantity::dominant_model) return propagation::mechanismNames();
  std::vector<std::string> names;
  if (quantity != Quantity::dominant_emitter) return names;
  for (const scenario::Emitter& emitter : scenario.emitters) names.push_back(emitter.name);
  return names;
}

std::vector<int> categoriesOf(const scenario::Scenario& scenario, Quantity quantity) {
  std::set<int> indices;
  for (std::size_t e = 0; e < scenario.emitters.size(); ++e) {
    if (quantity == Quantity::dominant_emitter) indices.insert(static_cast<int>(e));
    if (quantity != Quantity::dominant_model) continue;
    for (const auto mechanism : propagation::modelInfo(scenario.emitters[e].propagation.model).mechanisms)
      indices.insert(static_cast<int>(mechanism));
  }
  return {indices.begin(), indices.end()};
}

}  // namespace emscape::emfield
