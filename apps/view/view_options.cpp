#include "apps/view/view_options.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/emscape/command.h"
#include "apps/emscape/value_range.h"
#include "apps/view/action.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr const char* kFooter = R"(
The window shows the picture while it changes, interpolated if need be, and makes it exact as soon as it stands still.
F1 lists keys and mouse; --script runs the same actions without hands.

Examples:
  emscape view scenarios/jacksboro.yaml
  emscape view out/jacksboro.pvd --scenario scenarios/jacksboro.yaml --scale 2
  emscape view scenarios/jacksboro.yaml --set emitters.jammer.power_w=500 --script tour.jsonl --log tour.log

Exit status: 0 done, 2 usage, 3 bad input, 4 no window or device, 5 an expectation of the script was not met.)";

/// Options as they are typed.
struct Typed {
  std::string size = "1200x900", mode = "dvr", rays = "auto", camera = "orbit", range, theme = "dark";
  double budget_ms = 40;
};

void addOptions(CLI::App& app, ViewOptions& options, Typed& typed) {
  playback::PictureStyle& style = options.style;
  app.add_option("INPUT", options.input,
                 "Scenario, volume (.vdb .nvdb .vti .raw .dat), .pvd or folder of volumes")
      ->required();
  app.add_option("--scenario", options.scenario, "Scenario whose ground and emitters are drawn with volumes");
  app::addSetOption(app, options.edits);
  app.add_option("--size", typed.size, "Window size in pixels, WxH");
  app.add_option("--scale", options.scale, "Size of texts and controls; default: that of the screen")
      ->check(CLI::Range(0.5, 4.0));
  app.add_option("--time", options.time_s, "Shown first, in seconds");
  app.add_option("--quantity", options.quantity, "Quantity or channel to draw; default: the first");
  app.add_option("--mode", typed.mode, "How samples become a pixel")
      ->check(CLI::IsMember({"dvr", "mida", "mip", "iso"}));
  app.add_option("--camera", typed.camera, "orbit:azimuth_deg=..,.. or lookat:eye_x_m=..,..");
  app.add_option("--range", typed.range, "MIN:MAX of the colours; default: fitted to the first step");
  app.add_option("--transfer", style.transfer, "Colours and opacities (JSON); default: fitted");
  app.add_option("--theme", typed.theme, "Colours of texts and background")
      ->check(CLI::IsMember({"dark", "light"}));
  app.add_option("--rays", typed.rays,
                 "Pixels that are cast while the picture changes; auto: as the budget allows")
      ->check(CLI::IsMember({"auto", "full", "columns", "checkerboard", "quarter", "adaptive"}));
  app.add_option("--budget", typed.budget_ms, "Milliseconds between two pictures while it changes")
      ->check(CLI::Range(1.0, 1e5));
  app.add_option("--exaggeration", style.settings.vertical_exaggeration,
                 "Vertical exaggeration; 0: chosen from the box")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--step", style.settings.step_voxels, "Distance of samples, in voxels")
      ->check(CLI::Range(0.05, 10.0));
  app.add_flag("--shading", style.settings.shading, "Light on the fog");
  app.add_flag("--allow-missing-terrain", options.allow_missing_terrain,
               "Compute although elevation data is missing; the holes are drawn as such");
  app.add_option("--script", options.script, "JSON lines: what to do and when (docs/viewer.md)");
  app.add_option("--log", options.log, "Writes what happens, as JSON lines");
  app.add_option("--backend", options.backend, "Where to compute: auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  app.add_option("--threads", options.threads, "Threads to use; 0: one per core")->check(CLI::Range(0, 4096));
  app.add_flag("--quiet,-q", options.quiet, "Only warnings and errors on standard error");
}

}  // namespace

std::optional<ViewOptions> parseOptions(int argc, char** argv) {
  ViewOptions options;
  Typed typed;
  CLI::App app("Shows a scenario or volumes in a window.", "emscape view");
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("emscape-view ") + EMSCAPE_VERSION);
  bool prints_manual = false;
  app.add_flag("--manual-tables", prints_manual, "Prints the tables of docs/viewer.md")->group("");
  app.option_defaults()->always_capture_default();
  addOptions(app, options, typed);
  app.get_option("INPUT")->required(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    app.exit(help);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorCode::usage, std::string(error.what()) + "\nTry 'emscape view --help'.");
  }
  if (prints_manual) {
    std::cout << manualTables();
    return std::nullopt;
  }
  if (options.input.empty()) throw Error(ErrorCode::usage, "INPUT is required\nTry 'emscape view --help'.");
  options.window_size = render::parseImageSize(typed.size);
  options.style.camera = render::parseCamera(typed.camera);
  options.style.theme = render::parseTheme(typed.theme);
  options.style.settings.mode = render::parseCompositingMode(typed.mode);
  if (typed.rays != "auto") options.controller.pattern = render::parsePattern(typed.rays);
  options.controller.budget_ms = typed.budget_ms;
  if (!typed.range.empty()) options.range = app::parseRange(typed.range);
  return options;
}

}  // namespace emscape::view
