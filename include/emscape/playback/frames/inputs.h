/// Input files: their kind, and scenarios with their terrain.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::playback {

enum class InputKind { scenario, volume, mesh, elevation, antenna, recording };

/// The kind of an input, by the file's extension. A folder is a series of volumes, or of meshes
/// (holdsMeshes()).
/// @throws Error (bad_input) if there is no such file or its extension is unknown
InputKind inputKindOf(const std::string& file);

/// What a file in JSON describes.
enum class JsonContent {
  other,     ///< a scenario, or not recognised; also files that are not in JSON
  view,      ///< see readViewState()
  transfer,  ///< a transfer function
  header,    ///< of the volume beside it
  series     ///< of the volumes in its folder
};
/// The content by the name and the keys; only files whose extension is .json are read, up to 16 MiB.
JsonContent jsonContentOf(const std::string& file);
/// Refuses JSON files that describe something else than a scenario.
/// @throws Error (bad_input) that says what the file is and how it is used
void requireScenarioFile(const std::string& file);

/// A scenario and its terrain; terrain is null if the scenario names none.
struct LoadedScenario {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};
/// @throws Error (bad_input) that lists all faults; as requireScenarioFile()
LoadedScenario loadScenarioWithTerrain(const std::string& file,
                                       const std::vector<scenario::Edit>& edits = {});
/// An edited scenario with its terrain: the present terrain if the scenario needs the same box of the same
/// elevation files; else the files are read.
/// @throws Error (bad_input) naming the file
LoadedScenario withScenario(const LoadedScenario& loaded, std::shared_ptr<const scenario::Scenario> edited);

}  // namespace emscape::playback
