/// Processor time that the field of a scenario takes, estimated before it is computed.
#pragma once

#include <vector>

#include "emfield/excess/model_choices.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::report {

/// Seconds on one core, of all steps of the clock.
struct WorkTime {
  double losses_s = 0;    ///< columns of the grid, losses of paths, shadows
  double patterns_s = 0;  ///< of beams over intervals
  double sums_s = 0;      ///< over emitters; radars' looks and jammers; products
  double total_s() const { return losses_s + patterns_s + sums_s; }
};

/// @param terrain  of the scenario; may be null
/// @param choices  of its emitters at the first step
/// @accuracy within a factor of 5 where it is above 0.05 s (WorkEstimate)
WorkTime workTimeOf(const scenario::Scenario& scenario, const scenario::Terrain* terrain,
                    const std::vector<emfield::EmitterChoice>& choices);

}  // namespace emscape::report
