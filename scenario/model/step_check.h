/// Check of the platforms at every step of the clock.
#pragma once

#include <functional>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// A platform that cannot be where it is at some steps: below the ground, or over missing terrain.
struct StepFault {
  Error error;            ///< of the first of these steps
  int faulty = 0;         ///< number of these steps
  int steps = 1;          ///< of all that were checked; 1 for a fixed site
  bool at_first = false;  ///< the first step is one of them

  /// "... (at 8 of 301 steps)"
  std::string text() const;
};

/// One per platform with a fault.
/// @param terrain      null: none
/// @param every        every which step is checked; 1: all
/// @param before_each  called before each step of a platform; may be empty, and may throw
std::vector<StepFault> faultsOfSteps(const Scenario& scenario, const Terrain* terrain, int every = 1,
                                     const std::function<void()>& before_each = {});

}  // namespace emscape::scenario
