#include "apps/view/session/view_options.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/common/arguments.h"
#include "apps/common/command.h"
#include "apps/common/value_range.h"
#include "apps/view/session/action.h"
#include "apps/view/view_parser.h"
#include "emscape/base/error.h"

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
  emscape view scenarios/jacksboro.yaml --set emitters.jammer.power_w=500 --script tour.jsonl --log tour.log

Exit status: 0 done, 2 usage, 3 bad input, 4 no window or device, 5 an expectation of the script was not met.)";

/// Parsed options. Those that are also part of a view have an effect only if they are given.
struct Typed {
  std::string state, size, mode, rays = "auto", camera, range, theme, quantity;
  double time_s = 0, exaggeration = 0, step_voxels = render::RenderSettings{}.step_voxels, budget_ms = 40;
  bool shading = false;
  std::vector<scenario::Edit> edits;
  std::string compare;
  std::vector<render::CutPlane> planes;
};

void addOptions(CLI::App& app, ViewOptions& options, Typed& typed) {
  app.add_option(
      "INPUT", options.input,
      "Scenario, volume (.vdb .nvdb .vti .raw .dat), field on tetrahedra (.vtu), .pvd or folder of them; "
      "without it the window asks for one");
  app.add_option("--scenario", options.scenario, "Scenario of the ground and emitters to draw with volumes");
  app::addMeshOptions(app, options.mesh, options.cells);
  app.add_option(
      "--state", typed.state,
      "View file: camera, colours, time, edits and the rest; options on the command line override it");
  app::addSetOption(app, typed.edits);
  app::addCompareOption(app, typed.compare, "Show first");
  app.add_option("--size", typed.size,
                 "Window size in pixels, WxH; default: 1200x900, with --state as large as its picture needs");
  app.add_option("--scale", options.scale, "Size of texts and controls; default: that of the screen")
      ->check(CLI::Range(0.5, 4.0))
      ->default_str("");
  app.add_option("--time", typed.time_s, "First instant, in seconds");
  app.add_option("--quantity", typed.quantity, "Quantity or channel to draw; default: the first");
  app.add_option("--mode", typed.mode, "Compositing mode; default: dvr")
      ->check(CLI::IsMember({"dvr", "mida", "mip", "iso"}));
  app.add_option("--camera", typed.camera, "orbit:azimuth_deg=..,.. or lookat:eye_x_m=..,..; default: orbit");
  app.add_option("--range", typed.range, "MIN:MAX of the colours; default: fitted to the first step");
  app.add_option("--transfer", options.transfer, "Colours and opacities (JSON); default: fitted");
  app.add_option("--theme", typed.theme, "Colours of texts and background; default: dark")
      ->check(CLI::IsMember({"dark", "light"}));
  app.add_option("--rays", typed.rays, "Pixels to cast while the picture changes; auto: as the budget allows")
      ->check(CLI::IsMember({"auto", "full", "columns", "checkerboard", "quarter", "adaptive"}));
  app.add_option("--budget", typed.budget_ms, "Milliseconds between two pictures while it changes")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--exaggeration", typed.exaggeration, "Vertical exaggeration; 0: chosen from the box")
      ->check(app::within(render::kExaggerationLimits));
  app::addPlaneOption(app, typed.planes);
  app.add_option("--step", typed.step_voxels, "Distance between samples, in voxels")
      ->check(app::within(render::kStepLimits));
  app.add_flag("--shading", typed.shading, "Shading of dvr and mida; iso is always shaded");
  app.add_flag("--allow-missing-terrain", options.allow_missing_terrain,
               "Compute although elevation data is missing; voxels over holes are masked");
  app.add_option("--script", options.script, "Script: JSON lines (docs/viewer.md)");
  app.add_option("--log", options.log, "Write the window's log, as JSON lines");
  app.add_flag_callback(
      "--no-share-gpu", [&options] { options.share_gpu = false; },
      "Copy every picture through the host's memory. Otherwise, where CUDA and the display's OpenGL "
      "are on one GPU, pictures stay there while they change");
  app.add_option("--backend", options.backend, "Processor: auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--threads", options.threads, "Threads to use; 0: one per core")->check(CLI::Range(0, 4096));
  app.add_flag("--quiet,-q", options.quiet, "Only warnings and errors on standard error");
}

/// Refuses options that apply only to an INPUT.
void refuseOptionsOfInput(const CLI::App& app) {
  for (const char* name :
       {"--scenario", "--mesh", "--cells", "--cell-rasterizer", "--cell-order", "--cell-perspective",
        "--state", "--set", "--compare", "--time", "--quantity", "--mode", "--camera", "--range",
        "--transfer", "--exaggeration", "--plane", "--step", "--shading"}) {
    if (app.count(name) == 0) continue;
    throw Error(ErrorCode::usage, std::string(name) + " needs INPUT\nTry 'emscape view --help'.");
  }
}

/// Sets the first view: that of --state, or the default one, changed by the given options.
void readView(const CLI::App& app, const Typed& typed, ViewOptions& options) {
  playback::ViewState& view = options.view;
  if (!typed.state.empty()) {
    view = playback::readViewState(typed.state);
    options.state = typed.state;
    options.window_size.reset();
  }
  if (!typed.size.empty()) options.window_size = render::parseImageSize(typed.size);
  const auto take = [&](const char* name, const auto& change) {
    if (app.count(name) == 0) return;
    change();
    options.state.clear();  // the view differs from the file
  };
  take("--camera", [&] { view.camera = render::parseCamera(typed.camera); });
  take("--theme", [&] { view.theme = render::parseTheme(typed.theme); });
  take("--time", [&] { view.time_s = typed.time_s; });
  take("--quantity", [&] { playback::changeQuantity(view, typed.quantity); });
  take("--compare", [&] { playback::changeComparison(view, typed.compare); });
  take("--range", [&] { playback::changeRange(view, app::parseRange(typed.range)); });
  take("--transfer", [&] { view.transfer.reset(); });
  take("--mode", [&] { view.settings.mode = render::parseCompositingMode(typed.mode); });
  take("--step", [&] { view.settings.step_voxels = typed.step_voxels; });
  take("--exaggeration", [&] { view.settings.vertical_exaggeration = typed.exaggeration; });
  take("--plane", [&] { view.settings.planes = typed.planes; });
  take("--shading", [&] { view.settings.shading = typed.shading; });
  take("--set", [&] { view.edits.insert(view.edits.end(), typed.edits.begin(), typed.edits.end()); });
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
  if (line.options.input.empty()) refuseOptionsOfInput(line.app);
  readView(line.app, line.typed, line.options);
  if (line.typed.rays != "auto") line.options.controller.pattern = render::parsePattern(line.typed.rays);
  line.options.controller.budget_ms = line.typed.budget_ms;
  return line.options;
}

}  // namespace emscape::view
