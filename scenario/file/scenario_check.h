/// Reading of a scenario that stops at no fault.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/file/scenario_file.h"

namespace emscape::scenario {

/// parseScenario() that reads the elevation files and the land cover of a scenario with errors, too.
ParseResult parseScenarioToCheck(const std::string& file, const std::vector<Edit>& edits);

/// Adds the faults of the elevation files and the land cover at locations that have no error yet.
/// @return false if there is none
bool addTerrainFaults(const Scenario& scenario, std::vector<Problem>& problems);

}  // namespace emscape::scenario
