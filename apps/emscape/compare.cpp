/// emscape compare: gains and losses of one scenario against another.
#include "study/compare/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "apps/common/console.h"
#include "apps/common/target.h"
#include "apps/emscape/common/study_options.h"
#include "apps/emscape/subcommands.h"
#include "base/files/inputs.h"
#include "base/text/quantity_text.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/format/file.h"
#include "report/maps/compare_report.h"
#include "report/maps/output_files.h"
#include "study/report/map_folder.h"
#include "volume/difference.h"

namespace emscape::app {
namespace {

struct CompareCommand {
  std::string a, b;
  std::vector<scenario::Edit> edits, edits_b;
  std::string folder;
  report::MapOptions maps;
  ViewArguments view;
  std::string volume;
  int areas = 3;
  std::set<std::string> given;  ///< names of the options on the command line
};

/// Writes B minus A in the voxels of A's region.
void writeVolume(const CompareCommand& command, const study::ComparedScenario& a,
                 const study::ComparedScenario& b, double time_s, emfield::FieldOptions options) {
  options.quantities = {command.maps.quantity};
  options.allow_missing_terrain = true;
  const auto solved = [&](const study::ComparedScenario& of) {
    auto own = std::make_shared<scenario::Scenario>(*of.scenario);
    own->output.radar_look = scenario::RadarAim::target;
    if (own->output.combine != scenario::CombineMode::max) own->output.combine = scenario::CombineMode::sum;
    own->region = a.scenario->region;
    emfield::FieldSolver solver(own, of.terrain, options);
    solver.update(scenario::snapshotAt(own, of.terrain.get(), time_s));
    return solver.volumes().front().host();
  };
  const auto of_a = solved(a), of_b = solved(b);
  const volume::DenseVolume difference = volume::difference(*of_b, *of_a);
  volume::writeVolumes(command.volume, {&difference});
  logInfo("wrote " + command.volume);
}

void printHeading(const std::string& a, const std::string& b, const study::MapGrid& grid,
                  scenario::Quantity quantity, double threshold) {
  const scenario::QuantityInfo& info = scenario::info(quantity);
  print("B ({}) against A ({}): {} x {} pixels of {} m in {}, {} >= {}\n", b, a, grid.width, grid.height,
        grid.cell_m, grid.crs, info.name, quantityText(threshold, info.unit));
}

/// @param a, b  clutter in the losses of each
void printClutter(const std::string& a, const std::string& b) {
  print(a == b ? fmt::format("ground cover: {}\n", a) : fmt::format("ground cover: A: {}; B: {}\n", a, b));
}

void printOutcome(const std::string& report_json, const study::Comparison& comparison,
                  const std::string& quantity, const GlobalOptions& global) {
  if (global.json) {
    printResult(report_json);
    finishResult();
  } else {
    printResult(report::comparisonText(comparison, quantity));
  }
}

/// Of B: its scenario's name, or what it changes in A.
std::string nameOfB(const CompareCommand& command, const scenario::Scenario& b) {
  if (!command.b.empty()) return b.name;
  std::vector<std::string> edits;
  for (const scenario::Edit& edit : command.edits_b) edits.push_back(scenario::toString(edit));
  return fmt::format("A with {}", fmt::join(edits, ", "));
}

int compareScenarios(const CompareCommand& command, const GlobalOptions& global) {
  if (command.b.empty() && command.edits_b.empty()) {
    throw Error(ErrorCode::usage, "compare: give a second scenario, or --set-b PATH=VALUE for the first one");
  }
  if (!command.volume.empty()) volume::formatOf(command.volume);
  std::vector<scenario::Edit> edits_b = command.edits;
  edits_b.insert(edits_b.end(), command.edits_b.begin(), command.edits_b.end());
  const auto a = scenario::loadScenario(command.a, command.edits, scenario::ReadFor::chosen_times);
  const auto b = scenario::loadScenario(command.b.empty() ? command.a : command.b, edits_b,
                                        scenario::ReadFor::chosen_times);
  report::checkOutputs({{"--volume", command.volume}}, {}, {a, b});
  report::ScenarioComparison run(a, b, command.maps, command.areas, command.folder,
                                 command.b.empty() ? "its change" : b->name);
  const study::CoverageRequest& of = run.request();
  if (!global.json) printHeading(a->name, nameOfB(command, *b), run.grid(), of.quantity, of.threshold);
  if (!global.json) printClutter(emfield::clutterText(*a), emfield::clutterText(*b));
  const study::Comparison comparison = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    study::Comparison result = run.compute(target.fieldOptions(), stoppingProgress(global));
    if (!command.volume.empty())
      writeVolume(command, run.a(), run.b(), of.times_s.front(), target.fieldOptions());
    return result;
  });
  printOutcome(run.finish(comparison), comparison, command.maps.quantity, global);
  return 0;
}

/// For folders of maps only these options are allowed: the contents of the maps were chosen when they were
/// computed.
void checkFolderOptions(const CompareCommand& command) {
  static const std::set<std::string> kAllowed{
      "A",         "B",       "--output", "--products",    "--heights", "--times",     "--format",
      "--explain", "--drape", "--places", "--range-rings", "--units",   "--field-unit"};
  for (const std::string& option : command.given) {
    if (kAllowed.count(option) > 0) continue;
    throw Error(ErrorCode::usage,
                option + ": does not go with folders of maps, which are compared as they are");
  }
}

