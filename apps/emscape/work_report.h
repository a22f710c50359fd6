/// Memory and disk space that a scenario takes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "apps/emscape/console.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/scenario/scenario.h"

namespace emscape::app {

/// Upper bounds for `simulate` on the CPU with all quantities and steps of the scenario.
struct WorkEstimate {
  emfield::MemoryEstimate memory;
  std::optional<std::size_t> available_bytes;  ///< of the host's memory; none: not known
  std::size_t steps = 0;
  std::size_t step_bytes = 0;  ///< of the files of a step without compression, as .raw
};

WorkEstimate workEstimateOf(const emfield::FieldSolver& solver, const scenario::Scenario& scenario);

Json workJson(const WorkEstimate& work);
/// "up to 35 MiB of memory (volumes 20, emitters 15; 3000 free); 41 steps of 3 MiB as .raw"
std::string workText(const WorkEstimate& work);

}  // namespace emscape::app
