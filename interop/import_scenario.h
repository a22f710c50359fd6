/// Makes a scenario of a recording.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/progress.h"
#include "emscape/scenario/model/scenario.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Meaning of the beamwidths of a recording: those of the beam, or those of the sector that it searches,
/// which many programs write. by_size: beam up to 15 degrees.
enum class BeamwidthMeaning { by_size, scan, beam };
constexpr auto namesOf(BeamwidthMeaning) {
  return std::array{"by_size", "scan", "beam"};
}

/// A square region of the field.
struct RegionRequest {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double size_km = 0;
};
/// "36.3,-84.2,80". @throws Error (usage) with the allowed ranges
RegionRequest parseRegion(const std::string& text);

/// For each object of a recording or stream the platform of a base that it moves, if any: the one of its
/// name, or one that begins so, as markings of DIS are cut to 11 characters. A platform is moved by one
/// object, the first.
/// @param objects  their names
std::vector<std::optional<std::size_t>> movedPlatforms(const std::vector<std::string>& objects,
                                                       const scenario::Scenario& base);

struct ImportOptions {
  std::string scenario;  ///< the file to write; the tracks go into STEM_tracks beside it
  std::string emitters;  ///< emitter database; empty: the starter set
  std::string base;      ///< scenario to which the recording is added; empty: none
  std::shared_ptr<const scenario::Scenario> loaded_base;  ///< the same as it was read; null: it is read
  bool keeps_name = false;              ///< the scenario has the name of the base; else that of the file
  std::vector<std::string> terrain;     ///< elevation files
  std::optional<RegionRequest> region;  ///< none: around all platforms, or that of the base
  std::optional<TimeSpan> times;        ///< part of the recording, in its own seconds
  std::vector<std::string> only;  ///< patterns of names and types of objects; empty: see importRecording()
  BeamwidthMeaning beamwidth = BeamwidthMeaning::by_size;
  bool replace = false;  ///< files that exist; else they are an error
  /// A recording without any emitter gets one that is switched off, on its first platform, since a scenario
  /// has at least one; false: an error.
  bool adds_silent_emitter = false;
};

/// Objects of one type.
struct ImportedType {
  std::string type;  ///< as in the recording
  std::string text;  ///< the same in words
  Domain domain = Domain::other;
  int objects = 0;
  int emitters = 0;  ///< that they carry in the scenario
};

/// Emitters of one row of the database, or beams that no row matches.
struct ImportedEmitters {
  std::string name;    ///< of the row; of the beam if it is not matched
  std::string source;  ///< of the row's figures
  std::string fault;   ///< why they are not in the scenario; empty: they are
  int count = 0;
};

/// A platform of the scenario.
struct ImportedPlatform {
  std::string object;  ///< RecordedObject::id
  std::string name;    ///< of the platform
  double raise_m = 0;  ///< its height above the object's: that of the highest antenna
};

struct ImportResult {
  std::string scenario;  ///< the written file
  std::string tracks;    ///< folder of the written tracks; empty: no platform moves
  int track_files = 0;
  std::string format;
  std::string epoch_utc;  ///< of t = 0; empty: the recording has none
  TimeSpan recorded;      ///< of the whole recording
  double duration_s = 0;  ///< of the scenario
  std::vector<ImportedType> types;
  std::vector<ImportedEmitters> emitters;
  std::vector<ImportedPlatform> platforms;  ///< in the order of the recording
  std::vector<std::string> moved;           ///< platforms of the base whose place or track is the recording's
  std::string silent_emitter;               ///< ImportOptions::adds_silent_emitter; empty: none was added
  std::map<std::string, int> left_out;      ///< objects, by reason
  ReadingTally tally;
  std::vector<std::string> notes;  ///< assumptions of the conversion, each with its effect
};

/// Writes a scenario, and CSV tracks for the platforms that move. Without `only`, scenery (reference points,
/// effects) and weapons without an emission are left out.
/// Emitters are the recording's beams with what the database has on them; an object without beams has the
/// emitter of the first row that matches it. An object with the name of a platform of the base moves that
/// platform, which gets those emitters only of whose kind it has none.
/// @throws Error (bad_input): no object, or no emitter is left, a fault in the database or the base; (usage):
/// a file exists; (other): a file cannot be written
ImportResult importRecording(const Recording& recording, const ImportOptions& options,
                             const ProgressSink& progress = {});

}  // namespace emscape::interop
