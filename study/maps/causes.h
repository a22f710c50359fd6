/// The map `cause`: what decides that positions are not covered.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "emscape/study/maps/coverage.h"

namespace emscape::study {

/// True for quantities that the budget of a path has.
bool hasCauses(scenario::Quantity quantity);

/// For each position with a known answer the number of its emfield::PathCause, by the path of the active
/// emitter with the largest value; NaN for others, and for positions to which no emitter has a path.
/// @param scenario   with radars that look at targets, as the map's
/// @param isCovered  of a position, by the map of all emitters
std::vector<float> causesOf(const MapGrid& grid, const CoverageRequest& request,
                            const std::shared_ptr<const scenario::Scenario>& scenario,
                            const scenario::Terrain* terrain, const MapHeight& height, double time_s,
                            const std::vector<PixelAnswer>& answers,
                            const std::function<bool(std::size_t)>& isCovered);

}  // namespace emscape::study
