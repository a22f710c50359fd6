/// emscape render: pictures and videos of a scenario or of volumes.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "apps/common/view_arguments.h"
#include "apps/emscape/subcommands.h"
#include "base/files/inputs.h"
#include "base/files/own_file.h"
#include "base/memory.h"
#include "base/stopwatch.h"
#include "base/worker.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/frames/volume_input.h"
#include "playback/pictures/picture_series.h"
#include "playback/pictures/picture_sink.h"
#include "playback/pictures/real_time_loop.h"
#include "playback/series/series_scenario.h"
#include "playback/view/view_file.h"
#include "render/patterns/reconstruction.h"
#include "report/maps/output_files.h"
#include "report/runs/no_value.h"
#include "report/runs/real_time_report.h"
#include "report/warnings.h"

namespace emscape::app {
namespace {

using playback::Display;
using playback::FrameSource;
using playback::Painter;
using playback::PictureSink;
using playback::RealTimeLoop;
using playback::RealTimeOptions;
using playback::ViewState;

struct RenderOptions {
  const CLI::App* command = nullptr;
  ViewState view;       ///< its input and how that is drawn; viewOf() adds the rest
  ViewArguments given;  ///< to the view
  std::vector<scenario::Edit> edits;
  std::string times;
  std::vector<std::string> outputs;
  std::string state;
  std::string save_state;
  std::string interpolate = "float";
  std::optional<double> frames_per_s;
  bool realtime = false;
  double speed = 1;
  std::optional<double> duration_s;
  std::optional<double> epsilon_ms;
  std::optional<double> budget_ms;
  double orbit_rate_deg_s = 0;
  bool verify = false;
  std::string device_volume = "float";
};

/// @throws Error (other) for pictures that do not fit into memory
void requireMemoryOf(const render::ImageSize& size) {
  // Cast; its ground: distance, colour and kind; with annotations, and of 8 bits.
  constexpr std::size_t kBytesPerPixel = 2 * sizeof(render::Rgba) + 5 + 4 + 4;
  requireMemory({fmt::format("a picture of {}x{} pixels", size.width, size.height),
                 static_cast<std::size_t>(size.count()) * kBytesPerPixel, "a smaller --size takes less"},
                {});
}

/// The view to draw: that of --state, or the default one, changed by the given options. They are parsed here,
/// so that errors are reported before anything is computed.
ViewState viewOf(const RenderOptions& options) {
  ViewState view = options.state.empty() ? ViewState{} : playback::readViewState(options.state);
  playback::setInput(view, options.view);
  options.given.apply(view);
  playback::addOwnScenario(view);
  view.edits.insert(view.edits.end(), options.edits.begin(), options.edits.end());
  requireMemoryOf(view.size);
  playback::requireMapFiles(view);
  return view;
}

bool isOnePicture(const std::vector<std::string>& outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    return std::filesystem::path(output).extension() == ".png";
  });
}

playback::FrameSelection selectionOf(const ViewState& view, const RenderOptions& options) {
  playback::FrameSelection selection(view);
  selection.times = options.times;
  if (selection.times.empty() && !options.realtime && isOnePicture(options.outputs)) {
    if (std::isnan(view.time_s)) {
      selection.first_only = true;
    } else {
      selection.times = fmt::format("{}", view.time_s);
    }
  }
  return selection;
}

std::string raysOf(const ViewState& view) {
  return view.pattern ? render::toString(*view.pattern) : "auto";
}

bool drawsTetrahedra(const ViewState& view) {
  return !view.mesh.empty() ||
         (inputExists(view.input) && playback::inputKindOf(view.input) == playback::InputKind::mesh);
}

/// @throws Error (usage) for options without an effect on what is drawn
void checkMeshOptions(const RenderOptions& options, const ViewState& view) {
  const bool has_cells = drawsTetrahedra(view);
  const auto refuseAll = [&](std::initializer_list<const char*> names, const std::string& why) {
    for (const char* name : names) {
      if (options.command->count(name) > 0) throw Error(ErrorCode::usage, name + why);
    }
  };
  if (!has_cells) {
    return refuseAll({"--cells", "--cell-rasterizer", "--cell-order", "--cell-perspective"},
                     ": has no effect on volumes; with --mesh a scenario is computed on tetrahedra");
  }
  render::checkCellSettings(view.settings);
  refuseAll({"--realtime", "--interpolate", "--step", "--mida-gamma", "--iso-value", "--iso-opacity",
             "--device-volume", "--compare"},
            ": has no effect on a field on tetrahedra");
  if (view.pattern && *view.pattern != render::Pattern::full) {
    throw Error(ErrorCode::usage,
                "--rays " + raysOf(view) + ": has no effect on a field on tetrahedra, all pixels are cast");
  }
  if (!view.compare.empty()) throw Error(ErrorCode::usage, "comparison: has no effect on tetrahedra");
}

