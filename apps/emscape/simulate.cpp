/// emscape simulate: a scenario's field over time, written as volumes.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "apps/emscape/subcommands.h"
#include "base/files/folder.h"
#include "base/stopwatch.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/series/series_writer.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/quantities.h"
#include "playback/view/view_settings.h"
#include "report/runs/no_value.h"
#include "report/runs/series_report.h"
#include "report/warnings.h"

namespace emscape::app {
namespace {

struct SimulateOptions {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string compare;
  std::string folder;
  std::string mesh;
  std::vector<std::string> formats;  ///< empty: vdb, with a mesh vtu
  std::vector<std::string> quantities;
  std::string times;
  std::string range;
  std::string look;
  bool resume = false;
  bool force = false;
  bool allow_missing_terrain = false;
  double cache_mib = 0;
};

/// @throws Error (usage) for .vtu without a mesh, and for a mesh in another format
std::vector<std::string> formatsOf(const SimulateOptions& options) {
  const std::string for_mesh = playback::kMeshFormat;
  if (options.formats.empty()) return {options.mesh.empty() ? "vdb" : for_mesh};
  for (const std::string& format : options.formats) {
    if ((format == for_mesh) == options.mesh.empty()) {
      throw Error(ErrorCode::usage,
                  fmt::format("--format {}: {}", format,
                              options.mesh.empty() ? "needs --mesh" : "with --mesh the format is vtu"));
    }
  }
  return options.formats;
}

playback::SeriesOptions seriesOptionsOf(const SimulateOptions& options) {
  using Existing = playback::SeriesOptions::Existing;
  playback::SeriesOptions series;
  series.folder = options.folder;
  series.formats = formatsOf(options);
  if (!options.range.empty()) series.range = playback::parseRange(options.range);
  series.with_fog = !options.look.empty();
  const auto holds_fog = [](const std::string& format) { return format == "vdb" || format == "nvdb"; };
  if (series.with_fog && std::none_of(series.formats.begin(), series.formats.end(), holds_fog))
    throw Error(ErrorCode::usage, "--look fog adds a grid to .vdb and .nvdb files: use --format vdb");
  series.existing = options.resume ? Existing::resume : options.force ? Existing::replace : Existing::refuse;
  return series;
}

/// @throws Error (usage) for a quantity that is given twice
void checkQuantities(const SimulateOptions& options) {
  std::set<std::string> given;
  for (const std::string& quantity : options.quantities) {
    if (!given.insert(quantity).second)
      throw Error(ErrorCode::usage, fmt::format("--quantity: '{}' is given twice", quantity));
  }
}

/// @throws Error (usage) if the folder contains a series and neither --resume nor --overwrite is given
void checkFolderIsFree(const SimulateOptions& options) {
  requireNoFileIn(options.folder);
  if (options.resume || options.force) return;
  if (const std::optional<playback::SeriesStatus> found = playback::findSeries(options.folder)) {
    throw Error(ErrorCode::usage,
                fmt::format("{} holds a series ({} of {} steps); --resume continues it, --force replaces it",
                            options.folder, found->finished_steps, found->steps));
  }
}

/// Changes the series to differences from the comparison.
void compare(playback::FieldSeries& series, const SimulateOptions& options) {
  const bool with_original = options.compare == playback::kOriginal;
  const std::string& file = with_original ? options.scenario : options.compare;
  series.compareWith(playback::loadScenarioWithTerrain(file), with_original ? "the original scenario" : file);
}

int simulate(const SimulateOptions& options, const GlobalOptions& global) {
  Stopwatch watch;
  playback::SeriesOptions series_options = seriesOptionsOf(options);
  std::optional<emfield::TerrainMeshSpec> mesh;
  if (!options.mesh.empty()) mesh = emfield::parseTerrainMesh(options.mesh);
  checkQuantities(options);
  checkFolderIsFree(options);
  const playback::LoadedScenario input = playback::loadScenarioWithTerrain(options.scenario, options.edits);
  const std::vector<double> times_s = options.times.empty()
                                          ? scenario::timesOf(input.scenario->clock)
                                          : scenario::parseTimes(options.times, input.scenario->clock);
  if (mesh) {
    const WorkPart part("mesh over the terrain", 0, 0);
    series_options.mesh = std::make_shared<emfield::TerrainMesh>(*input.scenario, input.terrain.get(), *mesh);
    series_options.mesh_text = options.mesh;
  }
  std::string device;
  bool is_announced = false;
  const auto series = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    device = target.device();
    emfield::FieldOptions field_options = target.fieldOptions();
    field_options.quantities = options.quantities;
    field_options.allow_missing_terrain = options.allow_missing_terrain;
    field_options.cache_bytes = static_cast<std::size_t>(options.cache_mib * (1 << 20));
    if (series_options.mesh) field_options.surface = series_options.mesh->surface();
    if (!options.compare.empty()) field_options.move_tolerance_m = 0;
    auto opened = std::make_unique<playback::FieldSeries>(input, times_s, field_options, &stopFlag());
    if (!options.compare.empty()) compare(*opened, options);
    if (!std::exchange(is_announced, true)) {
      logInfo(fmt::format("computing {} step{} of {} into {}", opened->count(),
                          opened->count() == 1 ? "" : "s", input.scenario->name, options.folder));
    }
    opened->rehearse();
    return opened;
  });
  const playback::SeriesResult result = playback::writeSeries(*series, series_options, progressSink(global));
  std::vector<std::string> warnings = series->warnings();
  report::logWarnings(warnings);
  for (std::size_t c = 0; c < result.channels.size() && options.range.empty() && options.compare.empty();
       ++c) {
    const playback::ValueRange& range = result.ranges[c];
    // Floors of probabilities and counts are 0, of indices -1.
    const bool is_floor =
        range.max <= static_cast<float>(input.scenario->output.floor) || range.max == 0 || range.max == -1;
    if (range.empty() || (range.min == range.max && is_floor))
      logWarning(warnings.emplace_back(report::noValueWarning(result.channels[c], *input.scenario, times_s)));
  }

