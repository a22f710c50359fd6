/// emscape bench field: the stages of the field computation.
#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "apps/bench/bench.h"
#include "apps/bench/bench_statistics.h"
#include "apps/common/console.h"
#include "apps/common/interrupt.h"
#include "apps/common/target.h"
#include "base/stopwatch.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/file/named_index.h"

namespace emscape::app {
namespace {

struct BenchFieldOptions {
  std::string scenario;
  std::vector<scenario::Edit> edits;
  int repeats = 5;
  std::string device_volume = "float";
  std::vector<std::string> emitters;  ///< emitters that move and turn; empty: all
};

/// The medians of repeated updates of one kind.
struct Measured {
  double update_ms = 0;
  emfield::StageTimes stages;
};

Measured mediansOf(const std::vector<Measured>& runs) {
  const auto of = [&runs](auto part) {
    std::vector<double> values;
    for (const Measured& run : runs) values.push_back(part(run));
    return medianOf(values);
  };
  return {of([](const Measured& run) { return run.update_ms; }),
          {of([](const Measured& run) { return run.stages.columns_ms; }),
           of([](const Measured& run) { return run.stages.march_ms; }),
           of([](const Measured& run) { return run.stages.excess_ms; }),
           of([](const Measured& run) { return run.stages.combine_ms; }),
           of([](const Measured& run) { return run.stages.product_ms; }),
           of([](const Measured& run) { return run.stages.marched_heights; })}};
}

/// Lower bound of an H100's time for a step at one height over smooth earth, from its arithmetic and shared
/// memory throughput: 5 ms for 360 azimuths, 1000 steps and 2048 heights.
constexpr double kFloor_ns = 5e6 / (360.0 * 1000 * 2048);

/// Moves an emitter north by more than the solver's tolerance, and back at the next call, so that it stays
/// near its position.
void move(scenario::EmitterState& emitter, double tolerance_m, int repeat) {
  constexpr double kMetresPerDegree = 111000;
  const double shift_deg = 2 * tolerance_m / kMetresPerDegree;
  emitter.position.latitude_deg +=
      (repeat % 2 == 0 ? 1 : -1) * (emitter.position.latitude_deg > 0 ? -shift_deg : shift_deg);
}

/// Turns a beam clockwise about the vertical.
void turn(scenario::EmitterState& emitter, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  for (Vec3d* axis : {&emitter.beam.forward, &emitter.beam.right, &emitter.beam.up}) {
    *axis = {c * axis->x + s * axis->y, -s * axis->x + c * axis->y, axis->z};
  }
}

class FieldBench {
 public:
  /// @throws Error (device) if the field does not fit into the GPU's memory
  FieldBench(const playback::LoadedScenario& input, int repeats, const ComputeTarget& target)
      : target_(target),
        options_(target.fieldOptions()),
        solver_(input.scenario, input.terrain, options_),
        snapshot_(scenario::snapshotAt(input.scenario, input.terrain.get(), 0)),
        repeats_(repeats) {
    for (scenario::EmitterState& emitter : snapshot_.emitters) emitter.active = true;
    solver_.update(snapshot_);
  }

  /// @param change  changes the snapshot before an update; called with the repeat's number
  Measured measure(const std::function<void(scenario::Snapshot&, int)>& change) {
    std::vector<Measured> runs;
    for (int repeat = 0; repeat < repeats_; ++repeat) {
      stopIfInterrupted();
      change(snapshot_, repeat);
      Stopwatch watch;
      solver_.update(snapshot_);
      runs.push_back({watch.lap_ms(), solver_.stageTimes()});
    }
    return mediansOf(runs);
  }

  double tolerance_m() const { return options_.move_tolerance_m; }
  const ComputeTarget& target() const { return target_; }
  const emfield::FieldSolver& solver() const { return solver_; }

