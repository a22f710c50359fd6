/// Counting of what cannot be read or is not used.
#pragma once

#include <string>

#include "recording/common/recording.h"
#include "recording/common/samples.h"

namespace emscape::interop {

/// Counts a record that cannot be read; the reason of the first one is kept.
/// @param location  "line 12"
inline void countBad(ReadingTally& tally, const std::string& location, const std::string& reason) {
  if (tally.bad++ == 0) tally.first_bad = location + ": " + reason;
}

/// Counts a record or property without use.
inline void countIgnored(ReadingTally& tally, const std::string& kind) {
  auto found = tally.ignored.find(kind);
  if (found == tally.ignored.end()) {
    const bool is_full = tally.ignored.size() >= RecordingLimits::kKinds;
    found = tally.ignored.emplace(is_full ? std::string("others") : kind, 0).first;
  }
  ++found->second;
}

}  // namespace emscape::interop
