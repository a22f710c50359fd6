/// emscape simulate: a scenario's field over time, written as volumes.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "apps/emscape/background_writer.h"
#include "apps/emscape/command.h"
#include "apps/emscape/console.h"
#include "apps/emscape/field_series.h"
#include "apps/emscape/interrupt.h"
#include "apps/emscape/place.h"
#include "apps/emscape/series_files.h"
#include "apps/emscape/series_state.h"
#include "apps/emscape/version.h"
#include "base/stopwatch.h"
#include "base/whole_file.h"
#include "emscape/base/log.h"
#include "emscape/emfield/quantities.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string folder;
  std::vector<std::string> formats{"vdb"};
  std::vector<std::string> quantities;
  std::string times;
  std::string range;
  bool resume = false;
  bool force = false;
  bool allow_missing_terrain = false;
  double cache_mib = 0;
};

std::vector<std::string> namesOf(const std::vector<emfield::Channel>& channels) {
  std::vector<std::string> names;
  for (const emfield::Channel& channel : channels) names.push_back(channel.name);
  return names;
}

/// All that the values and names of the files depend on.
Json recipeOf(const SimulateOptions& options, const FieldSeries& series) {
  Json times = Json::array();
  for (int step = 0; step < series.count(); ++step) times.push_back(series.time_s(step));
  return {{"scenario", series.input().scenario->name},
          {"scenario hash", series.input().scenario->hash},
          {"version of emscape", kVersion},
          {"format", std::set<std::string>(options.formats.begin(), options.formats.end())},
          {"quantity", namesOf(series.channels())},
          {"range", options.range},
          {"allow-missing-terrain", options.allow_missing_terrain},
          {"times", times}};
}

/// The state to go on from: that of the folder, or a new one.
SeriesState beginState(const SimulateOptions& options, const FieldSeries& series) {
  SeriesState state;
  state.recipe = recipeOf(options, series);
  state.channels = namesOf(series.channels());
  if (options.force) return state;
  const std::optional<SeriesState> found = readSeriesState(options.folder);
  if (!found) return state;
  if (!options.resume) {
    throw Error(
        ErrorCode::usage,
        fmt::format("{} holds a series ({} of {} steps); --resume goes on with it, --force begins anew",
                    options.folder, found->finished_steps, found->recipe.value("times", Json()).size()));
  }
  checkSameRecipe(options.folder, found->recipe, state.recipe);
  checkState(options.folder, *found, state.channels, series.count());
  return *found;
}

std::vector<ValueRange> findRanges(const SimulateOptions& options, FieldSeries& series,
                                   const GlobalOptions& global) {
  if (!options.range.empty()) {
    if (series.channels().size() != 1) {
      throw Error(ErrorCode::usage,
                  fmt::format("--range is for one quantity; these are {}: {}", series.channels().size(),
                              fmt::join(namesOf(series.channels()), ", ")));
    }
    return {parseRange(options.range)};
  }
  ProgressBar progress(global, "value range", series.count());
  return series.findRanges(1, [&progress](int done) { progress.show(done); });
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::other, {folder.string(), 0, 0}, "cannot make the folder: " + error.message());
}

Json rangesToJson(const SeriesState& state) {
  Json ranges = Json::object();
  for (std::size_t c = 0; c < state.channels.size(); ++c) {
    const ValueRange& range = state.ranges[c];
    ranges[state.channels[c]] = range.empty() ? Json(nullptr) : Json{range.min, range.max};
  }
  return ranges;
}

