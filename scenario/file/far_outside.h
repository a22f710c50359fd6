/// Positions that are nowhere near the region, as where latitude and longitude are exchanged.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::scenario {

/// Positions may be this far outside the region without a doubt.
constexpr double kFarOutside_m = 1e6;

/// How far all positions of an object are outside the region, and the mistake without which the nearest is
/// near it; empty if one is within kFarOutside_m.
std::string farOutsideText(const Region& region, const std::vector<GeodeticPosition>& positions);

/// The same of one position, if there is a mistake without which it is near the region; else empty.
std::string mistakenPlaceText(const Region& region, double latitude_deg, double longitude_deg);

/// How far below or above the region's heights all active emitters are, or that the region is below the
/// ground; empty if neither is in doubt.
/// @param terrain  null: a smooth earth at mean sea level
std::string outsideHeightsText(const Snapshot& snapshot, const Terrain* terrain);

}  // namespace emscape::scenario