/// report::checkOutputs(). Scenarios and lists of volumes are read for it only if an output exists already.
void checkOutputFiles(const RenderOptions& options, const ViewState& view) {
  std::vector<report::NamedFile> outputs = report::outputsOf("--output", options.outputs);
  outputs.push_back({"--save-state", options.save_state});
  std::vector<report::NamedFile> inputs{{"the input", view.input},
                                        {"the scenario", view.scenario},
                                        {"the comparison", view.compare},
                                        {"the transfer function", view.transfer_file}};
  std::vector<std::shared_ptr<const scenario::Scenario>> scenarios;
  const auto addSteps = [&](const std::string& file, const char* name) {
    if (!inputExists(file)) return;
    const playback::InputKind kind = playback::inputKindOf(file);
    if (kind != playback::InputKind::volume && kind != playback::InputKind::mesh) return;
    for (const std::filesystem::path& step : playback::stepFilesOf(file))
      inputs.push_back({name, step.string()});
  };
  const auto addScenario = [&](const std::string& file, const std::vector<scenario::Edit>& edits) {
    if (!inputExists(file) || !std::filesystem::is_regular_file(file)) return;
    // --scenario is a scenario whatever its ending.
    if (file != view.scenario && playback::inputKindOf(file) != playback::InputKind::scenario) return;
    if (const auto scenario = scenario::parseScenario(file, edits).scenario) scenarios.push_back(scenario);
  };
  if (std::any_of(outputs.begin(), outputs.end(), [](const report::NamedFile& output) {
        return std::filesystem::is_regular_file(output.file);
      })) {
    addScenario(view.input, view.edits);
    addScenario(view.scenario, {});
    addScenario(view.compare, {});
    addSteps(view.input, "a file of the input");
    addSteps(view.compare, "a file of the comparison");
  }
  report::checkOutputs(outputs, inputs, scenarios);
}

using Sinks = std::vector<std::unique_ptr<PictureSink>>;

Sinks openSinks(const RenderOptions& options, const ViewState& view, const FrameSource& source, int pictures,
                double frames_per_s) {
  const std::string changes = source.scene() != nullptr ? changesOf(*source.scene()->scenario) : "";
  Sinks sinks;
  for (const std::string& output : options.outputs) {
    sinks.push_back(
        playback::makePictureSink(output, source.name(), pictures, view.size, frames_per_s, changes));
  }
  return sinks;
}

/// The source and the painter, with the first frame set.
struct Stage {
  ComputeTarget target;
  std::unique_ptr<FrameSource> source;
  std::unique_ptr<Painter> painter;
  std::optional<playback::ValueRange> range;  ///< of the searched steps of the series
  std::string empty_quantity;                 ///< if no voxel of these steps is above the floor
  playback::Film film;
};

constexpr double kFilmRate = 10;

/// Pictures per second of a video among the outputs.
std::optional<double> filmRate(const RenderOptions& options) {
  const bool has_video = std::any_of(
      options.outputs.begin(), options.outputs.end(),
      [](const std::string& output) { return std::filesystem::path(output).extension() == ".mp4"; });
  return has_video ? std::optional(options.frames_per_s.value_or(kFilmRate)) : std::nullopt;
}