  const double seconds = watch.lap_ms() / 1000;
  if (global.json) {
    warnings.insert(warnings.begin(), warningsOf(*input.scenario).begin(), warningsOf(*input.scenario).end());
    printJson(report::seriesJson(device, options.folder, result, report::joinedWarnings(warnings), seconds));
  } else {
    logInfo(fmt::format("{} step{} of {} in {}, {:.1f} s", result.steps, result.steps == 1 ? "" : "s",
                        fmt::join(result.channels, ", "), options.folder, seconds));
  }
  return 0;
}

}  // namespace

void addSimulate(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("simulate", "Compute a scenario's field over time and write it as volumes");
  command->fallthrough();
  command->footer(R"(
Every volume has the value range of the whole series. Each step is computed once; until the end, files have the range so far. The
folder also contains series.json, the description of the series, and series.steps, the finished steps.

Examples:
  emscape simulate scenarios/jacksboro.yaml -o out
  emscape simulate scenarios/jacksboro.yaml -o out --format vdb,vti --quantity power_density_dbwm2,snr_db --times 0:60:1
  emscape simulate scenarios/jacksboro.yaml -o out --mesh terrain:32,4 --times 60
  emscape simulate scenarios/jacksboro.yaml -o out --set emitters.jammer.power_w=500 --compare original
  emscape simulate scenarios/jacksboro.yaml -o out --look fog --times 40       a grid 'density' for Blender
  emscape simulate scenarios/jacksboro.yaml -o out --resume        after an interruption)");
  auto options = std::make_shared<SimulateOptions>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  addCompareOption(*command, options->compare, "Write");
  command->add_option("-o,--output", options->folder, "Folder of the series; created if necessary")
      ->required();
  std::vector<std::string> names = playback::writableFormats();
  names.emplace_back(playback::kMeshFormat);
  addListOption(*command, "--format", options->formats,
                "File formats, with commas between them: vdb, nvdb, vti, raw; default: vdb. With --mesh: vtu")
      ->check(CLI::IsMember(names));
  command->add_option(
      "--mesh", options->mesh,
      "terrain:LAYERS[,FIRST_M[,RATIO]]: the field on tetrahedra that follow the ground, above "
      "the region's columns; the lowest layer is FIRST_M thick (default 5), each further one "
      "RATIO times the one below (default: so that they reach the region's top)");
  addListOption(
      *command, "--quantity", options->quantities,
      "Quantities, with commas between them (" + scenario::quantityNames() + "); default: the scenario's");
  command->add_option("--times", options->times,
                      "BEGIN:END:STEP, BEGIN:END or T, in seconds or UTC; default: the scenario's clock");
  command->add_option("--range", options->range,
                      "MIN:MAX of the series if it is known: files state it from the beginning");
  command
      ->add_option(
          "--look", options->look,
          "fog: files of the formats vdb and nvdb have a grid 'density' (0..1) too: the opacity of the "
          "first quantity as pictures have it by default, over --range or the range of the first step; "
          "programs such as Blender draw it without settings")
      ->check(CLI::IsMember({"fog"}));
  command->add_flag("--resume", options->resume, "Continue the series of the folder");
  command->add_flag("--force", options->force, "Replace the series in the folder")->excludes("--resume");
  command->add_flag("--allow-missing-terrain", options->allow_missing_terrain,
                    "Compute although elevation data is missing; voxels over holes are masked");
  command
      ->add_option("--cache-mib", options->cache_mib, "Limit of the per-emitter caches in MiB; 0: no limit")
      ->check(CLI::Range(0.0, 1e6));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return simulate(*options, global); }; });
}

}  // namespace emscape::app
