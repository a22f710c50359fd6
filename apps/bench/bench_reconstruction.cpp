/// emscape bench reconstruction: time saved by interpolated pixels, and their error.
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_scene.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/interrupt.h"
#include "emscape/base/error.h"

namespace emscape::app {
namespace {

using render::Image;
using render::Image8;
using render::ImageDifference;
using render::Interpolation;
using render::Pattern;

struct BenchReconstructionOptions {
  BenchSceneOptions scene;
  std::vector<std::string> rays;
  double tolerance_levels = render::kDefaultTolerance_levels;
  int frames = 20;
  int repeats = 0;  ///< 0: default of the processor
};

/// Differences of many pictures, as means over them.
class MeanDifference {
 public:
  void add(const ImageDifference& difference) {
    ++pictures_;
    for (std::size_t c = 0; c < 4; ++c) {
      max_sum_[c] += difference.max[c];
      worst_[c] = std::max(worst_[c], difference.max[c]);
      mean_sum_[c] += difference.mean[c];
    }
    ratio_sum_ += difference.ratio_percent;
    mean_all_sum_ += difference.mean_all;
    square_sum_ += std::pow(10.0, -difference.psnr_db / 10);
  }

  /// Mean over the pictures of the largest errors, truncated to an integer.
  std::array<int, 4> max() const {
    std::array<int, 4> cut{};
    for (std::size_t c = 0; c < 4; ++c) cut[c] = max_sum_[c] / pictures_;
    return cut;
  }
  std::array<double, 4> mean() const {
    std::array<double, 4> mean{};
    for (std::size_t c = 0; c < 4; ++c) mean[c] = mean_sum_[c] / pictures_;
    return mean;
  }
  double ratioPercent() const { return ratio_sum_ / pictures_; }
  /// Peak signal-to-noise ratio over the pixels of all pictures; infinity if all are equal.
  double psnr_db() const { return -10 * std::log10(square_sum_ / pictures_); }

  Json json() const {
    Json psnr;  // JSON has no infinity
    if (std::isfinite(psnr_db())) psnr = psnr_db();
    return {{"max", max()},        {"mean", mean()},
            {"max_worst", worst_}, {"ratio_percent", ratioPercent()},
            {"psnr_db", psnr},     {"mean_all", mean_all_sum_ / pictures_}};
  }

 private:
  int pictures_ = 0;
  std::array<int, 4> max_sum_{};
  std::array<int, 4> worst_{};
  std::array<double, 4> mean_sum_{};
  double ratio_sum_ = 0;
  double mean_all_sum_ = 0;
  double square_sum_ = 0;  ///< of mean square errors, full scale 1
};

/// One pattern and interpolation over all views.
struct MeasuredPattern {
  render::FramePlan plan;
  std::vector<double> busy_ms, busy_cpu_ms, restore_ms;
  std::vector<double> ratios;  ///< of busy_ms to busy_ms of the full picture of the same view
  double rays = 0, rays_in_box = 0;
  MeanDifference error;
  bool restored_equals_full = true;

  bool isFull() const { return plan.pattern == Pattern::full; }
};

/// Every pattern with each of its interpolations, the full one first.
std::vector<MeasuredPattern> plansFor(const BenchReconstructionOptions& options) {
  std::vector<Pattern> patterns;
  for (const std::string& name : options.rays) patterns.push_back(render::parsePattern(name));
  if (options.rays.empty()) patterns = render::allPatterns();
  std::vector<MeasuredPattern> plans(1);
  for (const Pattern pattern : patterns) {
    if (pattern == Pattern::full) continue;
    for (const Interpolation interpolation : {Interpolation::float32, Interpolation::bits8}) {
      if (pattern == Pattern::adaptive && interpolation != Interpolation::float32) continue;
      plans.emplace_back().plan = {pattern, interpolation, options.tolerance_levels};
    }
  }
  return plans;
}

class ReconstructionBench {
 public:
  /// @param repeats  number of times each view is drawn in each way; the median is reported
  ReconstructionBench(BenchScene& scene, std::vector<MeasuredPattern> plans, int repeats)
      : scene_(scene), plans_(std::move(plans)), repeats_(repeats) {}