/// @throws Error (usage) that lists the platforms
void checkFollowed(const ViewState& view, const playback::LoadedScenario* scene) {
  if (view.follow.empty()) return;
  std::vector<std::string> names;
  if (scene != nullptr) {
    for (const scenario::Platform& platform : scene->scenario->platforms) names.push_back(platform.name);
  }
  if (std::find(names.begin(), names.end(), view.follow) != names.end()) return;
  throw Error(ErrorCode::usage,
              fmt::format("--follow '{}': there is no such platform; there are {}", view.follow,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

Stage openStage(const ViewState& view, const RenderOptions& options, const GlobalOptions& global) {
  const bool must_show_isosurface =
      options.command->count("--iso-value") > 0 && !options.realtime && isOnePicture(options.outputs);
  for (const std::string& output : options.outputs) playback::checkPictureOutput(output);
  return openOnTarget(global, options.device_volume, [&](const ComputeTarget& target) {
    Stage stage{
        target,
        playback::openFrameSource(selectionOf(view, options), target, progressSink(global), &stopFlag()),
        nullptr,
        {},
        {},
        {}};
    stage.painter = std::make_unique<Painter>(view, *stage.source, target, must_show_isosurface);
    checkFollowed(view, stage.source->scene());
    if (!options.realtime) {
      stage.film = playback::filmOf(view, *stage.source, filmRate(options));
      stage.painter->setSpeed(stage.film.speed);
    }
    const playback::Frame frame = stage.source->frame(0);
    stage.painter->setFrame(frame);
    const playback::ValueRange range = render::colorRangeOf(frame.info(), frame.color_range);
    if (range.min < range.max) stage.range = range;
    if (range.max <= frame.info().floor && !frame.info().categorical)
      stage.empty_quantity = frame.info().quantity;
    return stage;
  });
}

/// Warns about a scenario's field without any value.
void warnOfNoValue(const ViewState& view, const Stage& stage) {
  const playback::LoadedScenario* scene = stage.source->scene();
  const bool is_computed = scene != nullptr && inputExists(view.input) &&
                           playback::inputKindOf(view.input) == playback::InputKind::scenario;
  if (stage.empty_quantity.empty() || !is_computed || !view.compare.empty()) return;
  std::vector<double> times_s;
  for (int n = 0; n < stage.source->count(); ++n) times_s.push_back(stage.source->time_s(n));
  logWarning(report::noValueWarning(stage.empty_quantity, *scene->scenario, times_s));
}

/// Warnings of the scenario's check and of the fields, for JSON.
std::vector<std::string> warningsOf(const Stage& stage) {
  const playback::LoadedScenario* scene = stage.source->scene();
  std::vector<std::string> warnings;
  if (scene != nullptr) warnings = scenario::warningsOf(*scene->scenario);
  for (const std::string& warning : stage.source->warnings()) warnings.push_back(warning);
  return report::joinedWarnings(warnings);
}

/// Writes the file of --save-state: the view, with the colours fitted to the first frame.
void saveState(const RenderOptions& options, ViewState view, const Stage& stage) {
  if (options.save_state.empty()) return;
  view.time_s = stage.source->time_s(0);
  view.transfer = stage.painter->transferFunction();
  view.range = stage.range;
  const playback::LoadedScenario* scene = stage.source->scene();
  view.edits = scene != nullptr ? scene->scenario->edits() : std::vector<scenario::Edit>{};
  requireOwn(options.save_state);  // it may have come during the work
  playback::writeViewState(options.save_state, view);
  logInfo("wrote " + options.save_state);
}

/// Report on the cells of the last picture.
Json cellsJson(const playback::CellPicture& picture) {
  Json json{{"drawn", picture.text()}};
  if (picture.projected) {
    json.update({{"device", picture.device},
                 {"tetrahedra", picture.cells},
                 {"cycles", picture.cycles},
                 {"sent_bytes", picture.sent_bytes}});
  }
  return json;
}

int renderPictures(const RenderOptions& options, const GlobalOptions& global) {
  if (options.outputs.empty() && options.save_state.empty()) {
    throw Error(ErrorCode::usage, "--output is required (but for --realtime and --save-state)");
  }
  const ViewState view = viewOf(options);
  checkMeshOptions(options, view);
  checkOutputFiles(options, view);
  const std::string mode = render::toString(view.settings.mode);
  // `auto` casts every pixel for files.
  render::FramePlan plan = render::FramePlan::exact();
  plan.pattern = view.pattern.value_or(render::Pattern::full);
  plan.interpolation = render::parseInterpolation(options.interpolate);
  const Stage stage = openStage(view, options, global);
  const std::unique_ptr<FrameSource>& source = stage.source;
  Painter& painter = *stage.painter;
  const Sinks sinks =
      openSinks(options, view, *source, source->count(), options.frames_per_s.value_or(kFilmRate));
  saveState(options, view, stage);
  warnOfNoValue(view, stage);
  if (options.outputs.empty()) return 0;

  logInfo(fmt::format("drawing {} picture{} of {}x{} into {}", source->count(),
                      source->count() == 1 ? "" : "s", view.size.width, view.size.height,
                      fmt::join(options.outputs, ", ")));
  Stopwatch watch;
  double cast_ms = 0;
  {
    Progress progress(global, "drawing");
    cast_ms = playback::drawPictures(
        *source, painter, plan, sinks, stage.film,
        [&](int pictures) { progress.show(static_cast<double>(pictures) / source->count()); }, &stopFlag());
  }
  report::logWarnings(source->warnings());

  const double seconds = watch.lap_ms() / 1000;
  if (global.json) {
    Json json{{"device", stage.target.device()},
              {"size", {view.size.width, view.size.height}},
              {"mode", mode},
              {"frames", source->count()},
              {"outputs", options.outputs},
              {"cast_ms", cast_ms},
              {"seconds", seconds},
              {"warnings", warningsOf(stage)}};
    if (painter.cellPicture()) json["cells"] = cellsJson(*painter.cellPicture());
    printJson(json);
  } else {
    logInfo(fmt::format("{} picture{} in {:.1f} s: {}", source->count(), source->count() == 1 ? "" : "s",
                        seconds, fmt::format("{}", fmt::join(options.outputs, ", "))));
  }
  return 0;
}

/// @param keeps_events  for --json, which reports each frame
RealTimeOptions realTimeOptionsOf(const RenderOptions& options, const ViewState& view, bool keeps_events) {
  RealTimeOptions loop;
  constexpr double kBudget_ms = 40;  // the paper's limit for real time
  loop.frames_per_s = options.frames_per_s.value_or(1000 / options.budget_ms.value_or(kBudget_ms));
  loop.speed = options.speed;
  loop.duration_s = options.duration_s;
  loop.orbit_rate_deg_s = options.orbit_rate_deg_s;
  loop.whole_fields = view.pattern == render::Pattern::full;
  loop.verify = options.verify;
  loop.keep_events = keeps_events;
  loop.controller.pattern = view.pattern;
  loop.controller.interpolation = render::parseInterpolation(options.interpolate);
  loop.controller.budget_ms = options.budget_ms.value_or(1000 / loop.frames_per_s);
  loop.controller.epsilon_ms = options.epsilon_ms;
  return loop;
}

int playInRealTime(const RenderOptions& options, const GlobalOptions& global) {
  const ViewState view = viewOf(options);
  checkMeshOptions(options, view);
  checkOutputFiles(options, view);
  const RealTimeOptions loop_options = realTimeOptionsOf(options, view, global.json);
  if (loop_options.orbit_rate_deg_s != 0 && view.camera.kind != render::CameraSpec::Kind::orbit) {
    throw Error(ErrorCode::usage, "--orbit-rate: the camera must be an orbit");
  }
  const Stage stage = openStage(view, options, global);
  saveState(options, view, stage);
  const std::unique_ptr<FrameSource>& source = stage.source;
  const Sinks sinks = openSinks(options, view, *source, playback::kAnyNumber, loop_options.frames_per_s);

  // Enough for delays of the encoder.
  constexpr long long kWaitingBytes = 256LL << 20;
  Worker writer(static_cast<std::size_t>(std::max(2LL, kWaitingBytes / (4 * view.size.count()))));
  int number = 0;
  Display display;
  if (!sinks.empty()) {
    display = [&](const render::Image8& picture, int slots) {
      writer.push([&sinks, picture, slots, n = ++number, work = currentWork()] {
        const WorkScope scope(work);
        for (const auto& sink : sinks) sink->add(n, picture, slots);
      });
    };
  }
  playback::SystemClock clock;
  RealTimeLoop loop(loop_options, view, *source, *stage.painter, display, clock, &stopFlag());
  const report::RealTimeReport report =
      loop.play([](const report::RealTimeEvent& event) { logInfo(report::lineOf(event)); });
  writer.finish();
  playback::finishAll(sinks);
  report::logWarnings(source->warnings());

  logInfo(report::summaryOf(report));
  if (global.json) {
    Json json{{"device", stage.target.device()},
              {"size", {view.size.width, view.size.height}},
              {"mode", render::toString(view.settings.mode)},
              {"rays", raysOf(view)},
              {"outputs", options.outputs},
              {"budget_ms", loop_options.controller.budget_ms},
              {"warnings", warningsOf(stage)}};
    json.update(report::toJson(report));
    printJson(json);
  }
  if (report.totals.unequal() > 0) {
    throw Error(ErrorCode::check_failed, fmt::format("{} of {} settled pictures differ from a full cast",
                                                     report.totals.unequal(), report.totals.settled));
  }
  return 0;
}

/// Adds the options that need --realtime.
void addRealTimeOptions(CLI::App& command, RenderOptions& options) {
  CLI::Option* realtime = command.add_flag(
      "--realtime", options.realtime,
      "Play in real time, without a window: interpolated while the picture changes, exact when it is still");
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->needs(realtime);
  };
  add("--speed", options.speed, "Scenario seconds per second")->check(CLI::Range(1e-3, 1e3));
  add("--duration", options.duration_s, "Seconds of playing; default: the whole series")
      ->check(CLI::Range(0.0, 1e6));
  add("--budget", options.budget_ms, "Milliseconds between two pictures; default: from --fps, else 40")
      ->check(CLI::Range(1.0, 1e5));
  add("--epsilon", options.epsilon_ms,
      "Milliseconds without a change before the picture is made exact; default: measured")
      ->check(CLI::Range(0.0, 1e6));
  add("--orbit-rate", options.orbit_rate_deg_s, "Rotation of the camera (degrees per second)")
      ->check(CLI::Range(-360.0, 360.0));
  command
      .add_flag("--verify", options.verify,
                "Compare each settled picture with a full cast; status 5 if one differs")
      ->needs(realtime);
}

}  // namespace

void addRender(CLI::App& app, const GlobalOptions& global, Action& action) {
  CLI::App* command = app.add_subcommand("render", "Draw a scenario or volumes: pictures, video");
  command->fallthrough();
  command->footer(R"(
A scenario is computed and drawn without intermediate files. For volumes, --scenario adds the ground and the emitters of their
scenario. Fields on tetrahedra are drawn by dvr; there is no sampling step.

Examples:
  emscape render scenarios/jacksboro.yaml -o now.png --times 30
  emscape render scenarios/jacksboro.yaml -o now.png --state jacksboro.view.json --size 3840x2160
  emscape render scenarios/jacksboro.yaml -o film.mp4 -o frames --times 0:120:0.5 --camera orbit:azimuth_deg=200
  emscape render scenarios/jacksboro.yaml -o cut.png --plane vertical:bearing_deg=60 --plane horizontal:altitude_m=3000
  emscape render out/jacksboro.pvd -o film.mp4 --scenario scenarios/jacksboro.yaml
  emscape render engine_256x256x110_uint8.raw -o engine.png --mode mida
  emscape render scenarios/jacksboro.yaml -o mesh.png --mesh terrain:32,4
  emscape render out/jacksboro_0001.vtu -o mesh.png --scenario scenarios/jacksboro.yaml --cells project
  emscape render scenarios/jacksboro.yaml --realtime --size 1200x900 --fps 25 --orbit-rate 10)");
  auto options = std::make_shared<RenderOptions>();
  options->command = command;
  command
      ->add_option(
          "INPUT", options->view.input,
          "Scenario, volume (.vdb .nvdb .vti .raw .dat), field on tetrahedra (.vtu), .pvd or folder of them")
      ->required();
  addSetOption(*command, options->edits);
  command->add_option(
      "--state", options->state,
      "View file: camera, colours, time, edits and the rest; options on the command line override it");
  command->add_option("--save-state", options->save_state,
                      "Write the view as a view file; --output may then be omitted");
  command->add_option("-o,--output", options->outputs,
                      "NAME.png, NAME.mp4 or a folder for frames; may be given several times");
  options->given.addTo(*command, {"--time"});
  command->add_option("--interpolate", options->interpolate, "Precision of interpolated pixels")
      ->check(CLI::IsMember({"float", "8bit"}));
  command->add_option(
      "--times,--time", options->times,
      "BEGIN:END:STEP, BEGIN:END or T, in seconds or UTC; default: all steps; if the only output is "
      "a .png, the first at which an emitter is present");
  command
      ->add_option("--fps", options->frames_per_s,
                   "Frames per second of a video (default 10); with --realtime: the maximum")
      ->check(CLI::Range(0.1, 240.0));
  addMeshOptions(*command, options->view.mesh, options->view.cells);
  addDeviceVolumeOption(*command, options->device_volume);
  addRealTimeOptions(*command, *options);
  command->callback([options, &global, &action] {
    action = [options, &global] {
      return options->realtime ? playInRealTime(*options, global) : renderPictures(*options, global);
    };
  });
}

}  // namespace emscape::app
