/// Parsers of the checked sections of a scenario file.
#pragma once

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "document/schema_check.h"
#include "document/section.h"
#include "document/text_file.h"
#include "emscape/document/problem.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/platform.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/target.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"

namespace emscape::scenario {

using document::ProblemList;
using document::Section;

/// Context that the parsers of one file share.
struct ParseContext {
  std::string file;
  ReadFor read_for = ReadFor::series;
  ProblemList problems;
  document::ContentHash hash;
  const NamedFiles* before =
      nullptr;       ///< content of the files from an earlier reading; null: the files are read
  NamedFiles files;  ///< content of the files from this reading
  propagation::Atmosphere atmosphere;  ///< of the scenario
  std::string epoch_utc;               ///< of the scenario; empty: none
  FrameOrigin origin;                  ///< of its region
  /// Recordings of other programs that were read, by resolved name and choices.
  std::map<std::string, std::shared_ptr<const interop::Recording>> recordings;
  std::set<std::string> told_of_tracks;  ///< warnings: a file may have the tracks of many platforms
  bool checks_terrain = false;           ///< also of a scenario with errors: parseScenarioToCheck()

  /// Path of a file named in the scenario; relative names are relative to the scenario's folder.
  std::string resolve(const std::string& name) const;
  /// Adds the content of a file named in a section to the hash; false, and a problem, if it cannot be read.
  /// @param bytes  set to the content; null: the content is not needed if it was read before
  bool addNamed(const Section& section, const std::string& key, std::string* bytes = nullptr);
};

/// checkObject() has already reported schema errors; these functions report only semantic ones. The result of
/// a faulty section is incomplete.
Region parseRegion(const Section& section, ParseContext& context);
TerrainSpec parseTerrain(const Section& section, ParseContext& context);
propagation::Atmosphere parseAtmosphere(const Section& section, ParseContext& context);
propagation::Ground parseGround(const Section& section, ParseContext& context);
Platform parsePlatform(const Section& section, ParseContext& context);
AntennaPtr parseAntenna(const Section& section, ParseContext& context);  ///< null if faulty
ScanSpec parseScan(const Section& section, bool steers_electronically, ParseContext& context);
/// Index of the item that a key names; -1, and a problem, if there is none.
/// @param kind  of the items, for the problem
template <class Named>
int indexNamedBy(const Section& section, const char* key, const char* kind, const std::vector<Named>& items,
                 ParseContext& context) {
  const std::string wanted = section.text(key);
  std::vector<std::string> names;
  for (const Named& item : items) {
    if (item.name == wanted) return static_cast<int>(names.size());
    names.push_back(item.name);
  }
  if (!wanted.empty()) {  // else the schema's check has reported it
    context.problems.addError(section.locationOf(key), fmt::format("there is no {} '{}'{}", kind, wanted,
                                                                   document::didYouMean(wanted, names)));
  }
  return -1;
}
/// Null without the key, or if it is faulty.
std::shared_ptr<const propagation::Refractivity> parseRefractivity(const Section& atmosphere,
                                                                   ParseContext& context);
/// k_factor of an atmosphere with linear refractivity, if it is in 0.5..10; else `otherwise`.
double kFactorOf(const Section& atmosphere, double otherwise);
/// Warnings that depend on the emitters and on the ground.
/// @param root  of a scenario without faults
void warnOfRefractivity(const Scenario& scenario, const Section& root, ParseContext& context);
/// @param radar  with its frequency and its waveform
/// @return none if faulty, or without a waveform
std::optional<Clutter> parseClutter(const Section& section, const Emitter& radar, ParseContext& context);
Emitter parseEmitter(const Section& section, const std::vector<Platform>& platforms, ParseContext& context);
/// Cuts the times at which an emitter is active into those of its blinking.
void blink(Emitter& emitter, const Section& section, const Clock& clock, ParseContext& context);

/// Sets the noise temperature of an antenna if its receiver requests that of the sky (antenna_noise).
/// @param section       of the receiver
/// @param frequency_hz  0: unknown, which is a problem
/// @param antenna       null: faulty
void parseAntennaNoise(const Section& section, double frequency_hz, const AntennaPtr& antenna,
                       const ScanSpec& scan, ParseContext& context, double& antenna_temperature_k);

/// The common values of receivers with and without a platform.
ReceiverProfile parseReceiverProfile(const Section& section);
/// @param section  with a platform
PlacedReceiver parsePlacedReceiver(const Section& section, const std::vector<Platform>& platforms,
                                   ParseContext& context);
Target parseTarget(const Section& section, const std::vector<Platform>& platforms, ParseContext& context);

/// Rows of a track file (CSV: a header line, then rows; empty lines and lines that begin with # are skipped).
/// Every fault is reported with its line and column, at most 50 per file.
/// @param named_at  location of the file's name in the scenario
TrackFile parseTrack(const std::string& file, const std::string& bytes, const SourceLocation& named_at,
                     ProblemList& problems);

}  // namespace emscape::scenario
