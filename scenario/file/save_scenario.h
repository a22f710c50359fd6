/// The text of a scenario as a file of another folder.
#pragma once

#include <filesystem>
#include <string>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// The text with its edits; relative names of files are adapted to the folder.
/// @throws Error (bad_input) as saveScenario()
std::string scenarioTextIn(const Scenario& scenario, const std::filesystem::path& folder);

/// As saveScenario(), with copies of the files that lie in or below the scenario's own folder: into the
/// folder NAME_files beside the file, where they must have different names. Nothing that exists there is
/// replaced but the file itself. @throws as saveScenario(), and Error (other) if a copy cannot be written
void saveWithFiles(const Scenario& scenario, const std::string& file);

}  // namespace emscape::scenario
