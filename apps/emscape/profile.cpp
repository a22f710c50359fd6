/// emscape profile: explains the coverage at a point.
#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/geodesy/position_text.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/registry/model_info.h"
#include "render/annotate/plot.h"
#include "report/maps/output_files.h"
#include "report/paths/profile_report.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

struct ProfileOptions {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string emitter;
  std::string to;
  std::string time = "0";
  bool above_ground = false;
  std::vector<std::string> models;
  std::string plot;
  std::string size = "1400x800";
};

/// @throws Error (usage) unless the text is a position with a height
scenario::SitePosition parsePoint(const std::string& text, bool above_ground) {
  constexpr double kMaxHeight_m = 100000;
  std::optional<ParsedPosition> read;
  try {
    read = parsePosition(text);
  } catch (const Error&) {
  }
  if (!read || !read->height_m || std::abs(*read->height_m) > kMaxHeight_m) {
    throw Error(
        ErrorCode::usage,
        fmt::format("--to '{}' is not LAT,LON,HEIGHT: latitude -90..90 deg, longitude -180..180 deg, height "
                    "-100000..100000 m, such as 36.30,-84.25,1500 or 36°18'N 84°15'W,1500 or "
                    "16S GF 46937 20733,1500",
                    text));
  }
  scenario::SitePosition point;
  point.latitude_deg = read->latitude_deg;
  point.longitude_deg = read->longitude_deg;
  (above_ground ? point.height_agl_m : point.height_msl_m) = *read->height_m;
  return point;
}

report::ProfileReport makeReport(const ProfileOptions& options) {
  report::ProfileRequest request;
  request.to = parsePoint(options.to, options.above_ground);
  for (const std::string& name : options.models)
    request.models.push_back(propagation::modelNamed(name)->model);
  const auto scenario =
      scenario::loadScenario(options.scenario, options.edits, scenario::ReadFor::chosen_times);
  request.time_s = scenario::parseTime(options.time, scenario->clock);
  request.emitter =
      scenario::namedIndex(scenario->emitters, options.emitter, "--emitter", "emitter", scenario->file);
  report::checkOutputs({{"--plot", options.plot}}, {}, {scenario});
  report::ProfileReport report = report::profileReport(options.scenario, *scenario, request);
  if (!options.plot.empty()) {
    report::plotPath(report, render::parseImageSize(options.size), options.plot);
    logInfo("wrote " + options.plot);
  }
  return report;
}

int profile(const ProfileOptions& options, const GlobalOptions& global) {
  const report::ProfileReport report = makeReport(options);
  if (global.json) {
    printJson(report::toJson(report));
  } else {
    printResult(report::profileText(report));
  }
  return 0;
}

}  // namespace

void addProfile(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "profile", "Explain the coverage at a point: the path from an emitter, term by term");
  command->fallthrough();
  command->footer(R"(
Prints the geometry of the path, the obstacles, every term of the budget from the transmitter's power to the power density at the
point, and a sentence with the dominant cause. HEIGHT is in metres above mean sea level (EGM96), with --agl above the ground.

Examples:
  emscape profile scenarios/jacksboro.yaml --emitter "search radar" --to 36.35,-84.25,900 --plot path.png
  emscape profile scenarios/jacksboro.yaml --emitter jammer --time 80 --to 36.249,-84.147,10 --agl --model diffraction,free_space
  emscape profile scenarios/jacksboro.yaml --emitter "search radar" --to 36.35,-84.25,900 --json

Exit status: 0, whether there is coverage or not; 2 for an invalid emitter or point; 3 for a point below the ground
or a path over missing terrain.)");
  auto options = std::make_shared<ProfileOptions>();
  std::vector<std::string> names;
  for (const propagation::ModelInfo& row : propagation::models()) names.push_back(row.name);
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--emitter", options->emitter, "Name of the emitter; required");
  command
      ->add_option("--to", options->to,
                   "The point: LAT,LON,HEIGHT (deg, deg, m); also degrees with minutes and seconds, or MGRS")
      ->required();
  command->add_option("--time", options->time,
                      "Seconds since the scenario's epoch, or UTC: 2026-06-01T06:00:00Z");
  command->add_flag("--agl", options->above_ground, "HEIGHT is above the ground");
  addListOption(*command, "--model", options->models, "Models to compare with the emitter's model")
      ->check(CLI::IsMember(names));
  command
      ->add_option(
          "--plot", options->plot,
          "Draw the path into a file, .png or .svg; with parabolic_equation the loss over range and height")
      ->check([](const std::string& file) {
        return render::isPlotFile(file) ? "" : "'" + file + "': plots are written as .png or .svg";
      });
  command->add_option("--size", options->size, "Size of the plot in pixels, WxH");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return profile(*options, global); }; });
}

}  // namespace emscape::app
