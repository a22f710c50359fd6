/// The source of a scenario: its text with the edits, and the content of the files that it names.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/edited_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/platform.h"
#include "emscape/scenario/model/target.h"
#include "scenario/air/refractivity_file.h"
#include "scenario/antenna/shapes.h"
#include "scenario/file/recorded_track.h"

namespace emscape::scenario {

/// Largest scenario file (bytes).
constexpr std::size_t kMaxScenarioBytes = std::size_t{4} << 20;

/// Lists of files of the section terrain.
enum class TerrainList { ground, surface, land_cover };

/// Content of the files that a scenario names, at the time of reading. An edited scenario reuses it: files
/// are not read again.
struct NamedFiles {
  std::map<std::string, std::string> digests;  ///< ContentHash of a file's bytes, by its resolved name
  /// By resolved name and, of files of other programs, what the section of the track says.
  std::map<std::string, std::shared_ptr<const TrackFile>> tracks;
  std::map<std::string, AntennaPtr> antennas;       ///< by the antenna's keys and values, written on one line
  std::map<std::string, StatedBand> antenna_bands;  ///< of antenna files, by resolved name
  std::map<std::string, RcsTablePtr> rcs_tables;    ///< valid ones, by resolved name
  std::map<std::string, std::shared_ptr<const RefractivityFile>>
      refractivity;                        ///< by name and sounding's time
  document::DocumentNodePtr terrain_node;  ///< null without terrain
  std::string terrain_digest;              ///< names and sizes of the elevation files
  std::map<TerrainList, std::vector<std::vector<std::string>>> terrain_files;  ///< that each item stands for
};

/// An applied edit.
struct MadeEdit {
  Edit edit;
  bool moves_paths = false;  ///< the same path may refer to another value afterwards, because a name changed
                             ///< or an item was removed
  bool adds = false;         ///< a key or an item that was not there: its removal leaves the same text
  document::DocumentNodePtr before;  ///< the value in the file, if it is a number, text or word; else null
};

/// Immutable; shared by all copies of a scenario.
struct ScenarioSource {
  document::EditedText text;
  document::DocumentNodePtr root;  ///< null if the text could not be read
  std::vector<MadeEdit> edits;     ///< since the file was read, without superseded ones
  NamedFiles files;
  ReadFor read_for = ReadFor::series;
  std::vector<std::string> warnings;  ///< of the check, each with its place
};

/// True if an edit added what is at a path.
bool isAdded(const ScenarioSource& source, const std::string& path);

/// Changes text, root and edits. A value that becomes again what it was in the file, 20000 in place of 20e3,
/// is written as in the file and leaves no edit.
/// @throws Error (bad_input) whose location is the edit itself; the source is then unchanged
void applyEdit(ScenarioSource& source, const Edit& edit);

}  // namespace emscape::scenario
