/// emscape bench cells: time of pictures of tetrahedra, marched and projected.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_scene.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "base/stopwatch.h"
#include "emscape/base/parallel.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/render/cells/cell_renderer.h"
#include "report/maps/output_files.h"

namespace emscape::app {
namespace {

struct BenchCellsOptions {
  playback::FrameSelection selection;
  std::string size = "1200x900";
  std::string camera = "orbit";
  std::string transfer;
  std::string picture;
  std::string rasterizer = "auto";
  double exaggeration = 0;
  int frames = 5;
  int marched_frames = 1;
};

struct CellTimes {
  std::vector<double> ms;
  render::ProjectionReport last;
  /// Difference of the last picture from the marched one: max over components, and fraction of the pixels.
  double max_difference = 0, above_1e5 = 0;
  std::vector<double> order_ms, bin_ms, device_ms;
};

/// A field on tetrahedra, without ground, seen from around it.
class CellScene {
 public:
  CellScene(const BenchCellsOptions& options, const GlobalOptions& global, const ComputeTarget& target)
      : size_(render::parseImageSize(options.size)),
        camera_(render::parseCamera(options.camera)),
        device_(target.device()),
        renderer_(target.choice.backend) {
    playback::FrameSelection selection = options.selection;
    selection.first_only = selection.times.empty();
    frame_ = playback::openFrameSource(selection, target, progressSink(global), &stopFlag())->frame(0);
    if (!frame_.cells) {
      throw Error(ErrorCode::usage,
                  selection.input + " has no tetrahedra; --mesh computes a scenario on tetrahedra");
    }
    renderer_.setField(frame_.cells->field, frame_.cells->faces);
    renderer_.setTransferFunction(benchFunction(frame_, options.transfer));
    render::RenderSettings settings;
    settings.vertical_exaggeration = options.exaggeration;
    renderer_.setSettings(settings);
    turn(0);
  }

  render::ImageSize size() const { return size_; }
  const std::string& device() const { return device_; }
  std::size_t tetrahedra() const { return frame_.cells->field.mesh->cells.size(); }
  std::size_t points() const { return frame_.cells->field.values.size(); }

  /// Moves to the n-th view: each turns the camera by another 20 degrees.
  void turn(int n) {
    renderer_.setCamera(render::makeCamera(turned(camera_, 20.0 * n), renderer_.sceneBox(), size_));
  }

  CellTimes project(int frames, const render::ProjectionOptions& options) {
    CellTimes times;
    for (int n = -1; n < frames; ++n) {  // the first one is not measured
      stopIfInterrupted();
      turn(std::max(n, 0));
      Stopwatch watch;
      const render::Image image = renderer_.project(size_, options, &times.last);
      if (n < 0) continue;
      times.ms.push_back(watch.lap_ms());
      times.order_ms.push_back(times.last.order_ms);
      times.bin_ms.push_back(times.last.bin_ms);
      times.device_ms.push_back(times.last.device_ms);
      if (n + 1 == frames) compare(image, times);
    }
    return times;
  }

  /// The first view: drawn box, camera and transfer function.
  Json json() {
    turn(0);
    const render::SceneBox box = renderer_.sceneBox();
    return {{"drawn_lower_m", triple(box.lower_m)},
            {"drawn_upper_m", triple(box.drawnUpper_m())},
            {"camera", cameraJson(renderer_.camera())},
            {"transfer", transferJson(renderer_.transferFunction())}};
  }
  void writePicture(const std::string& file) {
    turn(0);
    writeOnBlack(file, renderer_.render(size_));
  }

  std::vector<double> march(int frames, render::CellReport& report) {
    std::vector<double> ms;
    for (int n = 0; n < frames; ++n) {
      stopIfInterrupted();
      turn(n);
      renderer_.render(size_, nullptr, &report);
      ms.push_back(report.cast_ms);
    }
    return ms;
  }

 private:
  /// @param image  of the last projected view
  void compare(const render::Image& image, CellTimes& times) {
    if (marched_.pixels.empty()) marched_ = renderer_.render(size_);
    for (std::size_t n = 0; n < image.pixels.size(); ++n) {
      const render::Rgba &p = image.pixels[n], &q = marched_.pixels[n];
      const float off =
          std::max({std::fabs(p.r - q.r), std::fabs(p.g - q.g), std::fabs(p.b - q.b), std::fabs(p.a - q.a)});
      times.max_difference = std::max(times.max_difference, static_cast<double>(off));
      if (off > 1e-5F) times.above_1e5 += 1.0 / static_cast<double>(image.pixels.size());
    }
  }

