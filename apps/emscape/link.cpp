/// emscape link: signals of emitters at receivers, and detection of targets by radars, over time.
#include <fmt/core.h>

#include <memory>

#include "apps/common/console.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/registry/model_info.h"
#include "render/annotate/plot.h"
#include "report/maps/output_files.h"
#include "report/paths/link_plot.h"
#include "report/paths/link_report.h"
#include "report/warnings.h"

namespace emscape::app {
namespace {

struct LinkCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  report::LinkSelection selection{"--", "", {}, {}, {}, ""};
  std::string csv;
  std::string plot;
  std::string size = "1400x800";
};

int link(const LinkCommand& command, const GlobalOptions& global) {
  report::NamedLinks links{command.scenario, scenario::loadScenario(command.scenario, command.edits), {}};
  const scenario::Scenario& scenario = *links.scenario;
  report::checkOutputs({{"--csv", command.csv}, {"--plot", command.plot}}, {}, {links.scenario});
  report::requireFolders({command.csv, command.plot});
  const emfield::LinkOptions options = report::linkOptions(scenario, command.selection);
  links.report = report::computeLinks(links.scenario, options, stoppingProgress(global));
  report::logWarnings(links.report.warnings, {links.scenario});
  if (!command.csv.empty()) {
    report::writeCsv(links, command.csv);
    logInfo("wrote " + command.csv);
  }
  if (!command.plot.empty()) {
    report::plotLinks(links, render::parseImageSize(command.size), command.plot);
    logInfo("wrote " + command.plot);
  }
  if (global.json) {
    printJson(report::toJson(links));
  } else {
    printResult(report::linksText(links));
  }
  return 0;
}

}  // namespace

void addLink(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "link", "Links over time: what receivers receive from emitters, and which targets radars detect");
  command->fallthrough();
  command->footer(R"(
For every pair of an emitter and a receiver on a platform: received power, the sum of all others in the band, noise, the
ratio of signal to noise and interference (SINR), J/S, whether it is received, and what blocks the path. For every pair of a radar and a
target: SNR, J/S and the probability of detection of one look, with the beam on the target, and of all looks so far.
The tables show about twenty times of each pair; --csv and --json contain all.

Examples:
  emscape link scenarios/links.yaml
  emscape link scenarios/links.yaml --emitter "search radar" --receiver "warning receiver" --times 0:60:5
  emscape link scenarios/links.yaml --csv links.csv --plot links.png
  emscape link scenarios/links.yaml --target drone --set targets.drone.rcs_m2=1 --json

Exit status: 0, whether there is reception or not; 2 for a name that the scenario does not have; 3 for a path over missing
terrain and a scenario without receivers and targets.)");
  auto options = std::make_shared<LinkCommand>();
  std::vector<std::string> names;
  for (const propagation::ModelInfo& row : propagation::models()) names.push_back(row.name);
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--times", options->selection.times,
                      "BEGIN:END:STEP, BEGIN:END or T, in seconds or UTC; default: the scenario's clock");
  addNamesOption(*command, "--emitter", options->selection.emitters,
                 "Emitters, with commas between them, or the option again; default: all");
  addNamesOption(*command, "--receiver", options->selection.receivers,
                 "Receivers; default: all, unless --target is given");
  addNamesOption(*command, "--target", options->selection.targets,
                 "Targets; default: all, unless --receiver is given");
  command->add_option("--model", options->selection.model, "Propagation model in place of the emitters' own")
      ->check(CLI::IsMember(names));
  command->add_option("--csv", options->csv, "Write all rows into a CSV file");
  command->add_option("--plot", options->plot, "Draw SINR and probabilities over time into a .png or .svg")
      ->check([](const std::string& file) {
        return render::isPlotFile(file) ? "" : "'" + file + "': plots are written as .png or .svg";
      });
  command->add_option("--size", options->size, "Size of the plot in pixels, WxH");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return link(*options, global); }; });
}

}  // namespace emscape::app
