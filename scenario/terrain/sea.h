/// The sea in the terrain itself.
#pragma once

#include <cstdint>
#include <vector>

namespace emscape::scenario {

/// The sea at the points of a grid, by their heights: connected level points (neighbours within 2 cm) at mean
/// sea level (within 0.5 m), at least 30 of them, with the points at their edge that are as high.
/// @param msl_m     heights above mean sea level, row by row; NaN: unknown, no sea; empty: all are unknown
/// @param by_coast  1 where the coasts say that there is water: of level points, those without any are land;
///                  empty: unknown
/// @return 1 sea, 0 land
std::vector<std::uint8_t> seaByHeights(int columns, int rows, const std::vector<float>& msl_m,
                                       const std::vector<std::uint8_t>& by_coast = {});

}  // namespace emscape::scenario
