/// The least height above ground at which a quantity reaches a threshold, place by place.
#pragma once

#include <memory>
#include <vector>

#include "emscape/emfield/field_solver.h"
#include "emscape/study/map_grid.h"

namespace emscape::study {

/// Heights are searched from the ground to kHighestSearched_m in 64 steps, then below the first step that
/// reaches the threshold in 16 steps, again and again down to kLeastHeightAccuracy_m. A lower height at which
/// the threshold is reached over less than a first step (160 m) may be missed.
constexpr double kHighestSearched_m = 10240;
constexpr double kLeastHeightAccuracy_m = 0.625;

/// @param scenario  with the quantity as its only output
/// @return heights (m) that reach the threshold, at most kLeastHeightAccuracy_m above the least; 0 on the
/// ground; NaN: none does, or the place has no value
std::vector<float> leastHeights(const std::shared_ptr<const scenario::Scenario>& scenario,
                                const scenario::TerrainPtr& terrain, const MapGrid& grid, double threshold,
                                double time_s, const emfield::FieldOptions& options);

}  // namespace emscape::study
