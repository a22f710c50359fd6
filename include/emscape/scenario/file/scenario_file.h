/// Reads scenarios from YAML or JSON, strictly.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/document/problem.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

using document::Problem;
using document::Severity;

/// A scenario, or all its problems.
struct ParseResult {
  std::shared_ptr<const Scenario> scenario;  ///< null if any problem is an error
  std::vector<Problem> problems;             ///< in the order of the file
};

/// Times for which a scenario is read. Warnings about the steps of its clock and
/// about voxels are given for `series` only.
enum class ReadFor {
  series,       ///< all steps of the clock
  chosen_times  ///< times chosen by the caller
};

/// Reads a scenario and every file it names (tracks, antennas; elevation files are opened but not read).
/// Faults in the files are not thrown; the result lists all of them, each with file, line and column.
/// @param edits  applied before the check; a fault that an edit causes has the edit "PATH=VALUE" as its
/// location
ParseResult parseScenario(const std::string& file, const std::vector<Edit>& edits = {},
                          ReadFor read_for = ReadFor::series);

/// The same for a text, as if it were in a file of a name, which need not exist: relative names of files are
/// those of its folder.
ParseResult parseScenarioText(const std::string& file, const std::string& text,
                              const std::vector<Edit>& edits = {}, ReadFor read_for = ReadFor::series);

/// The same, but throws one Error (bad_input) that lists all errors, one per line. Warnings are logged.
std::shared_ptr<const Scenario> loadScenario(const std::string& file, const std::vector<Edit>& edits = {},
                                             ReadFor read_for = ReadFor::series);

/// Applies further edits as Scenario::set() does, but returns all problems instead of throwing. The given
/// scenario is not changed.
/// @throws Error (bad_input) if the scenario was not read from a file
ParseResult editScenario(const Scenario& scenario, const std::vector<Edit>& edits);

/// The scenario as it was read from its file, with these edits in place of its own. The file is not read
/// again.
/// @throws Error (bad_input) as Scenario::set()
std::shared_ptr<const Scenario> withEdits(const Scenario& scenario, const std::vector<Edit>& edits);

/// "2 values changed" by edits; empty: none.
std::string changeCountOf(const Scenario& scenario);

/// The warnings of the check of a scenario's file and edits, each with its place.
const std::vector<std::string>& warningsOf(const Scenario& scenario);
/// "first (2 values changed)": the name of a scenario, and how many edits it has; for titles of pictures.
std::string titleOf(const Scenario& scenario);
/// "changed: PATH=VALUE", one per line; empty without edits.
std::string changesOf(const Scenario& scenario);

/// The files that a scenario was read from: its own, tracks, antennas, elevation; absolute or relative to the
/// working folder.
std::vector<std::string> filesOf(const Scenario& scenario);

/// Writes the text of a scenario with its edits. Comments, order and everything that was not edited are kept.
/// Relative names of files are adapted to the new folder.
/// @throws Error (bad_input) if the scenario was not read from a file, or a name cannot be changed in the
/// text; (other) if the file cannot be written
void saveScenario(const Scenario& scenario, const std::string& file);

/// The JSON Schema (draft 2020-12) of the format, made from the table that the parser uses.
std::string scenarioJsonSchema();

}  // namespace emscape::scenario