  const std::vector<MeasuredPattern>& plans() const { return plans_; }
  double pixels() const { return pixels_; }
  double pixelsInBox() const { return pixels_in_box_; }

  /// Adaptive rays need some frames to reach their limit.
  void warmUp() {
    constexpr int kFrames = 6;
    render::FrameReport report;
    for (const MeasuredPattern& measured : plans_) {
      for (int frame = 0; frame < kFrames; ++frame) scene_.draw(measured.plan, report);
      scene_.restore();
    }
  }

  /// Draws one view in each way in turn, so that other load on the machine affects all of them.
  void measureView(double angle_deg) {
    scene_.turnTo(angle_deg);
    const render::RayLoad all = scene_.loadOf(render::sourceLattices(Pattern::full, scene_.size()));
    pixels_ += static_cast<double>(scene_.size().count());
    pixels_in_box_ += static_cast<double>(all.rays);
    Image full;
    Image8 full8;
    for (MeasuredPattern& measured : plans_) {
      render::FrameReport report;
      drawRepeatedly(angle_deg, measured, report);
      const Image drawn = scene_.image();
      if (measured.isFull()) {
        full = drawn;
        full8 = render::quantize(full);
      }
      measured.ratios.push_back(measured.busy_ms.back() / plans_.front().busy_ms.back());
      measured.error.add(render::compare(render::quantize(drawn), full8));
      measured.rays += static_cast<double>(report.rays);
      measured.rays_in_box += static_cast<double>(raysInBox(measured.plan.pattern, report));
      measured.restore_ms.push_back(scene_.restore().ms);
      measured.restored_equals_full &= scene_.image().pixels == full.pixels;
    }
  }

 private:
  long long raysInBox(Pattern pattern, const render::FrameReport& report) const {
    if (pattern == Pattern::adaptive) return report.rays;  // it casts only these
    return scene_.loadOf(render::sourceLattices(pattern, scene_.size())).rays;
  }

  void drawRepeatedly(double angle_deg, MeasuredPattern& measured, render::FrameReport& report) {
    std::vector<double> ms, cpu_ms;
    for (int n = 0; n < repeats_; ++n) {
      stopIfInterrupted();
      scene_.turnTo(angle_deg);
      const Duration busy = scene_.draw(measured.plan, report);
      ms.push_back(busy.ms);
      cpu_ms.push_back(busy.cpu_ms);
    }
    measured.busy_ms.push_back(medianOf(ms));
    measured.busy_cpu_ms.push_back(medianOf(cpu_ms));
  }

