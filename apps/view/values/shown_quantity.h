/// Quantities and channels of a scenario that the window can show.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::view {

/// @param name  quantity or channel; empty: the first of the output, which every scenario has
/// @return one line that states why the scenario does not have it; empty if it has
std::string missingQuantity(const scenario::Scenario& scenario, const std::string& name);

/// A quantity that can be chosen.
struct ShownQuantity {
  std::string name;   ///< in files and options
  std::string title;  ///< "Power density, dBW/m²"
};
/// A quantity or channel with its title. @param name  also that of a grid or array of other programs
ShownQuantity titled(const std::string& name);

/// Names of the quantities that the scenario has, those of its output first. For a quantity of several
/// channels the names of these.
std::vector<std::string> quantitiesOf(const scenario::Scenario& scenario);

}  // namespace emscape::view
