/// emscape bench march: the parabolic equation over all azimuths of an emitter.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "base/stopwatch.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/march/march_timing.h"

namespace emscape::app {
namespace {

using namespace propagation;

struct BenchMarchOptions {
  std::vector<std::string> cases;
  int repeats = 5;
  int azimuths = 0;  ///< 0: those of the case
};

struct MarchCase {
  std::string name, what;
  std::vector<AzimuthMarch> emitters;
  double floor_ms = 0;  ///< lower bound on an H100, from arithmetic and shared memory
  int steps = 0;

  const AzimuthMarch& first() const { return emitters.front(); }
  /// Number of heights over all steps, with the initial N.
  double heights() const {
    return double(emitters.size()) * first().azimuths * steps * first().grid.intervals;
  }
  /// Floating-point operations: two complex transforms of N points, screens, propagator, and passes around
  /// the transforms.
  double operations() const { return heights() * (10 * std::log2(double(first().grid.intervals)) + 18); }
};

AzimuthMarch marchOf(double frequency_hz, double top_m, double range_step_m, double range_m, int azimuths) {
  AzimuthMarch march;
  march.grid.frequency_hz = frequency_hz;
  march.grid.intervals = 2048;
  march.grid.top_m = top_m;
  march.grid.range_step_m = range_step_m;
  setAbsorber(march.grid);
  march.source.height_agl_m = 20;
  march.cells = {range_m / 200, 200, 0, march.grid.usableTop_m() / 256, 256};
  march.azimuths = azimuths;
  march.air = {standardRefractivity()};
  return march;
}

MarchCase seaCase(const char* name, bool automatic) {
  AzimuthMarch march = marchOf(10e9, 512, automatic ? 200 : 100, 100e3, 360);
  march.air = {evaporationDuct(14)};
  march.grid.halving = automatic;
  return {name,
          automatic ? "sea, 10 GHz, duct, 200 m, halving" : "sea, 10 GHz, duct, 100 m",
          {march},
          automatic ? 1.5 : 5.0,
          automatic ? 500 : 1000};
}

/// Synthetic hills, different at each azimuth, the same in every run.
MarchCase terrainCase() {
  AzimuthMarch march = marchOf(3e9, 1024, 50, 60e3, 396);
  march.cells.bottom_msl_m = -50;
  march.ground_steps = 1201;
  for (int a = 0; a < march.azimuths; ++a) {
    for (std::size_t i = 0; i < march.ground_steps; ++i) {
      const double x = 50 * double(i);
      march.ground_msl_m.push_back(
          float(60 + 40 * std::sin(x / (1500 + 3 * a)) + 20 * std::sin(x / 430 + a)));
    }
  }
  return {"terrain", "terrain, 3 GHz, 50 m", {march}, 8, 1200};
}

MarchCase verticalCase() {
  AzimuthMarch march = marchOf(1e9, 3072, 100, 100e3, 360);
  march.surface.perfect = false;
  march.surface.polarization = LinearPolarization::vertical;
  march.surface.ground = {70, 5};
  return {"vertical", "sea, 1 GHz, vertical, 100 m", {march}, 5.5, 1000};
}

MarchCase radarsCase() {
  MarchCase radars = seaCase("radars", true);
  radars.what = "sixteen radars, sea, halving";
  radars.floor_ms = 24;
  const AzimuthMarch one = radars.first();
  for (int i = 1; i < 16; ++i) {
    radars.emitters.push_back(one);
    radars.emitters.back().source.height_agl_m = 20 + i;
  }
  return radars;
}

struct MarchTimes {
  double wall_ms = 0, device_ms = 0;  ///< medians; device_ms: of the GPU, or of all threads of the CPU
  std::optional<double> cufft_ms;
};

MarchTimes timesOf(const MarchCase& one, int repeats, bool on_gpu) {
  MarchTimes times;
  std::vector<double> wall, device;
  if (on_gpu) {
    for (const GpuMarchTime& time : timeMarchesOnGpu(one.emitters, repeats)) {
      wall.push_back(time.wall_ms);
      device.push_back(time.device_ms);
    }
    times.cufft_ms = timeCufft(2 * one.first().grid.intervals, one.first().azimuths, one.steps);
    if (times.cufft_ms) *times.cufft_ms *= double(one.emitters.size());
  } else {
    std::vector<float> excess_db(one.first().cellCount());
    for (int repeat = 0; repeat < repeats; ++repeat) {
      stopIfInterrupted();
      Stopwatch watch;
      const std::clock_t begin = std::clock();
      for (const AzimuthMarch& march : one.emitters) marchAzimuths(march, excess_db.data());
      device.push_back(1000.0 * double(std::clock() - begin) / CLOCKS_PER_SEC);
      wall.push_back(watch.lap_ms());
    }
  }
  times.wall_ms = medianOf(wall);
  times.device_ms = medianOf(device);
  return times;
}

std::vector<MarchCase> chosenCases(const BenchMarchOptions& options) {
  std::vector<MarchCase> all = {seaCase("sea", false), seaCase("sea-auto", true), terrainCase(),
                                verticalCase(), radarsCase()};
  std::vector<MarchCase> chosen;
  for (MarchCase& one : all) {
    const bool named = std::find(options.cases.begin(), options.cases.end(), one.name) != options.cases.end();
    if (!options.cases.empty() && !named) continue;
    for (AzimuthMarch& march : one.emitters) {
      if (options.azimuths == 0) continue;
      march.azimuths = options.azimuths;
      if (!march.ground_msl_m.empty()) {
        march.ground_msl_m.resize(std::size_t(march.azimuths) * march.ground_steps, 50.0F);
      }
    }
    chosen.push_back(std::move(one));
  }
  return chosen;
}

int benchMarch(const BenchMarchOptions& options, const GlobalOptions& global) {
  const std::vector<MarchCase> cases = chosenCases(options);
  std::vector<MarchTimes> times;
  bool on_gpu = false;
  const std::string device = openOnTarget(global, "float", [&](const ComputeTarget& target) {
    on_gpu = target.onGpu();
    times.clear();
    for (const MarchCase& one : cases) {
      const WorkPart part(one.what, 0, 0);
      times.push_back(timesOf(one, options.repeats, on_gpu));
    }
    return target.device();
  });
  if (global.json) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const MarchCase& one = cases[i];
      Json row{{"case", one.name},
               {"emitters", one.emitters.size()},
               {"azimuths", one.first().azimuths},
               {"steps", one.steps},
               {"intervals", one.first().grid.intervals},
               {"wall_ms", times[i].wall_ms},
               {on_gpu ? "device_ms" : "cpu_ms", times[i].device_ms},
               {"gflops", one.operations() / times[i].wall_ms / 1e6},
               {"ns_per_height", 1e6 * times[i].wall_ms / one.heights()}};
      if (on_gpu) {
        row["floor_ms"] = one.floor_ms;
        row["floor_share"] = one.floor_ms / times[i].device_ms;
      }
      if (times[i].cufft_ms) row["cufft_ms"] = *times[i].cufft_ms;
      rows.push_back(row);
    }
    printJson(
        {{"device", device}, {"threads", threadCount()}, {"repeats", options.repeats}, {"cases", rows}});
    return 0;
  }
  print("device {} ({} threads), {} heights, medians of {}\n\n", device, threadCount(),
        cases.empty() ? 0 : cases.front().first().grid.intervals, options.repeats);
  print("{:<36} {:>8} {:>6} {:>10} {:>10} {:>9} {:>10}{}\n", "march", "azimuths", "steps", "wall ms",
        on_gpu ? "device ms" : "CPU ms", "Gflop/s", "ns/height",
        on_gpu ? "   floor ms  share   cuFFT ms" : "");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const MarchCase& one = cases[i];
    std::string of_gpu;
    if (on_gpu) {
      of_gpu =
          fmt::format("{:>11.1f} {:>4.0f} % {:>10}", one.floor_ms, 100 * one.floor_ms / times[i].device_ms,
                      times[i].cufft_ms ? fmt::format("{:.2f}", *times[i].cufft_ms) : "-");
    }
    print("{:<36} {:>8} {:>6} {:>10.2f} {:>10.2f} {:>9.1f} {:>10.4f}{}\n", one.what,
          one.first().azimuths * int(one.emitters.size()), one.steps, times[i].wall_ms, times[i].device_ms,
          one.operations() / times[i].wall_ms / 1e6, 1e6 * times[i].wall_ms / one.heights(), of_gpu);
  }
  return 0;
}

}  // namespace

