/// How far a radar's map of surface clutter reaches.
#pragma once

#include "emfield/columns/station.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

/// Slant range (m) up to which surfaces have clutter: an upper bound of that of the region's farthest point.
double clutterReach_m(const scenario::Region& region, const Station& station);

}  // namespace emscape::emfield
