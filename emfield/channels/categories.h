/// Meaning of the indices of categorical quantities.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

/// Names of the indices 0, 1 ... of a quantity: the emitters (dominant_emitter), or all models and their
/// parts (dominant_model). Empty: the quantity is not categorical.
std::vector<std::string> categoryNames(const scenario::Scenario& scenario, scenario::Quantity quantity);

/// The indices that can occur in the scenario, ascending.
std::vector<int> categoriesOf(const scenario::Scenario& scenario, scenario::Quantity quantity);

}  // namespace emscape::emfield
