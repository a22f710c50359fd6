/// The largest areas of a map of changes, and the paths that explain them.
#pragma once

#include <vector>

#include "study/compare/compare.h"

namespace emscape::study {

constexpr float kGained = 1, kLost = 2, kKept = 3;  ///< classes of a map of changes; 0: neither

/// The largest connected areas of one class, without emitter and paths.
/// @param changes  of the grid's pixels; NaN: unknown
std::vector<ChangedArea> largestAreas(const MapGrid& grid, const std::vector<float>& changes, float changed,
                                      int most);

/// Sets emitter, height above sea and both paths of an area.
void explain(ChangedArea& area, scenario::Quantity quantity, const ComparedScenario& a,
             const ComparedScenario& b);

}  // namespace emscape::study
