/// Requirements of quantities on a scenario.
#pragma once

#include <string>

#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// Error message that names the quantities over an interval if this one has no meaning over it; else empty.
std::string unmetInterval(Quantity quantity, IntervalKind interval);

/// Error message that names what the scenario lacks for a quantity of a receiver (QuantityKind::of_receiver)
/// or detection_age_s; empty if nothing is missing, and for other quantities.
/// @param output  of the scenario, possibly not yet set
std::string unmetNeed(Quantity quantity, const Scenario& scenario, const OutputSpec& output);

}  // namespace emscape::scenario
