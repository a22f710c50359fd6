/// emscape coverage: coverage maps at heights above ground or sea level.
#include "emscape/study/maps/coverage.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/text/quantity_text.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "report/maps/output_files.h"
#include "report/warnings.h"
#include "study/maps/surface_maps.h"
#include "study/report/map_folder.h"

namespace emscape::app {
namespace {

struct CoverageCommand {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  std::string folder;
  report::MapOptions maps;
  ViewArguments view;
};

/// The area of a map of yes and no; of one with more classes those of all but the first, largest first.
std::string areaText(const study::Map& map, const study::MapSummary& summary) {
  const double known_m2 = summary.known_area_m2;
  if (!(known_m2 > 0)) return "nothing known";
  if (map.labels.size() <= 2)
    return fmt::format("{:.1f} of {:.1f} km2 known, {:.1f} %", summary.class_area_m2 / 1e6, known_m2 / 1e6,
                       100 * summary.class_area_m2 / known_m2);
  std::vector<std::size_t> classes;
  for (std::size_t n = 1; n < map.labels.size(); ++n) {
    if (summary.label_areas_m2[n] > 0) classes.push_back(n);
  }
  std::sort(classes.begin(), classes.end(), [&](std::size_t a, std::size_t b) {
    return summary.label_areas_m2[a] > summary.label_areas_m2[b];
  });
  std::string areas;
  for (const std::size_t n : classes)
    areas +=
        fmt::format("{}{} {:.1f}", areas.empty() ? "" : ", ", map.labels[n], summary.label_areas_m2[n] / 1e6);
  return fmt::format("{} of {:.1f} km2 known", areas.empty() ? "none" : areas, known_m2 / 1e6);
}

void printRow(const study::MapRecord& record) {
  const study::Map& map = record.map;
  const study::MapSummary& summary = record.summary;
  const std::string time = map.time_s ? fmt::format("{} s", *map.time_s) : "all";
  std::string area = map.area_class >= 0 ? areaText(map, summary) : "";
  if (map.area_class >= 0 && summary.unknown_area_m2 > 0)
    area += fmt::format("; {:.1f} km2 unknown", summary.unknown_area_m2 / 1e6);
  print("  {:<16} {:<26} {:>8}  {:<28} {}\n", map.name, map.height ? study::describe(*map.height) : "", time,
        area, record.files.empty() ? "" : record.files.front());
}

int coverage(const CoverageCommand& command, const GlobalOptions& global) {
  const auto scenario =
      scenario::loadScenario(command.scenario, command.edits, scenario::ReadFor::chosen_times);
  const study::CoverageRequest request = report::requestOf(command.maps, scenario->clock);
  study::checkRequest(request, *scenario);
  report::checkMapFolder(command.folder, {scenario}, "--output");
  const study::MapArea area = report::areaOf(command.maps, *scenario);
  const auto grid = report::gridOf(command.maps, *scenario, area);
  const scenario::TerrainPtr terrain = study::loadTerrain(*scenario, area);
  if (terrain) study::requireGround(*scenario, *terrain, *grid);

  study::MapFolder folder(command.folder,
                          {"coverage",
                           "Coverage of " + scenario->name,
                           {scenario},
                           terrain,
                           grid,
                           request.quantity,
                           request.threshold,
                           request.times_s,
                           request.heights,
                           command.maps.view},
                          command.maps.formats);
  std::vector<std::string> names;
  for (const study::CoverageMap& map : study::outlinesOf(request)) names.push_back(fileNameOf(map));
  folder.requireReplaceable(names);
  if (!global.json) {
    const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
    print("Coverage of {}: {} x {} pixels of {} m in {}, {}{}\n", scenario->name, grid->width, grid->height,
          grid->cell_m, grid->crs, quantity.name,
          quantity.categorical ? "" : " >= " + quantityText(request.threshold, quantity.unit));
    print("ground cover: {}\n", emfield::clutterText(*scenario));
    if (const std::string target = emfield::targetText(*scenario); !target.empty())
      print("target: {}\n", target);
  }
  const auto take = [&](const study::CoverageMap& map) {
    stopIfInterrupted();
    const study::MapRecord& record = folder.add(map);
    if (!global.json) printRow(record);
  };
  const std::vector<std::string> warnings = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    return study::computeCoverage(scenario, terrain, *grid, request, target.fieldOptions(), take,
                                  stoppingProgress(global));
  });
  report::logWarnings(warnings, {scenario});
  folder.finish(report::joinedWarnings(warnings));
  if (global.json) {
    printResult(folder.reportJson());
    finishResult();
  } else {
    for (const std::string& file : folder.collections()) print("All maps: {}/{}\n", command.folder, file);
    print("Report: {}/report.html\n", command.folder);
  }
  return 0;
}

}  // namespace

void addCoverage(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "coverage",
      "Maps of what radars detect, or of any quantity, at heights above ground or sea, as GeoTIFF");
  command->fallthrough();
  std::string products;
  for (const study::ProductInfo& entry : study::productTable()) {
    products += fmt::format("  {:<16} {}\n", entry.name, entry.description);
  }
  std::string format_lines;
  for (const study::MapFormat& format : study::mapFormats()) {
    format_lines += fmt::format("  {:<5} {}\n", format.name, format.description);
  }
  command->footer(fmt::format(R"(
Each pixel is computed at its centre, on the surface itself, and equals `emscape profile` there
(parabolic_equation: the mean over cells between marched azimuths, which differs over terrain). A height above ground follows the
ground; pixels below ground, without terrain or outside the area have no value. Radars look at the target, wherever their scan
points. A pixel is covered if the quantity is at or above --threshold.

Products:
{}
Formats of --format, in DIR/maps:
{}
DIR/report.html shows the maps, their areas, the inputs and the accuracy of the models; report.json holds the same figures,
study.json the inputs with their hashes.

Examples:
  emscape coverage scenarios/jacksboro.yaml -o out --heights agl:30,150,300
  emscape coverage scenarios/jacksboro.yaml -o out --heights "agl:150;msl:1000:3000:500" --products covered,count,best
  emscape coverage scenarios/jamming.yaml -o out --products min_height,jam_loss --cell 100 --format png
  emscape coverage scenarios/jacksboro.yaml -o out --times 0:120:5 --products fraction,first_detection,longest_gap
  emscape coverage scenarios/jacksboro.yaml -o out --quantity power_density_dbwm2 --threshold -60 --area 36.3,-84.2,8000)",
                              products, format_lines));
  auto options = std::make_shared<CoverageCommand>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("-o,--output", options->folder, "Folder to write")->required();
  addMapOptions(*command, options->maps, options->view);
  command->callback([options, &global, &action] {
    action = [options, &global] {
      options->view.apply(options->maps.view);
      return coverage(*options, global);
    };
  });
}

}  // namespace emscape::app
