/// emscape bench coverage: time of computing coverage maps.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "base/stopwatch.h"
#include "emscape/base/parallel.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/map_grid.h"

namespace emscape::app {
namespace {

struct BenchCoverageOptions {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string area;
  double cell_m = 100, height_m = 150, step_m = 100;
  int further = 4, repeats = 3;
  std::string quantity = "detection_probability";
  std::vector<std::string> models;
};

/// A step of the computation of maps.
struct Step {
  const char* name;
  double first_ms;    ///< median time for the first height
  double further_ms;  ///< that each further height adds
};

/// Median times of the steps that compute maps at some heights, by name.
struct MapTimes {
  std::vector<std::pair<const char*, double>> steps_ms;

  double all_ms() const {
    double sum_ms = 0;
    for (const auto& [name, ms] : steps_ms) sum_ms += ms;
    return sum_ms;
  }
};

/// @param heights_m  above ground
MapTimes timesOf(const std::shared_ptr<const scenario::Scenario>& scenario,
                 const scenario::TerrainPtr& terrain, const study::MapGrid& grid,
                 const std::vector<double>& heights_m, int repeats, const ComputeTarget& target) {
  auto surface = std::make_shared<emfield::Surface>();
  surface->width = grid.width;
  surface->height = grid.height;
  surface->positions = grid.positions;
  surface->heights_m = heights_m;
  emfield::FieldOptions options = target.fieldOptions();
  options.surface = surface;
  options.allow_missing_terrain = true;
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  std::vector<std::vector<double>> times;  // of each step, by repeat
  MapTimes medians;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    stopIfInterrupted();
    Stopwatch watch;
    emfield::FieldSolver solver(scenario, terrain, options);
    const double places_ms = watch.lap_ms();
    solver.update(snapshot);
    const double update_ms = watch.lap_ms();
    for (const volume::Volume& volume : solver.volumes()) volume.host();
    const double values_ms = watch.lap_ms();
    const emfield::StageTimes stages = solver.stageTimes();
    const double stages_ms =
        stages.columns_ms + stages.march_ms + stages.excess_ms + stages.combine_ms + stages.product_ms;
    medians.steps_ms = {{"places", places_ms},           {"columns", stages.columns_ms},
                        {"march", stages.march_ms},      {"excess", stages.excess_ms},
                        {"combine", stages.combine_ms},  {"product", stages.product_ms},
                        {"rest", update_ms - stages_ms}, {"values", values_ms}};
    times.resize(medians.steps_ms.size());
    for (std::size_t n = 0; n < times.size(); ++n) times[n].push_back(medians.steps_ms[n].second);
  }
  for (std::size_t n = 0; n < times.size(); ++n) medians.steps_ms[n].second = medianOf(times[n]);
  return medians;
}

/// Times of a scenario's map.
struct MapOfScenario {
  study::MapGrid grid;
  long long pixels = 0;  ///< within the area
  std::string device;
  double grid_ms = 0;
  MapTimes first;  ///< of the first height
  MapTimes all;    ///< of all heights

  double first_ms() const { return grid_ms + first.all_ms(); }
  /// That each further height adds.
  double further_ms(int further) const {
    return further == 0 ? 0 : (all.all_ms() - first.all_ms()) / further;
  }
};

/// @param edits  of the scenario
MapOfScenario mapOf(const BenchCoverageOptions& options, const std::vector<scenario::Edit>& edits,
                    const GlobalOptions& global) {
  scenario::Scenario chosen = *scenario::loadScenario(options.scenario, edits);
  chosen.output.quantities = {scenario::info(scenario::quantityFromName(options.quantity)).name};
  chosen.output.radar_look = scenario::RadarAim::target;
  const auto scenario = std::make_shared<const scenario::Scenario>(std::move(chosen));
  const study::MapArea area =
      options.area.empty() ? study::areaOf(scenario->region) : study::parseArea(options.area);
  const scenario::TerrainPtr terrain = study::loadTerrain(*scenario, area);
  MapOfScenario map;
  std::vector<double> grids_ms;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    map.grid = {};
    Stopwatch watch;
    map.grid = study::makeMapGrid(area, options.cell_m, "utm");
    grids_ms.push_back(watch.lap_ms());
  }
  map.grid_ms = medianOf(grids_ms);
  map.pixels = std::count_if(
      map.grid.positions.begin(), map.grid.positions.end(),
      [](const emfield::Surface::Position& place) { return place.latitude_deg == place.latitude_deg; });
  map.device = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    std::vector<double> heights_m{options.height_m};
    map.first = timesOf(scenario, terrain, map.grid, heights_m, options.repeats, target);
    for (int n = 1; n <= options.further; ++n) heights_m.push_back(options.height_m + n * options.step_m);
    map.all = timesOf(scenario, terrain, map.grid, heights_m, options.repeats, target);
    return target.device();
  });
  return map;
}

void printHead(const BenchCoverageOptions& options, const MapOfScenario& map) {
  print("device {} ({} threads), map of {} x {} pixels of {:g} m, {} within the area, medians of {}\n\n",
        map.device, threadCount(), map.grid.width, map.grid.height, map.grid.cell_m, map.pixels,
        options.repeats);
}

