/// emscape blockage: the part of a radar's beam that terrain cuts.
#include "study/blockage/blockage.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/emscape/subcommands.h"
#include "base/files/own_file.h"
#include "base/files/whole_file.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "report/json.h"
#include "report/maps/output_files.h"
#include "report/warnings.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

using study::Blockage;
using study::BlockageRequest;

struct BlockageCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string emitter, time = "0";
  double elevation_deg = NAN, beamwidth_deg = NAN;
  BlockageRequest request;
  std::vector<std::string> outputs;
  int width = 1200;
  bool force = false;
};

/// Areas (m2) up to the last gate, of the parts that the answers have.
struct BlockageAreas {
  double half_cut_m2 = 0, cut_m2 = 0, known_m2 = 0, unknown_m2 = 0;

  explicit BlockageAreas(const Blockage& blockage) {
    const double step_m = blockage.request.step_m;
    for (int azimuth = 0; azimuth < blockage.request.azimuths; ++azimuth) {
      for (int n = 0; n < blockage.ranges; ++n) {
        const double area_m2 = 2 * kPi / blockage.request.azimuths * blockage.gate_m(n) * step_m;
        const float part = blockage.cumulative[static_cast<std::size_t>(azimuth) * blockage.ranges + n];
        (std::isnan(part) ? unknown_m2 : known_m2) += area_m2;
        if (part >= 0.1f) cut_m2 += area_m2;
        if (part >= 0.5f) half_cut_m2 += area_m2;
      }
    }
  }
};

report::Json blockageJson(const Blockage& blockage, const BlockageAreas& areas) {
  return {{"scenario", blockage.scenario},
          {"emitter", blockage.emitter},
          {"latitude_deg", blockage.position.latitude_deg},
          {"longitude_deg", blockage.position.longitude_deg},
          {"height_msl_m", blockage.station_msl_m},
          {"elevation_deg", blockage.elevation_deg},
          {"beamwidth_deg", blockage.beamwidth_deg},
          {"azimuths", blockage.request.azimuths},
          {"gates", blockage.ranges},
          {"gate_m", blockage.request.step_m},
          {"known_area_km2", areas.known_m2 / 1e6},
          {"unknown_area_km2", areas.unknown_m2 / 1e6},
          {"cut_by_a_tenth_km2", areas.cut_m2 / 1e6},
          {"cut_by_half_km2", areas.half_cut_m2 / 1e6},
          {"clutter", "none (bare ground)"},
          {"warnings", blockage.warnings}};
}

std::string blockageText(const Blockage& blockage, const BlockageAreas& areas) {
  const auto share = [&](double area_m2) {
    return fmt::format("{:.1f} of {:.1f} km2 known, {:.1f} %", area_m2 / 1e6, areas.known_m2 / 1e6,
                       areas.known_m2 > 0 ? 100 * area_m2 / areas.known_m2 : 0);
  };
  return fmt::format(
      "'{}' at {:.1f} m: beam of {:.3g} deg at {:.3g} deg elevation, to {:.4g} km\n"
      "cut by 10 % or more: {}\ncut by half or more:  {}{}\nground cover: none (bare ground)\n",
      blockage.emitter, blockage.station_msl_m, blockage.beamwidth_deg, blockage.elevation_deg,
      blockage.range_m() / 1000, share(areas.cut_m2), share(areas.half_cut_m2),
      areas.unknown_m2 > 0 ? fmt::format("; {:.1f} km2 unknown", areas.unknown_m2 / 1e6) : "");
}