  BenchScene& scene_;
  std::vector<MeasuredPattern> plans_;  ///< the full picture first
  int repeats_ = 1;
  double pixels_ = 0, pixels_in_box_ = 0;
};

Json timesJson(const std::vector<double>& times_ms) {
  Json json = spreadJson(times_ms);
  json["mean"] = meanOf(times_ms);
  json["frames"] = times_ms;
  return json;
}

Json patternsJson(const ReconstructionBench& bench) {
  Json patterns = Json::array();
  for (const MeasuredPattern& measured : bench.plans()) {
    patterns.push_back({{"name", render::toString(measured.plan.pattern)},
                        {"interpolate", render::toString(measured.plan.interpolation)},
                        {"rays_fraction", measured.rays / bench.pixels()},
                        {"rays_fraction_of_hits", measured.rays_in_box / bench.pixelsInBox()},
                        {"busy_ms", timesJson(measured.busy_ms)},
                        {"busy_cpu_ms", spreadJson(measured.busy_cpu_ms)},
                        {"restore_ms", timesJson(measured.restore_ms)},
                        {"ratio_to_full", medianOf(measured.ratios)},
                        {"error", measured.error.json()},
                        {"restored_equals_full", measured.restored_equals_full}});
  }
  return patterns;
}

void printTable(const ReconstructionBench& bench) {
  print("{:<13} {:<6} {:>7} {:>8} {:>8} {:>8}  {:<15} {:<21} {:>6} {:>7}  {}\n", "rays", "interp", "of hits",
        "busy ms", "of full", "restore", "max R-G-B-A", "mean R-G-B-A", "err %", "PSNR dB", "restored");
  for (const MeasuredPattern& measured : bench.plans()) {
    const auto max = measured.error.max();
    const auto mean = measured.error.mean();
    print("{:<13} {:<6} {:>6.1f}% {:>8.2f} {:>7.1f}% {:>8.2f}  {:<15} {:<21} {:>6.1f} {:>7.1f}  {}\n",
          render::toString(measured.plan.pattern), render::toString(measured.plan.interpolation),
          100 * measured.rays_in_box / bench.pixelsInBox(), medianOf(measured.busy_ms),
          100 * medianOf(measured.ratios), medianOf(measured.restore_ms),
          fmt::format("{}-{}-{}-{}", max[0], max[1], max[2], max[3]),
          fmt::format("{:.2f}-{:.2f}-{:.2f}-{:.2f}", mean[0], mean[1], mean[2], mean[3]),
          measured.error.ratioPercent(), measured.error.psnr_db(),
          measured.restored_equals_full ? "equal" : "NOT EQUAL");
  }
}

int benchReconstruction(const BenchReconstructionOptions& options, const GlobalOptions& global) {
  std::vector<MeasuredPattern> plans = plansFor(options);
  const std::unique_ptr<BenchScene> opened = openBenchScene(options.scene, global);
  BenchScene& scene = *opened;
  // Between compared frames a GPU transfers pictures, and its cache then holds less of the volume than
  // between displayed frames.
  const int repeats = options.repeats > 0 ? options.repeats : scene.onGpu() ? 3 : 1;
  ReconstructionBench bench(scene, std::move(plans), repeats);
  {
    Progress progress(global, "drawing");
    bench.warmUp();
    for (int view = 0; view < options.frames; ++view) {
      bench.measureView(360.0 * view / options.frames);
      progress.show((view + 1.0) / options.frames);
    }
  }
  scene.turnTo(0);
  if (global.json) {
    Json result = scene.json();
    result["tolerance_levels"] = options.tolerance_levels;
    result["frames"] = options.frames;
    result["repeats"] = repeats;
    result["patterns"] = patternsJson(bench);
    printJson(result);
  } else {
    print("{}\n{} views on a circle, medians of times, means of errors\n\n", scene.summary(), options.frames);
    printTable(bench);
  }
  for (const MeasuredPattern& measured : bench.plans()) {
    if (measured.restored_equals_full) continue;
    throw Error(ErrorCode::check_failed,
                fmt::format("{}: the restored picture is not the full one", toString(measured.plan.pattern)));
  }
  return 0;
}

}  // namespace

void addBenchReconstruction(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand(
      "reconstruction", "Compare the patterns of pixel interpolation: time, error, restore");
  command->fallthrough();
  command->footer(R"(
The camera goes once around the volume in as many views as there are frames; each view is drawn in every way in turn. Ratios are
medians over the views. Errors are those of 8-bit levels against the full picture of the same view: max, the mean over the views
truncated to an integer; mean, per erroneous pixel; err %, erroneous pixels to pixels that are not all zero. Every view checks that
restoring gives the full picture, bit by bit (exit status 5).

Example:
  emscape bench reconstruction scenarios/eme_200.yaml --transfer scenarios/transfer/paper.json --frames 100 --mode mida)");
  auto options = std::make_shared<BenchReconstructionOptions>();
  addBenchSceneOptions(*command, options->scene);
  addListOption(*command, "--rays", options->rays,
                "Patterns besides the full one, separated by commas; default: all");
  addToleranceOption(*command, options->tolerance_levels);
  command->add_option("--frames", options->frames, "Views, after a warm-up")->check(CLI::Range(1, 100000));
  command
      ->add_option("--repeats", options->repeats,
                   "Repetitions per view and pattern; the median is reported; default: 1, with a GPU 3")
      ->check(CLI::Range(1, 1000))
      ->default_str("");
  command->callback([options, &global, &action] {
    action = [options, &global] { return benchReconstruction(*options, global); };
  });
}

}  // namespace emscape::app
