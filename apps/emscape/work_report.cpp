#include "apps/emscape/work_report.h"

#include <fmt/core.h>

#include "base/memory.h"
#include "emscape/scenario/clock.h"

namespace emscape::app {
namespace {

constexpr double kMebibyte = 1 << 20;

double mebibytes(std::size_t bytes) {
  return static_cast<double>(bytes) / kMebibyte;
}

}  // namespace

WorkEstimate workEstimateOf(const emfield::FieldSolver& solver, const scenario::Scenario& scenario) {
  WorkEstimate work;
  work.memory = solver.memoryEstimate();
  work.available_bytes = availableMemory_bytes();
  work.steps = scenario::timesOf(scenario.clock).size();
  const auto voxels = static_cast<std::size_t>(solver.grid().dims.count());
  work.step_bytes = voxels * sizeof(float) * solver.channels().size();
  return work;
}

Json workJson(const WorkEstimate& work) {
  return {{"memory_mib", mebibytes(work.memory.total())},
          {"volumes_mib", mebibytes(work.memory.volumes)},
          {"emitters_mib", mebibytes(work.memory.emitters)},
          {"available_mib", work.available_bytes ? Json(mebibytes(*work.available_bytes)) : Json(nullptr)},
          {"steps", work.steps},
          {"step_mib", mebibytes(work.step_bytes)}};
}

std::string workText(const WorkEstimate& work) {
  const std::string available =
      work.available_bytes ? fmt::format("; {:.0f} are available", mebibytes(*work.available_bytes)) : "";
  return fmt::format(
      "memory: up to {:.1f} MiB (volumes {:.1f}, emitters {:.1f}{}); {} step{} of {:.1f} MiB as .raw",
      mebibytes(work.memory.total()), mebibytes(work.memory.volumes), mebibytes(work.memory.emitters),
      available, work.steps, work.steps == 1 ? "" : "s", mebibytes(work.step_bytes));
}

}  // namespace emscape::app
