/// Memory, time and disk space that a scenario needs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emfield/excess/model_choices.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "report/json.h"

namespace emscape::report {

/// Upper bounds for `simulate` on the CPU with all quantities and steps of the scenario.
struct WorkEstimate {
  emfield::MemoryEstimate memory;
  std::size_t terrain_bytes = 0;  ///< heights of the elevation data; not included in `memory`
  /// Available host memory once the elevation data are read; empty: unknown.
  std::optional<std::size_t> available_bytes;
  double time_s = 0;  ///< of the field at all steps, within a factor of 5: see work_time.h
  std::size_t steps = 0;
  std::size_t step_bytes = 0;  ///< of the uncompressed files of a step (.raw)
};

/// @param terrain  of the scenario; may be null
/// @param choices  of its emitters at the first step
WorkEstimate workEstimateOf(const emfield::FieldSolver& solver, const scenario::Scenario& scenario,
                            const scenario::Terrain* terrain,
                            const std::vector<emfield::EmitterChoice>& choices);

Json workJson(const WorkEstimate& work);
/// "memory: up to 35.0 MiB (volumes 20.0, emitters 15.0; 3000 are available) and 4.0 MiB of elevation data;
/// 41 steps of 3.0 MiB as .raw; time: about 20 s on 2 threads, within a factor of 5"
std::string workText(const WorkEstimate& work);

}  // namespace emscape::report
