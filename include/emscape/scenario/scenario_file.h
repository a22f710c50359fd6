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

/// A scenario, or all its problems.
struct ParseResult {
  std::shared_ptr<const Scenario> scenario;  ///< null if any problem is an error
  std::vector<Problem> problems;             ///< in the order of the file
};

/// What a scenario is read for: all steps of its clock, or times that are chosen otherwise, of which warnings
/// about the steps do not speak.
enum class ReadFor { series, chosen_times };

/// Reads a scenario and every file it names (tracks, antennas; elevation files are opened, not read). Faults
/// in the files do not throw: all are in the result, each with file, line and column.
/// @param edits  applied before the check; the location of a fault that one causes is the edit, as
/// "PATH=VALUE"
ParseResult parseScenario(const std::string& file, const std::vector<Edit>& edits = {},
                          ReadFor read_for = ReadFor::series);

/// The same, or one Error (bad_input) that lists all problems, one per line. Warnings go to the log.
std::shared_ptr<const Scenario> loadScenario(const std::string& file, const std::vector<Edit>& edits = {},
                                             ReadFor read_for = ReadFor::series);

/// A scenario with further edits, as by Scenario::set(), with the warnings and without an exception. The
/// given scenario is not changed.
/// @throws Error (bad_input) if the scenario was not read from a file
ParseResult editScenario(const Scenario& scenario, const std::vector<Edit>& edits);

/// The files that a scenario was read from: its own, tracks, antennas, elevation; absolute or relative to the
/// working folder.
std::vector<std::string> filesOf(const Scenario& scenario);

/// Writes the text of a scenario with its edits: comments, order and everything that was not edited are kept.
/// Files that it names relative to its folder are named relative to the new one.
/// @throws Error (bad_input) if the scenario was not read from a file, or a name cannot be changed in the
/// text; (other) if the file cannot be written
void saveScenario(const Scenario& scenario, const std::string& file);

/// The JSON Schema (draft 2020-12) of the format, made from the table that the parser uses.
std::string scenarioJsonSchema();

}  // namespace emscape::scenario
