/// emscape bench render: time of one frame.
#include <fmt/core.h>

#include <memory>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_scene.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/interrupt.h"
#include "report/maps/output_files.h"

namespace emscape::app {
namespace {

struct BenchRenderOptions {
  BenchSceneOptions scene;
  std::string rays = "full";
  std::string interpolate = "float";
  double tolerance_levels = render::kDefaultTolerance_levels;
  std::string picture;
  int frames = 20;
};

int benchRender(const BenchRenderOptions& options, const GlobalOptions& global) {
  const render::FramePlan plan{render::parsePattern(options.rays),
                               render::parseInterpolation(options.interpolate), options.tolerance_levels};
  report::checkOutputs(
      {{"--picture", options.picture}},
      {{"the input", options.scene.selection.input}, {"the transfer function", options.scene.transfer}}, {});
  const std::unique_ptr<BenchScene> opened = openBenchScene(options.scene, global);
  BenchScene& scene = *opened;
  render::FrameReport report;
  scene.draw(plan, report);  // warm up
  std::vector<double> times_ms, wall_ms, cpu_ms;
  for (int frame = 0; frame < options.frames; ++frame) {
    stopIfInterrupted();
    scene.turnTo(0);
    const Duration duration = scene.draw(plan, report);
    times_ms.push_back(duration.ms);
    wall_ms.push_back(duration.wall_ms);
    cpu_ms.push_back(duration.cpu_ms);
  }
  if (!options.picture.empty()) writeOnBlack(options.picture, scene.image());

  const render::RayLoad load = scene.loadOf(render::sourceLattices(render::Pattern::full, scene.size()));
  const double gsamples_per_s = static_cast<double>(load.samples) / medianOf(times_ms) / 1e6;
  if (global.json) {
    Json result = scene.json();
    result.update({{"pattern", options.rays},
                   {"interpolate", options.interpolate},
                   {"frames", options.frames},
                   {"rays", report.rays},
                   {"rays_in_box", load.rays},
                   {"samples", load.samples},
                   {"samples_taken", report.samples},
                   {"ms", spreadJson(times_ms)},
                   {"wall_ms", spreadJson(wall_ms)},
                   {"cpu_ms", spreadJson(cpu_ms)},
                   {"gsamples_per_s", gsamples_per_s}});
    printJson(result);
    return 0;
  }
  print("{}\n{} rays, median of {} frames of one view\n\n", scene.summary(), options.rays, options.frames);
  print("frame (ms)   median {:.2f}, min {:.2f}, max {:.2f}; of all threads' time {:.2f}\n",
        medianOf(times_ms), *std::min_element(times_ms.begin(), times_ms.end()),
        *std::max_element(times_ms.begin(), times_ms.end()), medianOf(cpu_ms));
  print("rays         {} cast; of a full picture {} meet the volume\n", report.rays, load.rays);
  print("samples      {:.1f} million of a full picture, {:.1f} million taken: {:.3f} G/s\n",
        static_cast<double>(load.samples) / 1e6, static_cast<double>(report.samples) / 1e6, gsamples_per_s);
  return 0;
}

}  // namespace

void addBenchRender(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("render", "Time frames of a volume");
  command->fallthrough();
  command->footer(R"(
One view, drawn repeatedly; only data of the volume and the colours are kept between frames. Samples are
the positions on all rays of a full picture between the faces of the volume's box, whether they are taken or not; samples per
second: those over the median time.

Example:
  emscape bench render scenarios/eme_200.yaml --size 1200x900 --exact --no-skip --json)");
  auto options = std::make_shared<BenchRenderOptions>();
  addBenchSceneOptions(*command, options->scene);
  command->add_option("--rays", options->rays, "Pixels to cast; the others are interpolated; as for render");
  command->add_option("--interpolate", options->interpolate,
                      "Precision of interpolated pixels: float or 8bit");
  addToleranceOption(*command, options->tolerance_levels);
  command->add_option("--frames", options->frames, "Timed frames, after a warm-up")
      ->check(CLI::Range(1, 100000));
  command->add_option("--picture", options->picture, "NAME.png: writes the frame, on black");
  command->callback(
      [options, &global, &action] { action = [options, &global] { return benchRender(*options, global); }; });
}

}  // namespace emscape::app
