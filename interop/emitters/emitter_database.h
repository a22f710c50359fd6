/// Databases of emitters: what recordings do not tell of them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/schema.h"
#include "emscape/base/enum_names.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// What happens with beams that no row matches: they are left out and named, left out silently, or have the
/// database's default emitter.
enum class Unmatched { warn, ignore, use_default };
constexpr auto namesOf(Unmatched) {
  return std::array{"warn", "ignore", "default"};
}

/// Conditions of a row; all that are given must hold.
struct EmitterMatch {
  std::optional<int> dis_name, dis_radio, function;
  std::vector<int> beam_function, index;  ///< one of them; empty: any
  /// Patterns; empty: any.
  std::string dis_entity_type, acmi_name, acmi_type, asi_beam, object_name, beam_name;
  std::string cot_type;  ///< beginning; empty: any

  /// True if a condition is of the beam, not of the object.
  bool isOfBeams() const {
    return dis_name.has_value() || dis_radio.has_value() || function.has_value() || !beam_function.empty() ||
           !index.empty() || !asi_beam.empty() || !beam_name.empty();
  }
};

struct EmitterRow {
  std::string name;    ///< of the emitter, after that of its platform
  std::string source;  ///< of the figures
  EmitterMatch match;
  double antenna_height_m = 0;  ///< above the object's reference point
  /// Keys of a scenario's emitter but name and platform.
  document::DocumentNodePtr emitter;
  std::string file;         ///< of the database, for the files that the emitter names
  bool is_starter = false;  ///< of the starter set
};

struct EmitterDatabase {
  std::vector<EmitterRow> rows;
  std::optional<Unmatched> unmatched;  ///< none: not told
  /// The emitter for Unmatched::use_default; its antenna may be missing, and is then made of the beam's
  /// sweep.
  document::DocumentNodePtr default_emitter;
  std::string default_file;
  /// False: rows of the starter set serve beams alone. @see describeRecording()
  bool starter_serves_objects = true;
};

/// A file whose rows match something of the recording describes it: objects that tell of no beam have then no
/// emitter of the starter set, unless the file says `unmatched: default`.
void describeRecording(EmitterDatabase& database, const std::vector<RecordedObject>& objects,
                       const std::vector<RecordedBeam>& beams);

/// True if a text has the form of one of the patterns, which are separated by |. In a pattern * stands for
/// any characters and ? for one; upper and lower case are the same.
bool matchesPattern(const std::string& patterns, const std::string& text);

/// The first row whose conditions hold.
/// @param beam  null: the object's emitter that no beam tells of; only rows without conditions of beams
/// @return null if there is none
const EmitterRow* findRow(const EmitterDatabase& database, const RecordedObject& object,
                          const RecordedBeam* beam);

/// The rows of a file, then those of the starter set; `unmatched` and the default of the file.
/// @param file  empty: the starter set alone
/// @throws Error (bad_input) that lists all faults, each with file:line:column
EmitterDatabase loadEmitterDatabase(const std::string& file);
/// The same of a text. @param file  its name, for messages
EmitterDatabase parseEmitterDatabase(const std::string& file, const std::string& text);

/// The table of the format.
const document::ObjectSpec& emitterDatabaseSpec();
/// The JSON Schema (draft 2020-12) of the format.
std::string emitterDatabaseJsonSchema();

/// The starter set's file, scenarios/data/emitters.yaml, as it was at build time.
extern const char* const kStarterEmitters;

}  // namespace emscape::interop
