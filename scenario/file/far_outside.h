/// Positions that are nowhere near the region, as where latitude and longitude are exchanged.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// Positions may be this far outside the region without a doubt.
constexpr double kFarOutside_m = 1e6;

/// How far all positions of an object are outside the region, and the mistake without which the nearest is
/// near it; empty if one is within kFarOutside_m.
std::string farOutsideText(const Region& region, const std::vector<GeodeticPosition>& positions);

}  // namespace emscape::scenario
