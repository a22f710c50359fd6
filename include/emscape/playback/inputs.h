/// Input files: their kind, and scenarios with their terrain.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"
#include "emscape/scenario/terrain.h"

namespace emscape::playback {

enum class InputKind { scenario, volume, mesh, elevation, antenna };

/// The kind of an input, by the file's extension. A folder is a series of volumes, or of meshes
/// (holdsMeshes()).
/// @throws Error (bad_input) if there is no such file or its extension is unknown
InputKind inputKindOf(const std::string& file);

/// A scenario and its terrain; terrain is null if the scenario names none.
struct LoadedScenario {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};
/// @throws Error (bad_input) that lists all faults
LoadedScenario loadScenarioWithTerrain(const std::string& file,
                                       const std::vector<scenario::Edit>& edits = {});
/// An edited scenario with its terrain: the present terrain if the scenario needs the same box of the same
/// elevation files; else the files are read.
/// @throws Error (bad_input) naming the file
LoadedScenario withScenario(const LoadedScenario& loaded, std::shared_ptr<const scenario::Scenario> edited);

}  // namespace emscape::playback