  const render::ImageSize size_;
  const render::CameraSpec camera_;
  const std::string device_;
  render::CellRenderer renderer_;
  playback::Frame frame_;
  render::Image marched_;  ///< the last projected view
};

int benchCells(const BenchCellsOptions& options, const GlobalOptions& global) {
  report::checkOutputs({{"--picture", options.picture}},
                       {{"the input", options.selection.input}, {"the transfer function", options.transfer}},
                       {});
  const auto scene = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    return std::make_unique<CellScene>(options, global, target);
  });
  if (!options.picture.empty()) scene->writePicture(options.picture);
  const auto perSecond = [&](const std::vector<double>& ms) {
    return static_cast<double>(scene->tetrahedra()) / medianOf(ms) * 1e3;
  };
  Json projected = Json::array();
  if (!global.json) {
    print("{} tetrahedra, {} points, {} x {} pixels, {} threads\n\n", scene->tetrahedra(), scene->points(),
          scene->size().width, scene->size().height, threadCount());
    print("{:<40} {:>10} {:>10} {:>10} {:>10} {:>14} {:>8} {:>7} {:>9} {:>7}\n", "", "ms", "order (ms)",
          "bin (ms)", "GPU (ms)", "tetrahedra/s", "floats", "cycles", "max diff", "> 1e-5");
  }
  using render::CellProjection;
  using render::CellSorting;
  std::string device;
  const render::Rasterizer rasterizer = render::parseRasterizer(options.rasterizer);
  for (const CellProjection projection : {CellProjection::exact, CellProjection::published}) {
    for (const CellSorting sorting : {CellSorting::centroids, CellSorting::visibility}) {
      if (options.frames == 0) continue;
      if (projection == CellProjection::published && rasterizer != render::Rasterizer::opengl) continue;
      const CellTimes times = scene->project(options.frames, {projection, sorting, rasterizer});
      device = times.last.device;
      const std::string drawn_by = toString(times.last.rasterizer);
      const double floats = static_cast<double>(times.last.sent_bytes) / sizeof(float) /
                            static_cast<double>(scene->tetrahedra());
      projected.push_back({{"rasterizer", drawn_by},
                           {"device", device},
                           {"perspective", toString(projection)},
                           {"order", toString(sorting)},
                           {"ms", spreadJson(times.ms)},
                           {"order_ms", spreadJson(times.order_ms)},
                           {"bin_ms", spreadJson(times.bin_ms)},
                           {"device_ms", spreadJson(times.device_ms)},
                           {"tetrahedra_per_s", perSecond(times.ms)},
                           {"floats_per_tetrahedron", floats},
                           {"cycles", times.last.cycles},
                           {"max_difference", times.max_difference},
                           {"above_1e5_fraction", times.above_1e5}});
      if (!global.json) {
        print("{:<40} {:>10.1f} {:>10.1f} {:>10.1f} {:>10.1f} {:>14.3g} {:>8.0f} {:>7} {:>9.1e} {:>5.1f} %\n",
              fmt::format("projected by {}, {}, {}", drawn_by, toString(projection), toString(sorting)),
              medianOf(times.ms), medianOf(times.order_ms), medianOf(times.bin_ms), medianOf(times.device_ms),
              perSecond(times.ms), floats, times.last.cycles, times.max_difference, 100 * times.above_1e5);
      }
    }
  }
  render::CellReport report;
  const std::vector<double> marched_ms = scene->march(options.marched_frames, report);
  if (!global.json) {
    print("{:<40} {:>10.1f} {:>10} {:>10} {:>10} {:>14.3g}\n\nmarched by {}: {} rays passed {} cells\n",
          "marched", medianOf(marched_ms), "", "", "", perSecond(marched_ms), scene->device(), report.rays,
          report.cells);
    if (!device.empty()) print("projected by {}\n", device);
    return 0;
  }
  Json result = scene->json();
  result.update({{"device", device},
                 {"march_device", scene->device()},
                 {"threads", threadCount()},
                 {"size", {scene->size().width, scene->size().height}},
                 {"tetrahedra", scene->tetrahedra()},
                 {"points", scene->points()},
                 {"frames", options.frames},
                 {"projected", projected},
                 {"marched",
                  {{"ms", spreadJson(marched_ms)},
                   {"rays", report.rays},
                   {"cells_passed", report.cells},
                   {"tetrahedra_per_s", perSecond(marched_ms)}}}});
  printJson(result);
  return 0;
}

}  // namespace

void addBenchCells(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("cells", "Time pictures of tetrahedra, projected and marched");
  command->fallthrough();
  command->footer(R"(
Views around the field, without ground; each is ordered and drawn anew. Bin: time until the lists of cells per tile
are complete. GPU: its time for drawing, by its own clock; 0 without a GPU. Floats: sent per tetrahedron and picture.
Max diff: largest difference from the marched picture; > 1e-5: fraction of the pixels beyond it. The published form is
measured with --rasterizer opengl.

Example:
  emscape bench cells scenarios/jacksboro.yaml --mesh terrain:15,5 --set "region.dims=[107, 107, 100]" --json)");
  auto options = std::make_shared<BenchCellsOptions>();
  command
      ->add_option("INPUT", options->selection.input,
                   "Field on tetrahedra (.vtu), or a scenario with --mesh, computed for one instant")
      ->required();
  addSetOption(*command, options->selection.edits);
  command->add_option("--mesh", options->selection.mesh, "As for simulate");
  command->add_option("--size", options->size, "Picture size in pixels, WxH");
  command->add_option("--camera", options->camera, "As for render; turned by 20 degrees per frame");
  command->add_option("--transfer", options->transfer,
                      "Colours and opacities (JSON); default: scenarios/transfer/paper.json");
  command
      ->add_option("--exaggeration", options->exaggeration, "Vertical exaggeration; 0: chosen from the box")
      ->check(within(render::kExaggerationLimits));
  command->add_option("--picture", options->picture, "NAME.png: writes the first view, marched, on black");
  command->add_option("--quantity", options->selection.quantity, "Quantity or channel; default: the first");
  command->add_option("--time", options->selection.times, "Instant, in seconds; default: the first");
  command->add_option("--rasterizer", options->rasterizer, "What projects; default: auto")
      ->check(CLI::IsMember({"auto", "opengl", "tiles"}));
  command
      ->add_option("--frames", options->frames,
                   "Timed frames that are projected, after a warm-up; 0: none, OpenGL is not needed")
      ->check(CLI::Range(0, 100000));
  command->add_option("--marched-frames", options->marched_frames, "Timed frames that are marched")
      ->check(CLI::Range(1, 100000));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return benchCells(*options, global); }; });
}

}  // namespace emscape::app
