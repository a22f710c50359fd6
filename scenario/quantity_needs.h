/// What single quantities need of a scenario.
#pragma once

#include <string>

#include "emscape/scenario/quantities.h"
#include "emscape/scenario/scenario.h"

namespace emscape::scenario {

/// What a quantity of a receiver (QuantityKind::of_receiver) or detection_age_s needs and the scenario lacks,
/// as the message of an error; empty: it has everything, or it is another quantity.
/// @param output  of the scenario, or about to be
std::string unmetNeed(Quantity quantity, const Scenario& scenario, const OutputSpec& output);

}  // namespace emscape::scenario