/// The same map with each of some propagation models.
int benchModels(const BenchCoverageOptions& options, const GlobalOptions& global) {
  const auto scenario = scenario::loadScenario(options.scenario, options.edits);
  Json rows = Json::array();
  bool has_head = false;
  for (const std::string& model : options.models) {
    std::vector<scenario::Edit> edits = options.edits;
    for (const scenario::Emitter& emitter : scenario->emitters) {
      edits.push_back(scenario::parseEdit(fmt::format("emitters.{}.propagation={}", emitter.name, model)));
    }
    const MapOfScenario map = mapOf(options, edits, global);
    const double first_ms = map.first_ms(), further_ms = map.further_ms(options.further);
    if (global.json) {
      rows.push_back({{"model", model}, {"first_height_ms", first_ms}, {"further_height_ms", further_ms}});
      continue;
    }
    if (!has_head) {
      printHead(options, map);
      print("{:20}{:>14}{:>24}\n", "ms", "first height", "each further height");
      has_head = true;
    }
    print("{:20}{:14.0f}{:24.0f}  ({:.0f} % of the first; of {})\n", model, first_ms, further_ms,
          100 * further_ms / first_ms, options.further);
  }
  if (global.json)
    printJson({{"threads", threadCount()}, {"further_heights", options.further}, {"models", rows}});
  return 0;
}

int benchCoverage(const BenchCoverageOptions& options, const GlobalOptions& global) {
  if (!options.models.empty()) return benchModels(options, global);
  const MapOfScenario map = mapOf(options, options.edits, global);
  const MapTimes &first = map.first, &all = map.all;
  const double first_ms = map.first_ms(), further_ms = map.further_ms(options.further);
  std::vector<Step> steps{{"pixels", map.grid_ms, 0}};
  for (std::size_t n = 0; n < first.steps_ms.size(); ++n) {
    const auto& [name, of_first_ms] = first.steps_ms[n];
    const double added_ms = all.steps_ms[n].second - of_first_ms;
    steps.push_back({name, of_first_ms, options.further == 0 ? 0 : added_ms / options.further});
  }
  const double pixels_per_s = static_cast<double>(map.pixels) / (first_ms / 1000);
  if (global.json) {
    Json steps_ms, further_steps_ms;
    for (const Step& step : steps) {
      steps_ms[step.name] = step.first_ms;
      further_steps_ms[step.name] = step.further_ms;
    }
    printJson({{"device", map.device},
               {"threads", threadCount()},
               {"map", {map.grid.width, map.grid.height}},
               {"pixels", map.pixels},
               {"further_heights", options.further},
               {"first_height_ms", first_ms},
               {"further_height_ms", further_ms},
               {"pixels_per_s", pixels_per_s},
               {"steps_ms", steps_ms},
               {"further_steps_ms", further_steps_ms}});
    return 0;
  }
  printHead(options, map);
  print("{:20}{:>14}{:>24}\n", "ms", "first height", "each further height");
  print("{:20}{:14.2f}{:24.2f}  ({:.0f} % of the first; of {})\n", "all", first_ms, further_ms,
        100 * further_ms / first_ms, options.further);
  for (const Step& step : steps)
    print("  {:18}{:14.2f}{:24.2f}\n", step.name, step.first_ms, step.further_ms);
  print("\nmillion pixels per s{:14.2f}\n", pixels_per_s / 1e6);
  return 0;
}

}  // namespace

void addBenchCoverage(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("coverage", "Time a map of coverage");
  command->fallthrough();
  command->footer(R"(
Time of a map from its area to the values of its pixels, without reading the terrain and without writing files, and the time that each
further height adds. pixels: their positions in the projection; positions: terrain below them, and memory (on a GPU also the copy of the
terrain to it); columns to product: the stages of the field; rest: the remainder of its wall-clock time; values: copied from the GPU. Work that a
program does once (start of the GPU, database of projections) is in the first repeat, not in the medians.

Example:
  emscape bench coverage scenarios/jacksboro.yaml --area 36.303,-84.246,10000 --cell 30
  emscape bench coverage scenarios/jacksboro.yaml --models horizon,itm --repeats 1)");
  auto options = std::make_shared<BenchCoverageOptions>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option(
      "--area", options->area,
      "LATITUDE,LONGITUDE,RADIUS_M or bbox:WEST,SOUTH,EAST,NORTH (deg); default: the box around the region");
  command->add_option("--cell", options->cell_m, "Side of a pixel (m)");
  command->add_option("--height", options->height_m, "First height above ground (m)")
      ->check(CLI::Range(0.0, 100e3));
  command->add_option("--further", options->further, "Number of further heights")->check(CLI::Range(0, 100));
  command->add_option("--height-step", options->step_m, "Distance between heights (m)")
      ->check(CLI::Range(0.1, 1000.0));
  command->add_option("--quantity", options->quantity, "Quantity to map");
  command
      ->add_option("--models", options->models,
                   "Propagation models of all emitters, with commas between them: a row of times for each")
      ->delimiter(',');
  command->add_option("--repeats", options->repeats, "Computations of each kind; the median is reported")
      ->check(CLI::Range(1, 1000));
  command->callback([options, &global, &action] {
    action = [options, &global] { return benchCoverage(*options, global); };
  });
}

}  // namespace emscape::app
