/// emscape bench view: response times of the window.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "apps/bench/bench.h"
#include "apps/bench/bench_statistics.h"
#include "apps/bench/view_trial.h"
#include "apps/common/sibling_program.h"
#include "base/files/file_reading.h"
#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/clock.h"

namespace emscape::app {
namespace {

namespace fs = std::filesystem;

struct BenchViewOptions {
  std::string input;
  std::vector<scenario::Edit> edits;
  std::string size = "1200x900";
  double idle_s = 10;
  bool share_gpu = true;
  std::string log;  ///< file for the log; empty: not kept
};

/// A temporary folder, removed with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "emscape-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error(ErrorCode::other, name + ": cannot be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

ViewTrial trialOf(const BenchViewOptions& options) {
  ViewTrial trial;
  trial.idle_s = options.idle_s;
  const render::ImageSize size = render::parseImageSize(options.size);
  trial.width = size.width;
  trial.height = size.height;
  if (playback::inputKindOf(options.input) != playback::InputKind::scenario) return trial;
  const auto scenario = scenario::loadScenario(options.input, options.edits);
  trial.times_s = scenario::timesOf(scenario->clock);
  const scenario::Emitter& emitter = scenario->emitters.front();
  trial.edit = scenario::Edit{"emitters." + scenario::pathStep(emitter.name) + ".power_w", ""};
  trial.edit_value = emitter.power_w;
  return trial;
}

double quantileOf(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(part * static_cast<double>(values.size())))];
}

/// Null if nothing was measured.
Json medianJson(const std::vector<double>& values) {
  return values.empty() ? Json() : Json(medianOf(values));
}

Json framesJson(const std::vector<double>& values) {
  if (values.empty()) return {};
  return {{"median", medianOf(values)}, {"p99", quantileOf(values, 0.99)}, {"max", quantileOf(values, 1)}};
}

/// Processes that ran or waited for a processor, in the mean of the last minute, with those of the benchmark.
double load() {
  double average = 0;
  return getloadavg(&average, 1) == 1 ? average : 0;
}

Json jsonOf(const ViewTimes& times) {
  return {{"device", times.device},
          {"gl_renderer", times.gl_renderer},
          {"shares_gpu", times.shares_gpu},
          {"size", fmt::format("{}x{}", times.width, times.height)},
          {"first_picture_ms", times.first_picture_ms},
          {"first_exact_ms", times.first_exact_ms},
          {"ui_ms", framesJson(times.ui)},
          {"ui_computing_ms", framesJson(times.ui_computing)},
          {"frame_ms", framesJson(times.frame)},
          {"frame_computing_ms", framesJson(times.frame_computing)},
          {"interface_fps", times.interface_fps},
          {"orbit_fps", times.orbit_fps},
          {"input_to_picture_ms", medianJson(times.input_to_picture)},
          {"input_to_exact_ms", medianJson(times.input_to_exact)},
          {"abort_latency_ms", medianJson(times.abort)},
          {"abort_latency_max_ms", times.abort.empty() ? Json() : Json(quantileOf(times.abort, 1))},
          {"edit_to_picture_ms", medianJson(times.edit_to_picture)},
          {"edit_to_exact_ms", medianJson(times.edit_to_exact)},
          {"seek_ms", medianJson(times.seek)},
          {"seek_field_ms", medianJson(times.seek_field)},
          {"seek_cached_ms", medianJson(times.seek_cached)},
          {"seeks", times.seek_count},
          {"seeks_fields_computed", times.seek_fields},
          {"seeks_last_shown", times.seek_last_shown},
          {"play_fields_per_s", times.play_fields_per_s},
          {"play_edit_to_picture_ms", medianJson(times.play_edit_to_picture)},
          {"idle_cpu_percent", times.idle_cpu_percent},
          {"rss_mib", times.rss_mib},
          {"load", load()}};
}

