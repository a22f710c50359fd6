/// emscape export: writes a scenario as a recording for other programs.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/common/console.h"
#include "apps/common/target.h"
#include "apps/emscape/subcommands.h"
#include "base/files/file_reading.h"
#include "base/files/json_writing.h"
#include "base/files/unfinished_file.h"
#include "base/text/count_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/study/maps/coverage.h"
#include "interop/export_scenario.h"
#include "report/maps/map_options.h"
#include "report/maps/output_files.h"
#include "report/warnings.h"
#include "study/files/czml.h"

namespace emscape::app {
namespace {

struct ExportArguments {
  std::string scenario, file;
  std::string coverage;  ///< heights; empty: none
  std::vector<scenario::Edit> edits;
  interop::ExportOptions options;
};

constexpr int kCoverageSteps = 10;  ///< of the scenario's time
constexpr std::size_t kMaxOutlineBytes = std::size_t{1} << 30;

using Json = nlohmann::ordered_json;

report::MapOptions outlineOptions(const ExportArguments& arguments, const scenario::Scenario& scenario) {
  report::MapOptions options;
  options.heights = arguments.coverage;
  options.products = {"covered"};
  const double duration_s = scenario.clock.duration_s;
  for (int i = 0; i <= (duration_s > 0 ? kCoverageSteps : 0); ++i)
    options.times_s.push_back(duration_s * i / kCoverageSteps);
  return options;
}

/// @throws Error (usage) if no outlines can be written
void checkCoverage(const ExportArguments& arguments, const scenario::Scenario& scenario) {
  if (std::filesystem::path(arguments.file).extension() != ".czml")
    throw Error(ErrorCode::usage,
                "--coverage is written into .czml alone; emscape coverage has other formats");
  const auto isRadar = [](const scenario::Emitter& emitter) {
    return emitter.kind == scenario::EmitterKind::radar;
  };
  if (!std::any_of(scenario.emitters.begin(), scenario.emitters.end(), isRadar)) {
    throw Error(
        ErrorCode::usage,
        "--coverage is that of radars, and the scenario has none; emscape coverage --quantity has others");
  }
  study::checkRequest(report::requestOf(outlineOptions(arguments, scenario), scenario.clock), scenario);
}

/// The outlines of what the radars detect, as packets of CZML, each after ",\n".
std::string outlinePackets(const ExportArguments& arguments,
                           const std::shared_ptr<const scenario::Scenario>& scenario,
                           const GlobalOptions& global) {
  const report::MapOptions options = outlineOptions(arguments, *scenario);
  const study::CoverageRequest request = report::requestOf(options, scenario->clock);
  const study::MapArea area = report::areaOf(options, *scenario);
  const auto grid = report::gridOf(options, *scenario, area);
  const scenario::TerrainPtr terrain = study::loadTerrain(*scenario, area);
  study::MapStudy study;
  study.command = "coverage";
  study.title = "Coverage of " + scenario->name;
  study.scenarios = {scenario};
  study.terrain = terrain;
  study.grid = grid;
  study.quantity = request.quantity;
  study.threshold = request.threshold;
  study.times_s = request.times_s;
  study.heights = request.heights;
  const UnfinishedFile scratch(arguments.file, Replaces::any);  // never published
  const auto outlines = study::makeCzml(scratch.temporary(), study);
  const std::vector<std::string> warnings = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    return study::computeCoverage(
        scenario, terrain, *grid, request, target.fieldOptions(),
        [&](const study::CoverageMap& map) { outlines->add(map); }, stoppingProgress(global));
  });
  report::logWarnings(warnings, {scenario});
  outlines->finish();
  std::string packets;
  for (const Json& packet : Json::parse(readWholeText(scratch.temporary(), kMaxOutlineBytes))) {
    // Its document, tracks and emitters are those of the recording.
    if (packet.contains("polygon") || packet["id"].get<std::string>().rfind("group/", 0) == 0)
      packets += ",\n" + dumpJson(packet);
  }
  return packets;
}

int writeRecording(ExportArguments& arguments, const GlobalOptions& global) {
  const auto scenario =
      scenario::loadScenario(arguments.scenario, arguments.edits, scenario::ReadFor::chosen_times);
  report::checkOutputs({{"--output", arguments.file}}, {}, {scenario}, true);
  report::requireFolders({arguments.file});
  if (!arguments.coverage.empty()) {
    checkCoverage(arguments, *scenario);
    arguments.options.czml_packets = [&] { return outlinePackets(arguments, scenario, global); };
  }
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const interop::ExportResult result = interop::exportScenario(scenario, terrain.get(), arguments.file,
                                                               arguments.options, stoppingProgress(global));
  if (global.json) {
    printJson({{"file", result.file},
               {"format", result.format},
               {"emitter_database", result.emitters},
               {"records", result.records},
               {"platforms", result.platforms},
               {"emitters", result.emitter_count},
               {"notes", result.notes}});
  } else if (!global.quiet) {
    print(
        "{}: {}, {}, {}, {}\n{}: what the recording does not tell of the "
        "emitters\n",
        result.file, result.format, countText(result.platforms, "platform", "platforms"),
        countText(result.emitter_count, "emitter", "emitters"),
        countText(result.records, "record", "records"), result.emitters);
    for (const std::string& note : result.notes) print("note: {}\n", note);
  }
  return 0;
}

}  // namespace

void addExport(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("export", "Write a scenario as a recording for other programs");
  command->fallthrough();
  command->footer(R"(
The ending of the file tells the format: .acmi and .zip.acmi (Tacview's ACMI 2.2), .pcap (DIS version 7 as UDP datagrams to port
3000), .asi (SIMDIS), .cot (Cursor on Target events), .czml (Cesium) and .kml (Google Earth). Beside it FILE.emitters.yaml is written, an emitter database for `emscape import --emitters`, as recordings tell neither
antennas nor receivers.

Examples:
  emscape export scenarios/jacksboro.yaml -o jacksboro.zip.acmi
  emscape export scenarios/jacksboro.yaml -o jacksboro.pcap --step 0.5
  emscape export scenarios/jacksboro.yaml -o jacksboro.czml --coverage agl:150
  emscape import jacksboro.pcap --emitters jacksboro.pcap.emitters.yaml -o back.yaml

Exit status: 0; 2 for wrong options; 3 for a faulty scenario.)");
  auto arguments = std::make_shared<ExportArguments>();
  command->add_option("SCENARIO", arguments->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, arguments->edits);
  command
      ->add_option("-o,--output", arguments->file,
                   "The recording: .acmi, .zip.acmi, .pcap, .asi, .cot, .czml or .kml")
      ->required();
  command->add_flag("--force", arguments->options.replace, "Replace the recording and its emitter database");
  command->add_option(
      "--coverage", arguments->coverage,
      "Heights, as agl:150 or msl:1000: .czml gets outlines of where radars detect the target there, at "
      "11 times");
  command
      ->add_option("--step", arguments->options.step_s,
                   "Largest time between positions of a moving platform (s; 1)")
      ->check(CLI::Range(0.01, 3600.0));
  command->callback([arguments, &global, &action] {
    action = [arguments, &global] { return writeRecording(*arguments, global); };
  });
}

}  // namespace emscape::app