 private:
  ComputeTarget target_;
  emfield::FieldOptions options_;
  emfield::FieldSolver solver_;
  scenario::Snapshot snapshot_;
  int repeats_;
};

int benchField(const BenchFieldOptions& options, const GlobalOptions& global) {
  const playback::LoadedScenario input = playback::loadScenarioWithTerrain(options.scenario, options.edits);
  const scenario::Scenario& scenario = *input.scenario;
  const std::vector<int> chosen =
      scenario::namedIndices(scenario.emitters, options.emitters, "--emitters", "emitter", scenario.file);
  const std::unique_ptr<FieldBench> opened =
      openOnTarget(global, options.device_volume, [&](const ComputeTarget& target) {
        return std::make_unique<FieldBench>(input, options.repeats, target);
      });
  FieldBench& bench = *opened;
  const int gpus = bench.target().onGpu() ? deviceCount() : 1;
  const std::string device = (gpus > 1 ? fmt::format("{} x ", gpus) : "") + bench.target().device();
  const double tolerance_m = bench.tolerance_m();
  constexpr double kTurn_rad = 0.1;
  const Measured moved = bench.measure([&](scenario::Snapshot& snapshot, int repeat) {
    for (const int e : chosen) move(snapshot.emitters[e], tolerance_m, repeat);
  });
  const Measured one_moved = bench.measure([&](scenario::Snapshot& snapshot, int repeat) {
    move(snapshot.emitters[chosen.front()], tolerance_m, repeat);
  });
  const Measured turned = bench.measure([&](scenario::Snapshot& snapshot, int) {
    for (const int e : chosen) turn(snapshot.emitters[e], kTurn_rad);
  });

  const Dims dims = bench.solver().grid().dims;
  const int emitters = static_cast<int>(chosen.size());
  const double voxels_per_s = static_cast<double>(dims.count()) * emitters / (moved.stages.combine_ms / 1000);
  const emfield::MemoryUse memory = bench.solver().memoryUse();
  const double march_ns = 1e6 * moved.stages.march_ms / moved.stages.marched_heights;
  if (global.json) {
    Json march = nullptr;
    if (moved.stages.marched_heights > 0) {
      march = {{"heights", moved.stages.marched_heights}, {"ns_per_height", march_ns}};
      if (bench.target().onGpu()) march["floor_share"] = kFloor_ns / march_ns;
    }
    printJson({{"device", device},
               {"threads", threadCount()},
               {"grid", {dims.x, dims.y, dims.z}},
               {"emitters", emitters},
               {"repeats", options.repeats},
               {"stages_ms",
                {{"fan", moved.stages.columns_ms},
                 {"march", moved.stages.march_ms},
                 {"plane", moved.stages.excess_ms},
                 {"combine", moved.stages.combine_ms},
                 {"product", moved.stages.product_ms}}},
               {"march", march},
               {"update_ms",
                {{"all_moved", moved.update_ms},
                 {"one_moved", one_moved.update_ms},
                 {"beams_turned", turned.update_ms}}},
               {"voxels_per_s", voxels_per_s},
               {"memory",
                {{"bytes_per_voxel_and_emitter", memory.bytes_per_voxel_and_emitter},
                 {"bytes_per_column_and_emitter", memory.bytes_per_column_and_emitter},
                 {"bytes_per_voxel_and_channel", memory.bytes_per_voxel_and_channel},
                 {"total_bytes", memory.total_bytes}}}});
    return 0;
  }
  print("device {} ({} threads), grid {} x {} x {}, {} emitters, medians of {}\n\n", device, threadCount(),
        dims.x, dims.y, dims.z, emitters, options.repeats);
  print("stages, all emitters moved (ms)\n");
  print(
      "  columns  {:10.2f}\n  march    {:10.2f}\n  excess   {:10.2f}\n  combine  {:10.2f}\n  product  "
      "{:10.2f}\n\n",
      moved.stages.columns_ms, moved.stages.march_ms, moved.stages.excess_ms, moved.stages.combine_ms,
      moved.stages.product_ms);
  if (moved.stages.marched_heights > 0) {
    print("march: {:.0f} million heights of all steps and azimuths, {:.4f} ns each{}\n\n",
          moved.stages.marched_heights / 1e6, march_ns,
          bench.target().onGpu() ? fmt::format("; {:.0f} % of that is the floor", 100 * kFloor_ns / march_ns)
                                 : "");
  }
  print("update (ms)\n");
  print("  all moved     {:10.2f}\n  one moved     {:10.2f}\n  beams turned  {:10.2f}\n\n", moved.update_ms,
        one_moved.update_ms, turned.update_ms);
  print("combine: {:.1f} million voxel-emitters/s\n", voxels_per_s / 1e6);
  print(
      "memory: {:.1f} MiB; {:.1f} bytes per voxel and emitter, {:.1f} per column and emitter, {:.1f} per "
      "voxel and channel\n",
      static_cast<double>(memory.total_bytes) / (1 << 20), memory.bytes_per_voxel_and_emitter,
      memory.bytes_per_column_and_emitter, memory.bytes_per_voxel_and_channel);
  return 0;
}

}  // namespace

void addBenchField(CLI::App& bench, const GlobalOptions& global, Action& action) {
  CLI::App* command = bench.add_subcommand("field", "Time the stages of the field computation");
  command->fallthrough();
  command->footer(R"(
all moved: every emitter is shifted by more than the tolerance, so that its columns and excess are computed again. one moved: only
the first emitter is shifted. beams turned: only the beams change. With --emitters, only these move and turn, and the others are
static. Voxel-emitters per second: voxels times emitters, divided by the time of the combine stage with all moved.

march (parabolic_equation): time per azimuth, step and height, for the number of heights at the start of each march. Halving the
heights with range reduces the time, not this number. On a GPU, share is the ratio of 0.0068 ns to this time: 0.0068 ns is the
minimum for the arithmetic and the shared memory of an H100 over a smooth earth.

Example:
  emscape bench field scenarios/jacksboro.yaml --threads 2 --json
  emscape bench field scenarios/jacksboro.yaml --emitters "search radar,tracking radar,jammer")");
  auto options = std::make_shared<BenchFieldOptions>();
  command->add_option("SCENARIO", options->scenario, "Scenario (YAML or JSON)")->required();
  addSetOption(*command, options->edits);
  command->add_option("--repeats", options->repeats, "Updates of each kind; the median is reported")
      ->check(CLI::Range(1, 1000));
  addNamesOption(*command, "--emitters", options->emitters,
                 "Names of the emitters that move and turn, with commas between them, or the option again; "
                 "default: all");
  addDeviceVolumeOption(*command, options->device_volume);
  command->callback(
      [options, &global, &action] { action = [options, &global] { return benchField(*options, global); }; });
}

}  // namespace emscape::app
