/// Output of `emscape link`: tables, JSON or CSV.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/emfield/link/link.h"
#include "report/json.h"

namespace emscape::report {

/// The links of a scenario and the names of their ends.
struct NamedLinks {
  std::string file;
  std::shared_ptr<const scenario::Scenario> scenario;
  emfield::LinkReport report;
};

/// Links by the names of their ends.
struct LinkSelection {
  std::string prefix;  ///< of the names of these options in messages: "--" on a command line
  std::string times;   ///< as of scenario::parseTimes(); empty: the scenario's clock
  /// As of scenario::namedIndices(). Receivers without targets exclude all targets, and vice versa.
  std::vector<std::string> emitters, receivers, targets;
  std::string model;  ///< in place of the emitters' own; empty: these
};
/// @throws Error (usage) that lists the existing names
emfield::LinkOptions linkOptions(const scenario::Scenario& scenario, const LinkSelection& selection);

/// emfield::computeLinks() over the scenario's terrain.
/// @throws Error (bad_input) also if there is no link
emfield::LinkReport computeLinks(const std::shared_ptr<const scenario::Scenario>& scenario,
                                 const emfield::LinkOptions& options, const ProgressSink& progress);

/// The keys are documented in docs/command-line.md. null: no power, no jamming.
Json toJson(const NamedLinks& links);
/// A summary of all pairs, and a table over time for each pair with about twenty rows at most.
std::string linksText(const NamedLinks& links);
/// Writes one row per pair and time. @throws Error (other) if the file cannot be written
void writeCsv(const NamedLinks& links, const std::string& file);

}  // namespace emscape::report
