/// What decides that positions are not covered: at one position, and the map `cause`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/link/path_cause.h"
#include "emscape/study/maps/coverage.h"

namespace emscape::study {

/// True for quantities that the budget of a path has.
bool hasCauses(scenario::Quantity quantity);

/// What decides at a point, by the path of the emitter that is nearest to the threshold: with the fewest
/// decibels missing, as of which only a range limit or jamming takes the detection away; none if no emitter
/// has a path.
std::optional<emfield::PathCause> causeAt(const scenario::Snapshot& snapshot, scenario::Quantity quantity,
                                          double threshold, const emfield::PathEnd& end,
                                          const scenario::Terrain* terrain);

/// For each position with a known answer the number of its emfield::PathCause; NaN for others, and for
/// positions to which no emitter has a path.
/// @param scenario   with radars that look at targets, as the map's
/// @param isCovered  of a position, by the map of all emitters
/// @param progress   gets the completed fraction, 0..1, from one thread at a time
std::vector<float> causesOf(const MapGrid& grid, const CoverageRequest& request,
                            const std::shared_ptr<const scenario::Scenario>& scenario,
                            const scenario::Terrain* terrain, const MapHeight& height, double time_s,
                            const std::vector<PixelAnswer>& answers,
                            const std::function<bool(std::size_t)>& isCovered,
                            const std::function<void(double)>& progress);

}  // namespace emscape::study
