/// emscape validate: reports all errors in a scenario and the files it names.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "base/text/readable_text.h"
#include "emfield/excess/model_choices.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "report/paths/choices_report.h"
#include "report/paths/refractivity_report.h"
#include "report/runs/work_report.h"
#include "scenario/file/far_outside.h"
#include "scenario/file/scenario_check.h"
#include "scenario/model/step_check.h"

namespace emscape::app {
namespace {

using scenario::Problem;
using scenario::Severity;

bool isError(const Problem& problem) {
  return problem.severity == Severity::error;
}

/// Converts an error to a problem; an error without a location is located in the scenario file.
Problem problemOf(const Error& error, const std::string& scenario_file) {
  const SourceLocation location =
      error.location().file.empty() ? SourceLocation{scenario_file, 0, 0} : error.location();
  return {location, Severity::error, error.message()};
}

/// Reports columns of the region with unknown ground at their centre.
/// @param is_allowed  a warning instead of an error
void checkCoverage(const scenario::Scenario& scenario, const scenario::Terrain& terrain, bool is_allowed,
                   std::vector<Problem>& problems) {
  const WorkPart part("heights below the columns", 0, 1);
  const volume::Grid grid = emfield::gridOf(scenario.region);
  const GeoFrame frame(grid.frame);
  long long missing = 0;
  GeodeticPosition first;
  for (int j = 0; j < grid.dims.y; ++j) {
    reportDone(static_cast<double>(j) / grid.dims.y);
    for (int i = 0; i < grid.dims.x; ++i) {
      const GeodeticPosition position = frame.toGeodetic(grid.center_m(i, j, 0));
      if (!std::isnan(terrain.heightMsl_m(position.latitude_deg, position.longitude_deg))) continue;
      if (missing++ == 0) first = position;
    }
  }
  if (missing == 0) return;
  const bool is_all = missing == static_cast<long long>(grid.dims.x) * grid.dims.y;
  const SourceLocation location = scenario.terrain->locations.empty() ? SourceLocation{scenario.file, 0, 0}
                                                                      : scenario.terrain->locations.front();
  problems.push_back(
      {location, is_allowed ? Severity::warning : Severity::error,
       fmt::format(
           "the elevation files leave {} of the region's {} columns without a height, the first at "
           "latitude {:.5f}, longitude {:.5f} deg; maps have no value there; volumes and pictures have "
           "holes there{}; {}",
           missing, static_cast<long long>(grid.dims.x) * grid.dims.y, first.latitude_deg,
           first.longitude_deg,
           is_allowed ? ""
                      : ", which validate, simulate, render, view and bench accept only with "
                        "--allow-missing-terrain",
           is_all ? terrain.placeText() : scenario::kMissingTerrainRemedy)});
}

/// Checks at every step of the clock that no platform is below the ground or over missing terrain.
/// @return true if the first step has no error
bool checkSteps(const scenario::Scenario& scenario, const scenario::Terrain* terrain,
                std::vector<Problem>& problems) {
  const WorkPart part("steps of the clock", 0, 0);
  bool starts = true;
  for (const scenario::StepFault& fault : scenario::faultsOfSteps(scenario, terrain, 1, stopIfInterrupted)) {
    problems.push_back(problemOf(fault.error, scenario.file));
    problems.back().message = fault.text();
    starts = starts && !fault.at_first;
  }
  return starts;
}

/// Checks that need the whole scenario: the ground, the quantities, the models, every step.
/// @param choices  receives the models' automatic choices at the first step
/// @param work     receives the field's memory, time and disk space, if it can be computed
/// @param status   receives the exit status of the programs that compute the field, if they refuse it
void checkMeaning(const std::shared_ptr<const scenario::Scenario>& scenario, bool allow_missing_terrain,
                  std::vector<Problem>& problems, std::vector<emfield::EmitterChoice>& choices,
                  std::optional<report::WorkEstimate>& work, ErrorCode& status) {
  try {
    scenario::TerrainPtr terrain;
    try {
      terrain = scenario::loadTerrain(*scenario);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::bad_input && scenario::addTerrainFaults(*scenario, problems)) return;
      throw;
    }
    if (terrain) {
      const bool is_allowed = allow_missing_terrain || scenario::mayLackTerrain(*scenario, false);
      checkCoverage(*scenario, *terrain, is_allowed, problems);
      for (const std::string& warning : terrain->warnings())
        problems.push_back({scenario->terrain->locations.front(), Severity::warning, warning});
    }
    const bool starts = checkSteps(*scenario, terrain.get(), problems);
    emfield::FieldOptions options;
    options.allow_missing_terrain = true;  // reported above
    const emfield::FieldSolver solver(scenario, terrain, options);
    const std::vector<std::string> reported = terrain ? terrain->warnings() : std::vector<std::string>{};
    const auto warn = [&](const std::string& warning) {
      Problem problem;
      problem.location.file = scenario->file;
      problem.severity = Severity::warning;
      problem.message = warning;
      problems.push_back(problem);
    };
    for (const std::string& warning : solver.warnings()) {
      if (std::find(reported.begin(), reported.end(), warning) == reported.end()) warn(warning);
    }
    if (!starts) {  // reported above
      work = report::workEstimateOf(solver, *scenario, terrain.get(), {});
      return;
    }
    const scenario::Snapshot first =
        scenario::snapshotAt(scenario, terrain.get(), scenario::timesOf(scenario->clock).front());
    if (const std::string heights = scenario::outsideHeightsText(first, terrain.get()); !heights.empty())
      warn(heights);
    choices = emfield::modelChoices(first, terrain.get());
    work = report::workEstimateOf(solver, *scenario, terrain.get(), choices);
  } catch (const Error& error) {
    const bool is_first = std::none_of(problems.begin(), problems.end(), isError);
    if (is_first) status = error.code();
    problems.push_back(problemOf(error, scenario->file));
  }
}

/// While it exists, messages of libraries are kept; then they go to the console.
class KeptLog {
 public:
  /// @param warnings  receives the warnings at the end
  KeptLog(const GlobalOptions& global, std::vector<std::string>& warnings)
      : global_(global), warnings_(warnings) {
    setLogSink([this](LogLevel level, const std::string& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      messages_.emplace_back(level, message);
    });
  }
  ~KeptLog() {
    installLog(global_);
    for (const auto& [level, message] : messages_) {
      if (level == LogLevel::info) logInfo(message);
      if (level != LogLevel::warning) continue;
      logWarning(message);
      warnings_.push_back(message);
    }
  }
  KeptLog(const KeptLog&) = delete;
  KeptLog& operator=(const KeptLog&) = delete;