int compareFolders(const CompareCommand& command, const GlobalOptions& global) {
  checkFolderOptions(command);
  const auto isGiven = [&](const char* option) { return command.given.count(option) > 0; };
  const study::CoverageFolder a = study::openCoverageFolder(command.a),
                              b = study::openCoverageFolder(command.b);
  report::checkMapFolder(command.folder, {a.scenario, b.scenario}, "--output");
  study::MapChoice choice;
  if (isGiven("--products")) choice.products = report::productsOf(command.maps);
  if (isGiven("--heights")) choice.heights = study::parseHeights(command.maps.heights);
  if (isGiven("--times")) choice.times_s = scenario::parseTimes(command.maps.times, a.scenario->clock);
  const auto pairs = study::pairsOf(a, b, choice);

  std::set<double> times_s;
  std::vector<study::MapHeight> heights;
  std::vector<study::CoverageMap> compared;
  for (const auto& [of_a, of_b] : pairs) {
    const study::CoverageMap& map = compared.emplace_back(a.maps[of_a]);
    if (map.height) heights.push_back(*map.height);
    if (map.time_s) times_s.insert(*map.time_s);
  }
  if (times_s.empty()) times_s.insert(0);
  const std::string quantity = scenario::info(a.quantity).name;
  study::MapFolder folder(command.folder,
                          {"compare",
                           fmt::format("Comparison of {} (A) and {} (B)", command.a, command.b),
                           {a.scenario, b.scenario},
                           a.terrain,
                           a.grid,
                           a.quantity,
                           a.threshold,
                           {times_s.begin(), times_s.end()},
                           heights,
                           command.maps.view},
                          command.maps.formats);
  report::requireReplaceable(folder, compared);
  if (!global.json) printHeading(command.a, command.b, *a.grid, a.quantity, a.threshold);
  if (!global.json) printClutter(emfield::clutterText(*a.scenario), emfield::clutterText(*b.scenario));
  const study::Comparison comparison = study::compareFolders(
      a, b, pairs, command.areas, [&](const study::Map& map) { folder.add(map); }, stoppingProgress(global));
  const std::string json = report::finishComparison(folder, comparison, {a.scenario, a.terrain},
                                                    {b.scenario, b.terrain}, quantity);
  printOutcome(json, comparison, quantity, global);
  return 0;
}

int compare(const CompareCommand& command, const GlobalOptions& global) {
  for (const std::string& read : {command.a, command.b}) {
    if (!read.empty() && !inputExists(read))
      throw Error(ErrorCode::bad_input, {read, 0, 0}, "there is no such file or folder");
  }
  const bool is_folder = std::filesystem::is_directory(command.a);
  if (!command.b.empty() && is_folder != std::filesystem::is_directory(command.b)) {
    throw Error(ErrorCode::usage,
                fmt::format("compare: {} is a folder and {} is not; give two scenarios, or two "
                            "folders of emscape coverage",
                            is_folder ? command.a : command.b, is_folder ? command.b : command.a));
  }
  if (is_folder && command.b.empty()) {
    throw Error(ErrorCode::usage, "compare: give a second folder of emscape coverage");
  }
  for (const std::string& read : {command.a, command.b}) {
    std::error_code none;
    if (is_folder && std::filesystem::equivalent(read, command.folder, none)) {
      throw Error(ErrorCode::usage,
                  fmt::format("--output: {} is one of the folders to compare; give another", command.folder));
    }
  }
  return is_folder ? compareFolders(command, global) : compareScenarios(command, global);
}

}  // namespace

void addCompare(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand(
      "compare", "Compare the coverage of two scenarios or folders of maps: areas gained and lost, and why");
  command->fallthrough();
  command->footer(R"(
A and B are two scenarios, or one with --set-b, or two folders that `emscape coverage` wrote. Maps are of B less A: for products
that mark an area (covered, jam_loss, burn_through) what is gained, lost and kept, for all others the difference. The table has
the areas; the largest connected ones that changed are explained by the path from the emitter that decides, in A and in B, as
`emscape profile` does. Products are those of `emscape coverage`, except best.

Folders are compared as they are: nothing is computed again. They need GeoTIFFs (--format cog) of the same pixels, quantity,
threshold and units. All maps are compared; --products, --heights and --times choose some. Paths are explained if both scenarios
are still there, unchanged.

Examples:
  emscape compare scenarios/jacksboro.yaml -o out --set-b emitters.jammer.power_w=100 --times 80
  emscape compare scenarios/jacksboro.yaml -o out --set-b "platforms.ridge site.position.height_agl_m=40" --heights agl:30,150
  emscape compare before.yaml after.yaml -o out --products covered,min_height --volume out/difference.vdb
  emscape compare maps_before maps_after -o out --products covered --heights agl:150

DIR has maps, report.html, report.json and study.json, as `emscape coverage` writes them.)");
  auto options = std::make_shared<CompareCommand>();
  command->add_option("A", options->a, "Scenario (YAML or JSON), or folder of emscape coverage")->required();
  command->add_option("B", options->b, "Scenario or folder that A is compared with; default: A with --set-b");
  addSetOption(*command, options->edits);
  addSetOption(*command, options->edits_b, "--set-b", "changes a value of B only");
  command->add_option("-o,--output", options->folder, "Folder to write")->required();
  addMapOptions(*command, options->maps, options->view);
  command->add_option("--volume", options->volume,
                      "Volume of B less A in A's region at the first time: a .vdb, .vti or .nvdb file");
  command
      ->add_option("--explain", options->areas,
                   "Number of areas that are explained, of those gained and of those lost each")
      ->check(CLI::Range(0, 100));
  command->callback([options, command, &global, &action] {
    for (const CLI::Option* option : command->get_options()) {
      if (option->count() > 0) options->given.insert(option->get_name());
    }
    action = [options, &global] {
      options->view.apply(options->maps.view);
      return compare(*options, global);
    };
  });
}

}  // namespace emscape::app
