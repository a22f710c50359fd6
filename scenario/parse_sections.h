/// Turns checked sections of a scenario file into what they describe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "document/section.h"
#include "document/text_file.h"
#include "emscape/document/problem.h"
#include "emscape/scenario/emitter.h"
#include "emscape/scenario/platform.h"
#include "scenario/schema.h"
#include "scenario/source.h"

namespace emscape::scenario {

using document::ProblemList;
using document::Section;

/// What the parsers of one file share.
struct ParseContext {
  std::string file;
  ProblemList problems;
  document::ContentHash hash;
  const NamedFiles* before = nullptr;  ///< what an earlier reading found in the files; null: read them
  NamedFiles files;                    ///< what this reading found

  /// A name in the scenario as seen from the working folder: relative names count from the scenario's folder.
  std::string resolve(const std::string& name) const;
  /// Adds the content of a file named in a section to the hash; false, and a problem, if it cannot be read.
  /// @param bytes  of a track; set to the content if the file was read now
  bool addNamed(const Section& section, const std::string& key, std::string* bytes = nullptr);
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