void addBenchMarch(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command =
      bench.add_subcommand("march", "Time the parabolic equation over all azimuths of an emitter");
  command->fallthrough();
  command->footer(R"(
Cases: sea (10 GHz, evaporation duct, 100 km in steps of 100 m), sea-auto (the same in steps of 200 m, with halving of the heights),
terrain (3 GHz, 60 km in steps of 50 m over synthetic hills), vertical (1 GHz over sea, mixed transform), radars (sixteen times
sea-auto). 2048 heights, 200 x 256 cells. ns/height: wall time per azimuth, step and height; Gflop/s: two transforms, screens and
propagator per step at all heights, as if the heights were not halved. On a GPU, floor is the minimum time for the arithmetic and
the shared memory of an H100, share is the ratio of the floor to the measured time, and cuFFT is the time of its two transforms alone.

Example:
  emscape bench march --cases sea,terrain --backend cuda)");
  auto options = std::make_shared<BenchMarchOptions>();
  command->add_option("--cases", options->cases, "sea, sea-auto, terrain, vertical, radars; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember({"sea", "sea-auto", "terrain", "vertical", "radars"}));
  command->add_option("--azimuths", options->azimuths, "Azimuths of each emitter; default: 360, terrain 396")
      ->check(CLI::Range(1, 10000))
      ->default_str("");
  command->add_option("--repeats", options->repeats, "Marches of each case; the median is reported")
      ->check(CLI::Range(1, 1000));
  command->callback(
      [options, &global, &action] { action = [options, &global] { return benchMarch(*options, global); }; });
}

}  // namespace emscape::app
