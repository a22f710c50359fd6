/// Input files: what kind a file is, and scenarios with their ground.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"
#include "emscape/scenario/terrain.h"

namespace emscape::playback {

enum class InputKind { scenario, volume, elevation, antenna };

/// Guesses by the file's ending; a folder holds volumes.
/// @throws Error (bad_input) if there is no such file or its ending is not known
InputKind inputKindOf(const std::string& file);

/// A scenario and the ground that it names; terrain is null if it names none.
struct LoadedScenario {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};
/// @throws Error (bad_input) that lists all that is wrong
LoadedScenario loadScenarioWithTerrain(const std::string& file,
                                       const std::vector<scenario::Edit>& edits = {});
/// An edited scenario with its ground: the ground that is there where the scenario names the same elevation
/// files and needs the same box of them, else the files are read.
/// @throws Error (bad_input) naming the file
LoadedScenario withScenario(const LoadedScenario& loaded, std::shared_ptr<const scenario::Scenario> edited);

}  // namespace emscape::playback
