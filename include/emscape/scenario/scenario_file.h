/// Reads scenarios from YAML or JSON, strictly.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/document/problem.h"
#include "emscape/scenario/scenario.h"

namespace emscape::scenario {

using document::Problem;
using document::Severity;

/// A scenario, or all that is wrong with it.
struct ParseResult {
  std::shared_ptr<const Scenario> scenario;  ///< null if any problem is an error
  std::vector<Problem> problems;             ///< in the order of the file
};

/// Reads a scenario and every file it names (tracks, antennas; elevation files are opened, not read). Never
/// throws for what is wrong in the files: everything found is in the result, each with file, line and column.
ParseResult parseScenario(const std::string& file);

/// The same, or one Error (bad_input) that lists all problems, one a line. Warnings go to the log.
std::shared_ptr<const Scenario> loadScenario(const std::string& file);

/// The JSON Schema (draft 2020-12) of the format, made from the table that the parser reads by.
std::string scenarioJsonSchema();

}  // namespace emscape::scenario
