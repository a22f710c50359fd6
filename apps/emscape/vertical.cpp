/// emscape vertical: a quantity of an emitter over range and height.
#include "emscape/study/vertical/vertical.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/files/folder.h"
#include "base/files/json_writing.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/file/scenario_file.h"
#include "render/annotate/plot.h"
#include "report/maps/areps_files.h"
#include "report/maps/areps_table.h"
#include "report/maps/output_files.h"
#include "report/maps/vertical_report.h"
#include "report/warnings.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

struct VerticalCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string emitter;
  std::vector<double> azimuths_deg;
  std::vector<std::string> outputs;
  std::string axis = "msl";
  bool blake = false;
  double range_m = NAN, max_height_m = NAN;
  std::string quantity;
  double threshold = NAN;
  std::string time = "0";
  std::vector<int> grid{600, 300};
  bool has_grid = false;  ///< the grid was given
  std::string size;
  std::string areps;    ///< folder; empty: no such files
  std::string compare;  ///< a file of AREPS; empty: none
};

/// A file of AREPS is one azimuth.
void checkBearing(const report::ArepsTable& table, const VerticalCommand& command) {
  constexpr double kSame_deg = 0.05;
  if (command.azimuths_deg.size() != 1) {
    throw Error(ErrorCode::usage,
                fmt::format("--compare {}: the file has one azimuth; give one --azimuth", command.compare));
  }
  if (std::abs(std::remainder(table.bearing_deg - command.azimuths_deg.front(), 360)) > kSame_deg) {
    logWarning(fmt::format("{}: its bearing angle is {:g} deg, --azimuth {:g}", command.compare,
                           table.bearing_deg, command.azimuths_deg.front()));
  }
}

/// @param other  whose points are taken unless the command says others
study::VerticalRequest requestOf(const VerticalCommand& command, const scenario::Scenario& scenario,
                                 const std::optional<report::ArepsTable>& other) {
  study::VerticalRequest request;
  request.emitter =
      scenario::namedIndex(scenario.emitters, command.emitter, "--emitter", "emitter", scenario.file);
  if (!command.quantity.empty()) request.quantity = scenario::quantityFromName(command.quantity);
  request.threshold = command.threshold;
  for (const double azimuth_deg : command.azimuths_deg)
    request.azimuths_deg.push_back(azimuth_deg + 0.0);  // no -0
  request.time_s = scenario::parseTime(command.time, scenario.clock);
  request.smooth_earth = command.blake;
  request.ranges = command.grid.front();
  request.heights = command.grid.back();
  if (command.axis == "agl") request.axis = emfield::HeightReference::ground;
  request.range_m = command.range_m;
  request.max_height_m = command.max_height_m;
  if (other) {
    if (std::isnan(request.range_m)) request.range_m = other->max_range_m;
    if (std::isnan(request.max_height_m)) request.max_height_m = other->max_height_m;
    if (!command.has_grid) {
      request.ranges = std::max(other->ranges, 2);
      request.heights = other->heights;
    }
  }
  return study::withDefaults(request, scenario, !command.quantity.empty(), "--threshold");
}

/// Files of AREPS have the azimuth in their names.
void checkAzimuths(const std::vector<double>& azimuths_deg) {
  constexpr double kSame_deg = 1e-3;
  for (std::size_t n = 0; n < azimuths_deg.size(); ++n) {
    for (std::size_t other = 0; other < n; ++other) {
      if (std::abs(std::remainder(azimuths_deg[n] - azimuths_deg[other], 360)) < kSame_deg) {
        throw Error(ErrorCode::usage,
                    fmt::format("--azimuth: {:g} and {:g} are one direction; give each once",
                                azimuths_deg[other], azimuths_deg[n]));
      }
    }
  }
}

int vertical(const VerticalCommand& command, const GlobalOptions& global) {
  checkAzimuths(command.azimuths_deg);
  if (command.outputs.empty() && command.areps.empty() && command.compare.empty())
    throw Error(ErrorCode::usage, "-o FILE, --areps FOLDER or --compare FILE is required");
  const bool has_areps = !command.areps.empty() || !command.compare.empty();
  if (has_areps && command.axis != "msl") {
    throw Error(ErrorCode::usage,
                "--areps and --compare have heights above mean sea level; leave out --height-axis agl");
  }
  const std::optional<report::ArepsTable> other =
      command.compare.empty() ? std::nullopt : std::optional(report::readAreps(command.compare));
  if (other) checkBearing(*other, command);
  const render::ImageSize size = command.size.empty() ? study::verticalPlotSize(command.azimuths_deg.size())
                                                      : render::parseImageSize(command.size);
  if (std::any_of(command.outputs.begin(), command.outputs.end(), render::isPlotFile))
    study::checkVerticalPlot(size, command.azimuths_deg.size());
  const auto scenario =
      scenario::loadScenario(command.scenario, command.edits, scenario::ReadFor::chosen_times);
  std::vector<report::NamedFile> outputs = report::outputsOf("--output", command.outputs);
  for (const double azimuth_deg : command.azimuths_deg) {
    if (!command.areps.empty())
      outputs.push_back({"--areps", report::arepsFile(command.areps, command.emitter, azimuth_deg)});
  }
  report::checkOutputs(outputs, {}, {scenario});
  report::requireFolders(command.outputs);
  const study::VerticalRequest request = requestOf(command, *scenario, other);
  const scenario::TerrainPtr terrain = study::loadVerticalTerrain(*scenario, request);
  stopIfInterrupted();
  const auto compute = [&](const study::VerticalRequest& wanted) {
    return openOnTarget(global, "float", [&](const ComputeTarget& target) {
      return study::computeVertical(scenario, terrain, wanted, target.fieldOptions());
    });
  };
  const study::VerticalDiagram diagram = compute(request);
  report::logWarnings(diagram.warnings, {scenario});
  std::optional<study::VerticalDiagram> losses;
  if (has_areps) {
    study::VerticalRequest strength = request;
    strength.quantity = report::arepsQuantity(scenario->emitters[static_cast<std::size_t>(request.emitter)]);
    losses = compute(strength);
  }
  stopIfInterrupted();
  std::optional<FolderForFiles> areps;
  if (!command.areps.empty()) areps.emplace(command.areps);  // before anything is written
  writeStudyOutputs(command.outputs,
                    {[&](const std::string& file) { study::plotVertical(diagram, size, file); },
                     [&](const std::string& file) { report::writeVerticalCsv(diagram, file); },
                     [&] { return dumpJson(report::verticalJson(diagram, true)); }});
  if (areps) {
    for (const std::string& file : report::writeAreps(*losses, *scenario, command.areps))
      logInfo("wrote " + file);
  }
  std::optional<report::ArepsComparison> comparison;
  if (other) comparison = report::compareAreps(*losses, *scenario, *other);
  if (global.json) {
    report::Json json = report::verticalJson(diagram, false);
    if (comparison) json["comparison"] = report::arepsComparisonJson(*comparison, command.compare);
    printJson(json);
  } else {
    printResult(report::verticalText(diagram) +
                (comparison ? report::arepsComparisonText(*comparison, command.compare) : ""));
  }
  return 0;
}

}  // namespace

