/// emscape import: makes a scenario of a recording of another program.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/common/console.h"
#include "apps/emscape/subcommands.h"
#include "base/files/whole_file.h"
#include "document/schema_check.h"
#include "emscape/base/log.h"
#include "emscape/scenario/file/scenario_file.h"
#include "interop/emitters/emitter_names.h"
#include "interop/import_scenario.h"
#include "recording/read_recording.h"
#include "report/maps/output_files.h"
#include "report/runs/import_report.h"

namespace emscape::app {
namespace {

struct ImportArguments {
  std::vector<std::string> files;
  std::string region = "auto";
  std::string times;
  std::string beamwidth = "by_size";
  std::string names;
  interop::ReadOptions read;
  interop::ImportOptions options;
};

/// "B:E". @throws Error (usage)
interop::TimeSpan parseSpan(const std::string& text) {
  const std::size_t at = text.find(':');
  const double nan = std::nan("");
  const double begin = document::numberOf(text.substr(0, at)).value_or(nan);
  const double end = at == std::string::npos ? nan : document::numberOf(text.substr(at + 1)).value_or(nan);
  if (!(begin < end) || !(std::abs(begin) <= 1e9) || !(std::abs(end) <= 1e9)) {
    throw Error(
        ErrorCode::usage,
        fmt::format(
            "--times '{}' is not BEGIN:END in seconds of the recording, BEGIN below END, such as 0:120",
            text));
  }
  return {begin, end};
}

/// @throws Error (bad_input) if the written scenario has faults
void check(const std::string& file) {
  for (const scenario::Problem& problem : scenario::parseScenario(file).problems) {
    if (problem.severity == scenario::Severity::error)
      throw Error(ErrorCode::bad_input, problem.location, problem.message);
    logWarning(toString(problem.location) + ": " + problem.message);
  }
}

/// Checks that neither a recording nor another input is replaced.
void checkOutput(const ImportArguments& arguments) {
  const interop::ImportOptions& options = arguments.options;
  std::vector<report::NamedFile> inputs{
      {"the base", options.base}, {"the emitter database", options.emitters}, {"--names", arguments.names}};
  for (const std::string& file : arguments.files) inputs.push_back({"the recording", file});
  for (const std::string& file : options.terrain) inputs.push_back({"an elevation file", file});
  std::vector<std::shared_ptr<const scenario::Scenario>> bases;
  if (options.replace && std::filesystem::is_regular_file(options.base)) {
    if (const auto base = scenario::parseScenario(options.base).scenario) bases.push_back(base);
  }
  report::checkOutputs({{"--output", options.scenario}}, inputs, bases, true);
  report::requireFolders({options.scenario});
}

int import(const ImportArguments& arguments, const GlobalOptions& global) {
  interop::ImportOptions options = arguments.options;
  if (arguments.region != "auto") options.region = interop::parseRegion(arguments.region);
  if (!arguments.times.empty()) options.times = parseSpan(arguments.times);
  options.beamwidth = parseName<interop::BeamwidthMeaning>("meaning of beamwidths", arguments.beamwidth);
  checkOutput(arguments);
  if (!options.replace) requireNew({options.scenario});  // before the work
  const ProgressSink progress = stoppingProgress(global);
  interop::ReadOptions read = arguments.read;
  if (!arguments.names.empty()) read.emitter_names = interop::readEmitterNames(arguments.names);
  std::vector<interop::Recording> recordings;
  for (const std::string& file : arguments.files)
    recordings.push_back(interop::readRecording(file, read, progress));
  const interop::ImportResult result =
      interop::importRecording(interop::merged(std::move(recordings)), options, progress);
  check(options.scenario);
  if (global.json) {
    printJson(report::importJson(result));
  } else if (!global.quiet) {
    print("{}", report::importText(result));
  }
  return 0;
}

}  // namespace

void addImport(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("import", "Make a scenario of a recording of another program");
  command->fallthrough();
  command->footer(R"(
Reads ACMI 2.0 to 2.2 (Tacview; .acmi, .zip.acmi), DIS (.pcap, .pcapng, hexadecimal logs, .session), SIMDIS .asi, Cursor on Target,
and tracks (GPX, KML and KMZ, CZML, STK .e, NMEA, CSV with a line of names), and writes a scenario with CSV tracks in STEM_tracks
beside it. What recordings do not tell of their emitters is taken from a database; a starter set is built
in (scenarios/data/emitters.yaml). Ends with a table of the objects, the emitters that were matched or not, and what was lost,
torn or ignored.

Examples:
  emscape import flight.zip.acmi -o flight.yaml
  emscape import exercise.pcap -o exercise.yaml --emitters mine.yaml --times 600:1200
  emscape import flight.acmi -o added.yaml --base scenarios/jacksboro.yaml --only "F-14*,Air+Rotorcraft"
  emscape import flight.acmi -o flight.yaml --json
  emscape import ship.gpx aircraft.kml -o walk.yaml --base scenarios/jacksboro.yaml
  emscape import log.csv -o log.yaml --columns "time=Zeit,latitude=Breite,longitude=Laenge,height=Hoehe:ft" --gap 60

Exit status: 0; 2 for wrong options; 3 for a recording, database or base that cannot be used.)");
  auto arguments = std::make_shared<ImportArguments>();
  command->add_option("FILE", arguments->files, "Recordings of the same battlefield")->required();
  command->add_option("-o,--output", arguments->options.scenario, "The scenario to write")->required();
  command->add_option("--emitters", arguments->options.emitters,
                      "Emitter database, whose rows come before the starter set's");
  command->add_option(
      "--base", arguments->options.base,
      "Scenario to which the platforms and emitters are added; its region, terrain and output stay");
  command->add_flag("--force", arguments->options.replace, "Replace the scenario and its tracks");
  addListOption(*command, "--terrain", arguments->options.terrain, "Elevation files of the scenario");
  command->add_option("--region", arguments->region,
                      "auto, or LAT,LON,SIZE_KM: the field's region; auto is around all platforms");
  command->add_option("--times", arguments->times, "BEGIN:END: part of the recording, in its seconds");
  addListOption(*command, "--only", arguments->options.only, "Names or types of the objects, with * and ?");
  command->add_option("--beamwidth", arguments->beamwidth,
                      "Beamwidths of the recording: by_size (up to 15 degrees the beam's, else of the "
                      "searched sector), scan or beam");
  command
      ->add_option("--timeout", arguments->read.emission_timeout_s,
                   "Seconds without update after which an emission of DIS ends")
      ->check(CLI::Range(0.1, 1e6));
  command
      ->add_option("--exercise", arguments->read.exercise,
                   "Exercise of DIS that is read; by default that of the first PDU")
      ->check(CLI::Range(0, 255));
  command->add_option(
      "--names", arguments->names,
      "SISO-REF-010.xml: names of the emitters of DIS in messages and tables, else their numbers");
  command->add_option(
      "--columns", arguments->read.columns,
      "Columns of a CSV file: ROLE=NAME[:UNIT],... with the roles time, latitude, longitude, height, "
      "height_ellipsoid, height_pressure, heading, pitch, roll and id; by default by common names");
  command
      ->add_option("--gap", arguments->read.gap_s,
                   "Seconds without a position after which a track (GPX, KML, CZML, STK, NMEA, CSV) has "
                   "ended until the "
                   "next one; by default gaps are bridged")
      ->check(CLI::Range(0.0, 1e8));
  command->callback([arguments, &global, &action] {
    action = [arguments, &global] { return import(*arguments, global); };
  });
}

}  // namespace emscape::app
