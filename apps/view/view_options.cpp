#include "apps/view/parts/view_options.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/common/arguments.h"
#include "apps/common/command.h"
#include "apps/common/stream_options.h"
#include "apps/common/view_arguments.h"
#include "apps/view/commands/action.h"
#include "apps/view/view_parser.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/clock.h"
#include "playback/view/view_file.h"
#include "recording/read_recording.h"

namespace emscape::view {
namespace {

constexpr const char* kFooter = R"(
The window shows the picture while it changes, interpolated if necessary, and makes it exact when the changes end.
F1 lists keys and mouse; --script runs the same actions from a file.

Examples:
  emscape view
  emscape view scenarios/jacksboro.yaml
  emscape view scenarios/jacksboro.yaml --state jacksboro.view.json
  emscape view out/jacksboro.pvd --scenario scenarios/jacksboro.yaml --scale 2
  emscape view scenarios/jacksboro.yaml --mesh terrain:32,4
  emscape view scenarios/jamming.yaml --dis 127.0.0.1:3000 --record exercise.pcap
  emscape view scenarios/jacksboro.yaml --set emitters.jammer.power_w=500 --script tour.jsonl --log tour.log

Exit status: 0 done, 2 usage, 3 bad input, 4 no window or device, 5 an expectation of the script was not met.)";

/// Options that need more than to be stored.
struct Typed {
  std::string state, size, time;
  app::ViewArguments given;
  app::StreamOptions stream;
  std::vector<scenario::Edit> edits;
};

void addOptions(CLI::App& app, ViewOptions& options, Typed& typed) {
  app.add_option("INPUT", options.view.input,
                 std::string("Scenario, volume (.vdb .nvdb .vti .raw .dat), field on tetrahedra (.vtu), .pvd "
                             "or folder of them, ") +
                     "recording (" + interop::recordingEndingsText() +
                     "); without it the window asks for one");
  app::addMeshOptions(app, options.view.mesh, options.view.cells);
  app.add_option(
      "--state", typed.state,
      "View file: camera, colours, time, edits and the rest; options on the command line override it");
  app::addSetOption(app, typed.edits);
  typed.given.addTo(app, {"--size", "--time"});
  app.add_option("--time", typed.time, playback::settingOfKey("time_s").option_help);
  typed.stream.addTo(app, "", "--emitter-database");
  app.add_option("--size", typed.size,
                 "Window size in pixels, WxH; default: 1200x900 times the scale, with --state as large as "
                 "its picture needs");
  app.add_option("--scale", options.scale, "Size of texts and controls; default: that of the screen")
      ->check(CLI::Range(0.5, 4.0))
      ->default_str("");
  app.add_option("--budget", options.controller.budget_ms,
                 "Milliseconds between two pictures while it changes")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--script", options.script, "Script: JSON lines (docs/viewer.md)");
  app.add_option("--log", options.log, "Write the window's log, as JSON lines");
  app.add_flag_callback(
      "--no-share-gpu", [&options] { options.share_gpu = false; },
      "Copy every picture through the host's memory. Otherwise, where CUDA and the display's OpenGL "
      "are on one GPU, pictures stay there while they change");
  app.add_option("--backend", options.backend, "Processor: auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app::addDevicesOption(app, options.devices);
  app.add_option("--threads", options.threads, "Threads to use; 0: one per core")->check(CLI::Range(0, 4096));
  app.add_flag("--quiet,-q", options.quiet, "Only warnings and errors on standard error");
}

/// Refuses options that apply only to an INPUT.
void refuseOptionsOfInput(const CLI::App& app) {
  std::vector<std::string> names{
      "--mesh", "--cells", "--cell-rasterizer", "--cell-order", "--cell-perspective", "--state", "--set"};
  for (const playback::ViewSetting& setting : playback::viewSettings()) names.push_back(setting.option);
  for (const std::string& name : names) {
    const bool needs_none = name.empty() || name == "--size" || name == "--theme" || name == "--rays" ||
                            name == "--allow-missing-terrain";
    if (needs_none || app.count(name) == 0) continue;
    throw Error(ErrorCode::usage, name + " needs INPUT\nTry 'emscape view --help'.");
  }
}

/// @throws Error (usage)
void takeStream(const app::StreamOptions& stream, const CLI::App& app, ViewOptions& options) {
  if (!stream.isGiven()) {
    for (const char* const name :
         {"--interface", "--password", "--emitter-database", "--record", "--force", "--timeout"}) {
      if (app.count(name) > 0)
        throw Error(ErrorCode::usage,
                    std::string(name) + " needs --dis, --acmi or --cot\nTry 'emscape view --help'.");
    }
    return;
  }
  options.stream_request = stream.parse();
  options.stream_request->base = options.view.input;
  if (options.view.input.empty()) {
    throw Error(ErrorCode::usage,
                "--dis, --acmi and --cot need INPUT: a scenario with the region and the terrain, to which "
                "the objects "
                "of the stream are added; any of scenarios/ will do to begin with");
  }
}

/// A UTC time is that of a clock that is known when the input is open. @throws Error (usage)
void takeTime(const std::string& text, playback::ViewState& view) {
  const bool is_utc = parseUtc_ms(text).has_value();
  view.time_utc = is_utc ? text : "";
  view.time_s = is_utc ? playback::ViewState().time_s : scenario::parseTime(text, {});
}

/// Sets the first view: that of --state, or the default one, changed by the given options.
void readView(const Typed& typed, ViewOptions& options) {
  playback::ViewState view;
  if (!typed.state.empty()) {
    view = playback::readViewState(typed.state);
    options.state = typed.state;
    options.window_size.reset();
    options.scales_window = options.fits_labels = false;
  }
  if (!typed.size.empty()) {
    options.window_size = render::parseImageSize(typed.size);
    options.scales_window = false;
  }
  const std::string of_file = playback::viewStateText(view);
  playback::setInput(view, options.view);
  typed.given.apply(view);
  if (!typed.time.empty()) takeTime(typed.time, view);
  if (view.label_scale > 0) options.fits_labels = false;
  view.edits.insert(view.edits.end(), typed.edits.begin(), typed.edits.end());
  if (playback::viewStateText(view) != of_file || !view.transfer_file.empty() || !view.time_utc.empty())
    options.state.clear();
  options.view = view;
}

/// The parser, and the variables it fills.
struct CommandLine {
  CLI::App app{"Shows a scenario or volumes in a window.", "emscape view"};
  ViewOptions options;
  Typed typed;
  bool prints_manual = false;

  CommandLine() {
    app.footer(kFooter);
    app.set_version_flag("--version", std::string("emscape-view ") + EMSCAPE_VERSION);
    app.add_flag("--manual-tables", prints_manual, "Prints the tables of docs/viewer.md")->group("");
    app.option_defaults()->always_capture_default();
    addOptions(app, options, typed);
    app::readWholeNumbersAsDecimal(app);
  }
};

}  // namespace

std::shared_ptr<const CLI::App> viewParser() {
  const auto line = std::make_shared<const CommandLine>();
  return {line, &line->app};
}

std::optional<ViewOptions> parseOptions(int argc, char** argv) {
  CommandLine line;
  try {
    line.app.parse(argc, argv);
    app::checkValues(line.app);
  } catch (const CLI::Success& help) {
    line.app.exit(help);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::usage, app::messageOf(line.app, error) + "\nTry 'emscape view --help'.");
  }
  if (line.prints_manual) {
    std::cout << manualTables();
    return std::nullopt;
  }
  if (line.options.view.input.empty()) refuseOptionsOfInput(line.app);
  takeStream(line.typed.stream, line.app, line.options);
  readView(line.typed, line.options);
  return line.options;
}

}  // namespace emscape::view
