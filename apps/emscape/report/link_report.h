/// Output of `emscape link`: tables, JSON or CSV.
#pragma once

#include <string>

#include "apps/emscape/common/console.h"
#include "emscape/emfield/link/link.h"

namespace emscape::app {

/// The links of a scenario and the names of their ends.
struct NamedLinks {
  std::string file;
  std::shared_ptr<const scenario::Scenario> scenario;
  emfield::LinkReport report;
};

/// The keys are documented in docs/command-line.md. null: no power, no jamming.
Json toJson(const NamedLinks& links);
/// Prints a summary of all pairs, and a table over time for each pair with about twenty rows at most.
void printAsTable(const NamedLinks& links);
/// Writes one row per pair and time. @throws Error (other) if the file cannot be written
void writeCsv(const NamedLinks& links, const std::string& file);

}  // namespace emscape::app