int blockage(BlockageCommand command, const GlobalOptions& global) {
  std::optional<EndAtInterrupts> at_once(std::in_place);
  const auto scenario =
      scenario::loadScenario(command.scenario, command.edits, scenario::ReadFor::chosen_times);
  report::checkOutputs(report::outputsOf("--output", command.outputs), {}, {scenario}, true);
  report::requireFolders(command.outputs);
  if (!command.force) requireNew({command.outputs.begin(), command.outputs.end()});
  BlockageRequest& request = command.request;
  request.emitter =
      scenario::namedIndex(scenario->emitters, command.emitter, "--emitter", "emitter", scenario->file);
  request.time_s = scenario::parseTime(command.time, scenario->clock);
  if (!std::isnan(command.elevation_deg)) request.elevation_deg = command.elevation_deg;
  if (!std::isnan(command.beamwidth_deg)) request.beamwidth_deg = command.beamwidth_deg;
  const Blockage blockage = study::computeBlockage(scenario, request);
  report::logWarnings(blockage.warnings, {scenario});
  at_once.reset();
  const Replaces replaces = command.force ? Replaces::any : Replaces::own;
  for (const std::string& file : command.outputs) {
    const std::string ending = std::filesystem::path(file).extension();
    if (ending == ".png") {
      if (!command.force) requireOwn(file);
      render::writePng(file, study::drawBlockage(blockage, command.width));
    } else if (ending == ".csv") {
      study::writeBlockageCsv(blockage, file, replaces);
    } else if (ending == ".nc") {
      study::writeBlockageNetcdf(blockage, file, replaces);
    } else {
      const study::BlockageMap made = study::mapOf(blockage);
      study::writeGeoTiff(file, made.grid, made.map,
                          {{"SCENARIO", blockage.scenario},
                           {"EMITTER", blockage.emitter},
                           {"ELEVATION_DEG", fmt::format("{:g}", blockage.elevation_deg)},
                           {"BEAMWIDTH_DEG", fmt::format("{:g}", blockage.beamwidth_deg)}},
                          replaces);
    }
    logInfo("wrote " + file);
  }
  const BlockageAreas areas(blockage);
  if (global.json) {
    printJson(blockageJson(blockage, areas));
  } else {
    printResult(blockageText(blockage, areas));
  }
  return 0;
}

}  // namespace

void addBlockage(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("blockage", "Part of a radar's beam that terrain cuts, over azimuth and range");
  command->fallthrough();
  command->footer(R"(
The part of the beam's cross section, a circle of the width between the half-power points, that is below the highest ground of
each gate (Bech et al. 2003), and the largest part up to there. Rays are straight over the effective earth of the scenario's
k_factor; diffraction is left out. In the picture and the GeoTIFF the part up to there; both in the CSV and, with the gates' positions, in netCDF.

Examples:
  emscape blockage scenarios/jacksboro.yaml --emitter "search radar" -o blockage.png -o blockage.csv
  emscape blockage scenarios/jacksboro.yaml --emitter "search radar" --range 15000 --elevation 0.5 --beamwidth 1 -o blockage.tif --force

Exit status: 0; 2 for an unknown emitter or an antenna without a beam; 3 without terrain.)");
  auto options = std::make_shared<BlockageCommand>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--emitter", options->emitter, "Name of the emitter; required");
  command->add_option("--time", options->time, "Seconds since the scenario's epoch, or UTC");
  command
      ->add_option("--elevation", options->elevation_deg,
                   "Elevation of the beam's axis (deg); default: that of the emitter's beam at the time")
      ->default_str("")
      ->check(CLI::Range(-10.0, 89.0));
  command
      ->add_option(
          "--beamwidth", options->beamwidth_deg,
          "Width of the beam between its half-power points (deg); default: the antenna's in elevation")
      ->default_str("")
      ->check(CLI::Range(0.01, 90.0));
  command
      ->add_option("--range", options->request.range_m,
                   "Of the last gate, along the beam (m); default: up to 100 km, as far as ground is known")
      ->default_str("")
      ->check(CLI::Range(BlockageRequest::kMinRange_m, BlockageRequest::kMaxRange_m));
  command->add_option("--step", options->request.step_m, "Length of a gate (m)")
      ->check(CLI::Range(1.0, 100e3));
  command->add_option("--azimuths", options->request.azimuths, "Beams of a turn, the first to the north")
      ->check(CLI::Range(BlockageRequest::kMinAzimuths, BlockageRequest::kMaxAzimuths));
  command
      ->add_option("-o,--output", options->outputs,
                   "File to write, .png, .csv, .tif or .nc; may be given several times")
      ->allow_extra_args(false)
      ->check([](const std::string& file) {
        const std::string ending = std::filesystem::path(file).extension();
        const bool is_known = ending == ".png" || ending == ".csv" || ending == ".tif" || ending == ".nc";
        return is_known ? "" : "'" + file + "': files are written as .png, .csv, .tif or .nc";
      });
  command->add_option("--width", options->width, "Width of the picture in pixels")
      ->check(CLI::Range(400, 8000));
  command->add_flag("--force", options->force, "Replace files that exist");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return blockage(*options, global); }; });
}

}  // namespace emscape::app
