/// Turns checked sections of a scenario file into what they describe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/emitter.h"
#include "emscape/scenario/platform.h"
#include "emscape/scenario/problem.h"
#include "scenario/section.h"
#include "scenario/text_file.h"

namespace emscape::scenario {

/// What the parsers of one file share.
struct ParseContext {
  std::string file;
  ProblemList problems;
  ContentHash hash;

  /// A name in the scenario as seen from the working folder: relative names count from the scenario's folder.
  std::string resolve(const std::string& name) const;
  /// The bytes of a file named in a section, added to the hash; none, and a problem, if it cannot be read.
  std::optional<std::string> readNamed(const Section& section, const std::string& key);
};

/// Faults that checkObject() finds are told already: these tell only what it cannot see. Where a section is
/// faulty the result is incomplete.
Platform parsePlatform(const Section& section, ParseContext& context);
AntennaPtr parseAntenna(const Section& section, ParseContext& context);  ///< null if faulty
Emitter parseEmitter(const Section& section, const std::vector<Platform>& platforms, ParseContext& context);

/// Rows of a track file (CSV: a header line, then rows; empty lines and lines that begin with # do not
/// count). Every fault is told with its line and column, at most 50 of one file.
/// @param named_at  where the scenario names the file
std::vector<TrackPoint> parseTrack(const std::string& file, const std::string& bytes,
                                   const SourceLocation& named_at, ProblemList& problems);

}  // namespace emscape::scenario
