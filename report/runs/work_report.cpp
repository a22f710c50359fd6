#include "report/runs/work_report.h"

#include <fmt/core.h>

#include <cmath>

#include "base/memory.h"
#include "emfield/solver/field_engine.h"
#include "emscape/base/parallel.h"
#include "emscape/scenario/model/clock.h"
#include "report/runs/work_time.h"

namespace emscape::report {
namespace {

constexpr double kMebibyte = 1 << 20;

double mebibytes(std::size_t bytes) {
  return static_cast<double>(bytes) / kMebibyte;
}

/// One digit, in the largest unit with a value of at least 1.
std::string roughly(double time_s) {
  if (time_s < 1) return "below 1 s";
  struct Unit {
    const char* name;
    double seconds;
  };
  static constexpr Unit kUnits[] = {{"days", 86400}, {"hours", 3600}, {"minutes", 60}, {"s", 1}};
  const Unit* unit = kUnits;
  while (time_s < 2 * unit->seconds && unit->seconds > 1) ++unit;
  const double number = time_s / unit->seconds, power = std::pow(10, std::floor(std::log10(number)));
  return fmt::format("about {:.0f} {}", std::round(number / power) * power, unit->name);
}

}  // namespace

WorkEstimate workEstimateOf(const emfield::FieldSolver& solver, const scenario::Scenario& scenario,
                            const scenario::Terrain* terrain,
                            const std::vector<emfield::EmitterChoice>& choices) {
  WorkEstimate work;
  work.memory = solver.memoryEstimate();
  work.available_bytes = availableMemory_bytes();
  work.steps = scenario::timesOf(scenario.clock).size();
  const auto voxels = static_cast<std::size_t>(solver.grid().dims.count());
  work.step_bytes = voxels * sizeof(float) * solver.channels().size();
  work.time_s = workTimeOf(scenario, terrain, choices).total_s() / threadCount();
  if (terrain != nullptr) work.terrain_bytes = emfield::postBytes(terrain->view());
  return work;
}

Json workJson(const WorkEstimate& work) {
  return {{"memory_mib", mebibytes(work.memory.total())},
          {"volumes_mib", mebibytes(work.memory.volumes)},
          {"emitters_mib", mebibytes(work.memory.emitters)},
          {"terrain_mib", mebibytes(work.terrain_bytes)},
          {"available_mib", work.available_bytes ? Json(mebibytes(*work.available_bytes)) : Json(nullptr)},
          {"steps", work.steps},
          {"step_mib", mebibytes(work.step_bytes)},
          {"time_s", work.time_s},
          {"threads", threadCount()}};
}

std::string workText(const WorkEstimate& work) {
  const std::string available =
      work.available_bytes ? fmt::format("; {:.0f} are available", mebibytes(*work.available_bytes)) : "";
  const std::string terrain =
      work.terrain_bytes > 0 ? fmt::format(" and {:.1f} MiB of elevation data", mebibytes(work.terrain_bytes))
                             : "";
  const int threads = threadCount();
  return fmt::format(
      "memory: up to {:.1f} MiB (volumes {:.1f}, emitters {:.1f}{}){}; {} step{} of {:.1f} MiB as .raw; "
      "time: {} on {} thread{}, within a factor of 5",
      mebibytes(work.memory.total()), mebibytes(work.memory.volumes), mebibytes(work.memory.emitters),
      available, terrain, work.steps, work.steps == 1 ? "" : "s", mebibytes(work.step_bytes),
      roughly(work.time_s), threads, threads == 1 ? "" : "s");
}

}  // namespace emscape::report