void printTable(const ViewTimes& times) {
  const auto row = [](const char* name, const std::string& value) { print("{:<52} {}\n", name, value); };
  const auto median = [&](const char* name, const std::vector<double>& values) {
    if (!values.empty()) row(name, fmt::format("{:.1f} ms", medianOf(values)));
  };
  const auto frames = [&](const char* name, const std::vector<double>& values) {
    if (values.empty()) return;
    row(name, fmt::format("{:.1f} / {:.1f} / {:.1f} ms", medianOf(values), quantileOf(values, 0.99),
                          quantileOf(values, 1)));
  };
  print("{}, {}; picture {}x{}, {}\n\n", times.device, times.gl_renderer, times.width, times.height,
        times.shares_gpu ? "from CUDA to OpenGL on the GPU" : "copied through the host's memory");
  row("start to first picture / exact",
      fmt::format("{:.0f} / {:.0f} ms", times.first_picture_ms, times.first_exact_ms));
  frames("user interface: median / 99 % / max of a frame", times.ui);
  frames("  while a field is computed", times.ui_computing);
  frames("  with the display", times.frame);
  frames("  with the display, while a field is computed", times.frame_computing);
  row("cursor over the panels: frames in a second", fmt::format("{:.1f}", times.interface_fps));
  row("orbit: pictures in a second", fmt::format("{:.1f}", times.orbit_fps));
  median("input to its first picture", times.input_to_picture);
  median("last input to exact", times.input_to_exact);
  median("input in RESTORE to the next frame's begin", times.abort);
  median("power changed to picture with the new field", times.edit_to_picture);
  median("power changed to exact", times.edit_to_exact);
  median("seek, step not cached", times.seek);
  median("  of that the field", times.seek_field);
  median("seek, step cached", times.seek_cached);
  if (times.seek_count > 0) {
    row(fmt::format("{} seeks in 2 s: fields computed", times.seek_count).c_str(),
        fmt::format("{}, the last one {}", times.seek_fields, times.seek_last_shown ? "shown" : "NOT SHOWN"));
  }
  if (times.play_fields_per_s > 0)
    row("playing at x1: different fields in a second", fmt::format("{:.1f}", times.play_fields_per_s));
  median("power changed while playing to picture with it", times.play_edit_to_picture);
  row("idle: of one core", fmt::format("{:.2f} %", times.idle_cpu_percent));
  row("resident memory", fmt::format("{:.0f} MiB", times.rss_mib));
  row("load of the machine, of the last minute", fmt::format("{:.1f}", load()));
}

int benchView(const BenchViewOptions& options, const GlobalOptions& global) {
  const ScratchFolder folder;
  const std::string script = folder.path() / "script.jsonl";
  const std::string log = options.log.empty() ? std::string(folder.path() / "log.jsonl") : options.log;
  writeWhole(script, [&](std::ostream& out) { out << trialScript(trialOf(options)); });
  std::vector<std::string> arguments{options.input, "--size", options.size, "--scale", "1",
                                     "--script",    script,   "--log",      log};
  if (!options.share_gpu) arguments.emplace_back("--no-share-gpu");
  for (const scenario::Edit& edit : options.edits)
    arguments.insert(arguments.end(), {"--set", scenario::toString(edit)});
  runSibling(kViewProgram, global, arguments);
  const ViewTimes times = trialTimes(readWholeText(log));
  if (global.json) {
    printJson(jsonOf(times));
  } else {
    printTable(times);
  }
  return 0;
}

}  // namespace

void addBenchView(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("view", "Measure the window's response times");
  command->fallthrough();
  command->footer(R"(
Opens the window on the display and runs a script of half a minute to some minutes: a turning camera, single inputs, inputs
during a restoration, a change of the first emitter's power, seeking, playing, an idle phase. All times are from the window's log (--log): from
the input to the frame that shows it. A frame of the user interface: its events, panels and drawing commands; "with the display":
until the display, or the software renderer, has finished.

Example:
  emscape bench view scenarios/jacksboro.yaml)");
  auto options = std::make_shared<BenchViewOptions>();
  command->add_option("INPUT", options->input, "Scenario or volumes")->required();
  addSetOption(*command, options->edits);
  command->add_option("--size", options->size, "Size of the window, WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--idle", options->idle_s, "Seconds of the idle phase")
      ->check(CLI::Range(1.0, 600.0))
      ->capture_default_str();
  command->add_flag_callback(
      "--no-share-gpu", [options] { options->share_gpu = false; }, "As of 'emscape view'");
  command->add_option("--log", options->log, "Write the window's log to this file");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return benchView(*options, global); }; });
}

}  // namespace emscape::app