 private:
  const GlobalOptions& global_;
  std::vector<std::string>& warnings_;
  std::mutex mutex_;
  std::vector<std::pair<LogLevel, std::string>> messages_;
};

struct ValidateCommand {
  std::string file;
  std::vector<scenario::Edit> edits;
  bool allow_missing_terrain = false;
};

int validate(const ValidateCommand& command, const GlobalOptions& global) {
  const EndAtInterrupts at_once;
  const std::string& file = command.file;
  std::vector<std::string> warnings;
  scenario::ParseResult result;
  std::vector<emfield::EmitterChoice> choices;
  std::optional<report::WorkEstimate> work;
  ErrorCode status = ErrorCode::bad_input;
  {
    const KeptLog log(global, warnings);
    result = scenario::parseScenarioToCheck(file, command.edits);
    if (result.scenario)
      checkMeaning(result.scenario, command.allow_missing_terrain, result.problems, choices, work, status);
  }
  const bool ok = std::none_of(result.problems.begin(), result.problems.end(), isError);

  const std::string air = result.scenario ? report::airSource(*result.scenario) : "";
  if (global.json) {
    for (const std::string& warning : warnings) {
      Problem& problem = result.problems.emplace_back();
      problem.location.file = file;
      problem.severity = Severity::warning;
      problem.message = warning;
    }
    Json problems = Json::array();
    for (const Problem& problem : result.problems) {
      problems.push_back({{"file", problem.location.file},
                          {"line", problem.location.line},
                          {"column", problem.location.column},
                          {"severity", toString(problem.severity)},
                          {"message", problem.message}});
    }
    printJson({{"ok", ok},
               {"problems", problems},
               {"choices", report::choicesJson(choices)},
               {"air", air},
               {"work", work ? report::workJson(*work) : Json(nullptr)}});
  } else {
    for (const Problem& problem : result.problems) {
      print("{}: {}: {}\n", readableText(emscape::toString(problem.location)), toString(problem.severity),
            problem.message);
    }
    if (ok && !global.quiet) {
      if (!air.empty()) print("air: {}\n", air);
      for (const emfield::EmitterChoice& choice : choices)
        print("emitter '{}': {}: {} {}\n", choice.emitter, choice.model, choice.name, choice.text);
      if (work) print("{}\n", report::workText(*work));
      print("{}: ok\n", readableText(file));
    }
  }
  return ok ? 0 : static_cast<int>(status);
}

}  // namespace

void addValidate(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("validate", "Check a scenario and every file it names");
  command->fallthrough();
  command->footer(R"(
Reports all faults at once, each as file:line:column: error: message. Also checks that the elevation files cover the region and that
no platform is below the ground at any step, and that the field fits into the memory. The last line but one says how much memory
`simulate` takes at most on the CPU, how long and large a series is, and the time that its field takes, within a factor of 5.
What models choose by themselves (keys that are auto) is printed with its reason.

Examples:
  emscape validate scenarios/jacksboro.yaml
  emscape validate mine.yaml --set "emitters.search radar.power_w=500"
  emscape validate mine.yaml --json        {"ok", "problems": [{"file", "line", "column", "severity", "message"}],
                                            "choices": [{"emitter", "model", "name", "text"}], "air",
                                            "work": {"memory_mib", "volumes_mib", "emitters_mib", "terrain_mib",
                                                     "available_mib", "steps", "step_mib", "time_s", "threads"}}

Exit status: 0 without errors (warnings are ignored), 3 otherwise.)");
  auto options = std::make_shared<ValidateCommand>();
  command->add_option("SCENARIO", options->file, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_flag("--allow-missing-terrain", options->allow_missing_terrain,
                    "Missing elevation data in the region are a warning, as for maps");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return validate(*options, global); }; });
}

}  // namespace emscape::app
