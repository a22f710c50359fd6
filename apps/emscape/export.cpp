/// emscape export: writes a scenario as a recording for other programs.
#include <fmt/core.h>

#include <memory>

#include "apps/common/console.h"
#include "apps/emscape/subcommands.h"
#include "base/text/count_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "interop/export_scenario.h"

namespace emscape::app {
namespace {

struct ExportArguments {
  std::string scenario, file;
  std::vector<scenario::Edit> edits;
  interop::ExportOptions options;
};

int writeRecording(const ExportArguments& arguments, const GlobalOptions& global) {
  const auto scenario =
      scenario::loadScenario(arguments.scenario, arguments.edits, scenario::ReadFor::chosen_times);
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
  command
      ->add_option("--step", arguments->options.step_s,
                   "Largest time between positions of a moving platform (s; 1)")
      ->check(CLI::Range(0.01, 3600.0));
  command->callback([arguments, &global, &action] {
    action = [arguments, &global] { return writeRecording(*arguments, global); };
  });
}

}  // namespace emscape::app
