/// emscape exposure: exposure of a platform to the field along its track.
#include "emscape/study/exposure/exposure.h"

#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "apps/common/console.h"
#include "apps/common/target.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/files/json_writing.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/file/scenario_file.h"
#include "report/maps/exposure_report.h"
#include "report/maps/output_files.h"
#include "report/warnings.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

struct ExposureCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string platform;
  std::string quantity = "detection_probability";
  double threshold = NAN;
  std::string times;
  std::string look = "target";
  std::string target;
  std::vector<std::string> outputs;
  std::string size = "1400x800";
};

study::ExposureRequest requestOf(const ExposureCommand& command, const scenario::Scenario& scenario) {
  study::ExposureRequest request;
  request.platform =
      scenario::namedIndex(scenario.platforms, command.platform, "--platform", "platform", scenario.file);
  request.quantity = scenario::quantityFromName(command.quantity);
  request.threshold = study::thresholdOf(command.threshold, request.quantity, "--threshold");
  request.times_s = command.times.empty() ? scenario::timesOf(scenario.clock)
                                          : scenario::parseTimes(command.times, scenario.clock);
  if (command.look == "scan") request.look = scenario::RadarAim::scan;
  if (command.target.empty()) {
    request.target = study::targetOn(scenario, request.platform);
  } else if (command.target != "none") {
    request.target =
        scenario::namedIndex(scenario.targets, command.target, "--rcs-target", "target", scenario.file);
  }
  return request;
}

int exposure(const ExposureCommand& command, const GlobalOptions& global) {
  const render::ImageSize size = render::parseImageSize(command.size);
  const auto scenario =
      scenario::loadScenario(command.scenario, command.edits, scenario::ReadFor::chosen_times);
  report::checkOutputs(report::outputsOf("--output", command.outputs), {}, {scenario});
  report::requireFolders(command.outputs);
  const study::ExposureRequest request = requestOf(command, *scenario);
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const study::Exposure result = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    return study::computeExposure(scenario, terrain, request, target.fieldOptions(),
                                  stoppingProgress(global));
  });
  report::logWarnings(result.warnings, {scenario});
  writeStudyOutputs(command.outputs,
                    {[&](const std::string& file) { study::plotExposure(result, size, file); },
                     [&](const std::string& file) { report::writeExposureCsv(result, file); },
                     [&] { return dumpJson(report::exposureJson(result), 2); }});
  if (global.json) {
    printJson(report::exposureJson(result));
  } else {
    printResult(report::exposureText(result));
  }
  return 0;
}

}  // namespace

void addExposure(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "exposure", "A platform on its track through the field: by time and emitter, first detection, gaps");
  command->fallthrough();
  command->footer(R"(
The value of each emitter by itself and of all together at the platform's position, as `emscape profile` gives it there
(parabolic_equation: the mean over cells between marched azimuths, which differs over terrain). The platform's own emitters are
left out; its jammers jam the radars. Radars look at the platform wherever their scan points (--look target: the probability of
one look), and the probability of detection in any look so far counts a look per scan. With --look scan the beam is where it is
at each time. Radars see the target that the platform carries, by aspect; without one, or with --rcs-target none, the cross
section that each radar assumes.

Examples:
  emscape exposure scenarios/jacksboro.yaml --platform helicopter -o exposure.png
  emscape exposure scenarios/links.yaml --platform drone --times 0:60:0.5 -o drone.png -o drone.csv
  emscape exposure scenarios/links.yaml --platform helicopter --quantity power_density_dbwm2 --threshold -70 -o power.svg
  emscape exposure scenarios/jacksboro.yaml --platform helicopter --look scan --times 0:120:0.1 -o scan.json

Exit status: 0, whether the threshold is reached or not; 2 for names that the scenario does not have.)");
  auto options = std::make_shared<ExposureCommand>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--platform", options->platform, "Name of the platform; required");
  addStudyOutputs(*command, options->outputs);
  command->add_option("--quantity", options->quantity,
                      "A quantity of the field; see docs/scenario-format.md");
  addThresholdOption(*command, options->threshold);
  command->add_option("--times", options->times,
                      "BEGIN:END:STEP, BEGIN:END or T, in seconds or UTC; default: the scenario's clock");
  command
      ->add_option("--look", options->look,
                   "Where radars look: target (at the platform) or scan (where their scan points)")
      ->check(CLI::IsMember({"target", "scan"}));
  command->add_option("--rcs-target", options->target,
                      "Target of the scenario that radars see, or none; default: that of the platform");
  command->add_option("--size", options->size, "Size of pictures in pixels, WxH");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return exposure(*options, global); }; });
}

}  // namespace emscape::app
