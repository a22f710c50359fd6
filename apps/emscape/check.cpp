/// emscape check: the propagation models against reference figures and measured paths.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/files/inputs.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/registry/model_info.h"
#include "report/runs/check_report.h"
#include "report/runs/measured_report.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

struct CheckOptions {
  std::string data;  ///< folder of datasets, or a table of measured paths
  std::string scenario, emitter;
  std::vector<scenario::Edit> edits;
  std::vector<std::string> columns, conditions, models;
  double group_deg = 0;

  /// True if an option of measured paths is given.
  bool isForPaths() const {
    return !scenario.empty() || !emitter.empty() || !columns.empty() || !conditions.empty() ||
           !models.empty() || group_deg > 0;
  }
};

int checkFigures(const std::string& folder, const GlobalOptions& global) {
  const report::CheckReport report = report::checkReport(folder, stoppingProgress(global));
  if (global.json) {
    printJson(report::toJson(report));
  } else {
    printResult(report::checkText(report));
  }
  if (!report.unreadable.empty()) return static_cast<int>(ErrorCode::bad_input);
  return report.pass() ? 0 : static_cast<int>(ErrorCode::check_failed);
}

emfield::MeasuredOptions measuredOptions(const CheckOptions& options) {
  emfield::MeasuredOptions measured;
  measured.group_deg = options.group_deg;
  for (const std::string& pair : options.columns) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == pair.size())
      throw Error(ErrorCode::usage, fmt::format("--columns '{}' is not VALUE=COLUMN or VALUE=NUMBER, such as "
                                                "loss_db=pathloss",
                                                pair));
    measured.columns[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  for (const std::string& condition : options.conditions)
    measured.conditions.push_back(emfield::PathCondition::parse(condition));
  for (const propagation::ModelInfo& row : propagation::models()) {
    const bool is_named = std::count(options.models.begin(), options.models.end(), row.name) > 0;
    const bool is_quick = row.radial == nullptr;
    if (options.models.empty() ? is_quick : is_named) measured.models.push_back(row.model);
  }
  return measured;
}

int checkPaths(const CheckOptions& options, const GlobalOptions& global) {
  const emfield::MeasuredOptions measured = measuredOptions(options);
  std::shared_ptr<const scenario::Scenario> scenario = std::make_shared<scenario::Scenario>();
  scenario::Emitter emitter;
  if (!options.scenario.empty()) {
    scenario = scenario::loadScenario(options.scenario, options.edits, scenario::ReadFor::chosen_times);
    if (!options.emitter.empty()) {
      emitter = scenario->emitters[static_cast<std::size_t>(
          scenario::namedIndex(scenario->emitters, options.emitter, "--emitter", "emitter", scenario->file))];
    } else if (!scenario->emitters.empty()) {
      emitter = scenario->emitters.front();
    }
  }
  report::MeasuredReport report;
  report.file = options.data;
  report.scenario = options.scenario;
  report.clutter = emfield::clutterText(*scenario, emitter);
  report.check = emfield::checkMeasuredPaths(options.data, *scenario, emitter, measured);
  if (global.json) {
    printJson(report::toJson(report));
  } else {
    printResult(report::measuredText(report));
  }
  return 0;
}

int check(const CheckOptions& options, const GlobalOptions& global) {
  const bool exists = inputExists(options.data);
  const bool is_folder = exists && std::filesystem::is_directory(options.data);
  if (is_folder && options.isForPaths())
    throw Error(ErrorCode::usage, "options of measured paths are given, but '" + options.data +
                                      "' is a folder; a table of measured paths is a file");
  return is_folder || !exists ? checkFigures(options.data, global) : checkPaths(options, global);
}

}  // namespace

void addCheck(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "check", "Compare the propagation models with reference figures, or with measured paths");
  command->fallthrough();
  command->footer(R"(
A folder: runs every known dataset of the folder and shows its largest difference from the reference and the tolerance. Datasets
without a model, absent and unknown datasets are listed and skipped.
A table (text with commas): one measured path per row; prints the mean, standard deviation and rms of computed minus measured loss
by model, for all paths and by terrain. See docs/measurements.md.

Examples:
  emscape check reference
  emscape check reference/pe         one family only
  emscape check reference --json     {"datasets": [{"name", "cases", "max_abs_error", "tolerance", "unit", "pass"}], "pass"}
  emscape check losses.csv --scenario site.yaml --columns loss_db=pathloss,transmitter_height_agl_m=12 --where distance_m>=1000

Exit status: 0 if every dataset that was run is within its tolerance, 5 if one is not or none of the datasets has a model, 3 for
a folder without known datasets and if a dataset cannot be read; the others are run. For a table 0, and 3 if it cannot be read.)");
  auto options = std::make_shared<CheckOptions>();
  std::vector<std::string> models;
  for (const propagation::ModelInfo& row : propagation::models()) models.push_back(row.name);
  std::vector<std::string> values;
  for (const emfield::MeasuredRole& role : emfield::measuredRoles()) values.emplace_back(role.name);
  command
      ->add_option("DATA", options->data,
                   "Folder of datasets, one per folder, or of one family; or a table of measured paths")
      ->required();
  command->add_option("--scenario", options->scenario,
                      "Measured paths: terrain, ground, atmosphere and model settings");
  addSetOption(*command, options->edits);
  command->add_option("--emitter", options->emitter,
                      "Its model settings and polarisation; default: the scenario's first");
  addListOption(
      *command, "--columns", options->columns,
      fmt::format("Columns of the table: VALUE=COLUMN, or VALUE=NUMBER for all rows; VALUE: {}; default: the "
                  "column of that name",
                  fmt::join(values, ", ")));
  command
      ->add_option("--where", options->conditions,
                   "Only rows with NAME=VALUE, NAME<NUMBER, <=, >, >=; NAME: a column, distance_m, "
                   "elevation_deg; may be given several times")
      ->allow_extra_args(false);
  command
      ->add_option("--group-deg", options->group_deg,
                   "Rows whose ends agree to this many degrees are one path with their mean loss")
      ->check(CLI::Range(0.0, 1.0));
  addListOption(*command, "--model", options->models, "Models; default: all but parabolic_equation")
      ->check(CLI::IsMember(models));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return check(*options, global); }; });
}

}  // namespace emscape::app
