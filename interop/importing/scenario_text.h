/// The text of an imported scenario.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "interop/importing/nodes.h"

namespace emscape::interop {

/// What a scenario is written from.
struct ScenarioParts {
  std::string header;     ///< lines of a comment, without #
  std::string name;       ///< empty: that of the base
  std::string epoch_utc;  ///< empty: none
  double duration_s = 0, step_s = 1;
  DocumentNodePtr region;            ///< null: that of the base
  std::vector<std::string> terrain;  ///< elevation files, as named on the command line
  std::vector<DocumentNodePtr> platforms, emitters;
  std::map<std::size_t, DocumentNodePtr> moved;  ///< by platform of the base: where it is now
};

std::string scenarioText(const ScenarioParts& parts, const std::filesystem::path& folder);

/// The text of a base scenario with name, epoch, duration and, where they are given, region and terrain
/// replaced, platforms moved, and platforms and emitters added.
/// @throws Error (bad_input) naming the base
std::string scenarioTextOnBase(const scenario::Scenario& base, const ScenarioParts& parts,
                               const std::filesystem::path& folder);

/// Tells that an epoch is years from that of the base: clocks of receivers may count from another year. Empty
/// if it is not, or one of them is not known.
/// @param epoch_ms  of a recording, since 1970
std::string farEpochText(std::optional<std::int64_t> epoch_ms, const scenario::Scenario& base);

}  // namespace emscape::interop