int simulate(SimulateOptions options, const GlobalOptions& global) {
  Stopwatch watch;
  const LoadedScenario input = loadScenarioWithTerrain(options.scenario, options.edits);
  const std::vector<double> times_s = options.times.empty()
                                          ? scenario::timesOf(input.scenario->clock)
                                          : scenario::parseTimes(options.times, input.scenario->clock);
  std::string device;
  const std::unique_ptr<FieldSeries> opened = openAtPlace(global, "float", [&](const Place& place) {
    device = place.device();
    emfield::FieldOptions field_options = place.fieldOptions();
    field_options.quantities = options.quantities;
    field_options.allow_missing_terrain = options.allow_missing_terrain;
    field_options.cache_bytes = static_cast<std::size_t>(options.cache_mib * (1 << 20));
    auto series = std::make_unique<FieldSeries>(input, times_s, field_options);
    series->rehearse();
    return series;
  });
  FieldSeries& series = *opened;

  makeFolder(options.folder);
  const FolderLock lock(options.folder, "series.lock");
  removeStaleTemporaries(options.folder);
  SeriesFiles files(options.folder, series.input().scenario->name, options.formats, times_s);
  if (options.force) files.removeOld();
  SeriesState state = beginState(options, series);
  const int first_step = state.finished_steps;
  if (state.ranges.empty()) {
    state.ranges = findRanges(options, series, global);
    writeSeriesState(options.folder, state);
  } else if (first_step > 0) {
    logInfo(fmt::format("{} of {} steps are there already", first_step, series.count()));
  }

  {
    ProgressBar progress(global, "computing", series.count());
    // While one step is written the next is computed, and one more may wait.
    BackgroundWriter writer(1);
    for (int step = first_step; step < series.count(); ++step) {
      writer.push([&files, &state, &options, step, volumes = series.compute(step, state.ranges)] {
        files.write(step, volumes);
        state.finished_steps = step + 1;
        writeSeriesState(options.folder, state);
      });
      progress.show(step + 1);
    }
    writer.finish();
  }
  for (const std::string& warning : series.warnings()) logWarning(warning);

  const double seconds = watch.lap_ms() / 1000;
  if (global.json) {
    printJson({{"device", device},
               {"folder", options.folder},
               {"steps", series.count()},
               {"steps_computed", series.count() - first_step},
               {"channels", state.channels},
               {"ranges", rangesToJson(state)},
               {"seconds", seconds}});
  } else {
    logInfo(fmt::format("{} steps of {} in {}, {:.1f} s", series.count(), fmt::join(state.channels, ", "),
                        options.folder, seconds));
  }
  return 0;
}

}  // namespace

void addSimulate(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      app.add_subcommand("simulate", "Compute a scenario's field over time and write it as volumes");
  command->fallthrough();
  command->footer(R"(
Every volume says the value range of the whole series, so all steps are computed once for the range (nothing is written) and once
for the files; --range saves the first pass. The folder also holds series.json: what was asked for and how far it is.

Examples:
  emscape simulate scenarios/jacksboro.yaml -o out
  emscape simulate scenarios/jacksboro.yaml -o out --format vdb,vti --quantity power_density_dbwm2,snr_db --times 0:60:1
  emscape simulate scenarios/jacksboro.yaml -o out --resume        after an interruption)");
  auto options = std::make_shared<SimulateOptions>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("-o,--output", options->folder, "Folder of the series; made if need be")->required();
  addListOption(*command, "--format", options->formats,
                "File formats, with commas between them: vdb, nvdb, vti, raw")
      ->check(CLI::IsMember(SeriesFiles::formatNames()));
  addListOption(
      *command, "--quantity", options->quantities,
      "Quantities, with commas between them (" + emfield::quantityNames() + "); default: the scenario's");
  command->add_option("--times", options->times,
                      "BEGIN:END:STEP, BEGIN:END or T, in seconds; default: the scenario's clock");
  command->add_option("--range", options->range, "MIN:MAX of the series if it is known; saves a pass");
  command->add_flag("--resume", options->resume, "Go on with the series that the folder holds");
  command->add_flag("--force", options->force, "Begin anew in a folder that holds a series")
      ->excludes("--resume");
  command->add_flag("--allow-missing-terrain", options->allow_missing_terrain,
                    "Compute although elevation data is missing; what lies over holes is masked");
  command->add_option("--cache-mib", options->cache_mib, "Bound on the per-emitter caches in MiB; 0: none")
      ->check(CLI::Range(0.0, 1e6));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return simulate(*options, global); }; });
}

}  // namespace emscape::app