void addVertical(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "vertical", "Vertical coverage of an emitter: a quantity over range and height at given azimuths");
  command->fallthrough();
  command->footer(R"(
Each value is that of `emscape profile` at its point, with the terrain below and the jammers that are active (by
parabolic_equation the mean over a cell, over mountains within some dB of it). Radars look at the target (radar_look: target). The line is where the threshold is reached. With --blake a smooth earth replaces the
terrain, at the height of the ground below the emitter: a range-height-angle chart, over the slant range, with rays of constant
elevation and the line that free space would have.

Examples:
  emscape vertical scenarios/jacksboro.yaml --emitter "search radar" --azimuth 30,120 -o vertical.png
  emscape vertical scenarios/jacksboro.yaml --emitter "search radar" --azimuth 30 --height-axis agl --max-height 1000 -o low.svg
  emscape vertical scenarios/jacksboro.yaml --emitter jammer --time 80 --azimuth 200 --threshold -50 -o jammer.png -o jammer.csv
  emscape vertical scenarios/jacksboro.yaml --emitter "search radar" --azimuth 0 --blake --range 100000 --max-height 10000 -o blake.png
  emscape vertical scenarios/jacksboro.yaml --emitter "search radar" --azimuth 0,10,20,30 --grid 200,100 --areps areps
  emscape vertical scenarios/jacksboro.yaml --emitter "search radar" --azimuth 30 --compare areps/search_radar_APM_30.txt

Exit status: 0, whether the threshold is reached or not; 2 for an unknown emitter, one that is off, or a quantity that it does
not have by itself.)");
  auto options = std::make_shared<VerticalCommand>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--emitter", options->emitter, "Name of the emitter; required");
  command
      ->add_option("--azimuth", options->azimuths_deg,
                   "Degrees clockwise from true north, with commas between them: one panel each")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(-360.0, 360.0))
      ->required();
  addStudyOutputs(*command, options->outputs);
  command->get_option("--output")->required(false);  // --areps may stand alone
  command->add_option("--height-axis", options->axis, "Heights above mean sea level (msl) or ground (agl)")
      ->check(CLI::IsMember({"msl", "agl"}));
  command->add_flag("--blake", options->blake, "Chart over a smooth earth, with elevation angles");
  command
      ->add_option("--range", options->range_m,
                   "Distance of the diagram's right edge from the emitter (m); default: the instrumented "
                   "range, else the "
                   "region's edge")
      ->check(CLI::Range(study::VerticalRequest::kMinRange_m, study::VerticalRequest::kMaxRange_m))
      ->default_str("");
  command
      ->add_option("--max-height", options->max_height_m,
                   "Height of the upper edge (m, on the height axis); default: that of the region")
      ->default_str("");
  command->add_option(
      "--quantity", options->quantity,
      "A quantity of one emitter; default: detection_probability of radars, power_density_dbwm2 of others");
  addThresholdOption(*command, options->threshold);
  command->add_option(
      "--areps", options->areps,
      "Folder for a text file of AREPS for each azimuth, with loss, propagation factor and, of radars, "
      "the losses for probabilities of detection; SIMDIS draws them");
  command->add_option(
      "--compare", options->compare,
      "Text file of AREPS: the differences of its losses to ours are printed; by default at its "
      "points");
  command->add_option("--time", options->time,
                      "Seconds since the scenario's epoch, or UTC: 2026-06-01T06:00:00Z");
  CLI::Option* const grid =
      command->add_option("--grid", options->grid, "Number of points of the grid: RANGES,HEIGHTS")
          ->delimiter(',')
          ->expected(2);
  command
      ->add_option("--size", options->size,
                   "Size of pictures in pixels, WxH; default: 1400x800, higher for more than four azimuths")
      ->default_str("");
  command->callback([options, grid, &global, &action] {
    options->has_grid = grid->count() > 0;
    action = [options, &global] { return vertical(*options, global); };
  });
}

}  // namespace emscape::app
