/// What a scenario was read from: its text with the edits made to it, and the other files that it names.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/edited_text.h"
#include "emscape/scenario/antenna.h"
#include "emscape/scenario/edit.h"
#include "emscape/scenario/platform.h"

namespace emscape::scenario {

/// Largest scenario file (bytes).
constexpr std::size_t kMaxScenarioBytes = std::size_t{4} << 20;

/// What the files that a scenario names held when they were read. An edited scenario takes over what it still
/// names: files are not read again.
struct NamedFiles {
  std::map<std::string, std::string> digests;  ///< ContentHash of a file's bytes, by its name as resolved
  std::map<std::string, std::shared_ptr<const std::vector<TrackPoint>>> tracks;  ///< sound ones, likewise
  std::map<std::string, AntennaPtr> antennas;  ///< by the antenna's keys and values, written on one line
  document::DocumentNodePtr terrain_node;      ///< null without terrain
  std::string terrain_digest;                  ///< names and sizes of the elevation files
};

/// An edit that was made.
struct MadeEdit {
  Edit edit;
  bool moves_paths =
      false;  ///< the same path may lead elsewhere afterwards: a name changed, or an item was removed
};

/// Immutable; shared by all copies of a scenario.
struct ScenarioSource {
  document::EditedText text;
  document::DocumentNodePtr root;  ///< null if the text could not be read
  std::vector<MadeEdit> edits;     ///< since the file; those that later ones made superfluous are left out
  NamedFiles files;
};

/// Changes text, root and edits.
/// @throws Error (bad_input) whose place is the edit itself; the source is then unchanged
void applyEdit(ScenarioSource& source, const Edit& edit);

}  // namespace emscape::scenario
