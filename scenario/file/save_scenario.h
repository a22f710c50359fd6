/// The text of a scenario as a file of another folder.
#pragma once

#include <filesystem>
#include <string>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// The text with its edits; relative names of files are adapted to the folder.
/// @throws Error (bad_input) as saveScenario()
std::string scenarioTextIn(const Scenario& scenario, const std::filesystem::path& folder);

}  // namespace emscape::scenario
