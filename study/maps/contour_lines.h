/// Lines of equal value of a grid.
#pragma once

#include <limits>
#include <vector>

namespace emscape::study {

/// A point in units of the grid's spacing: (0, 0) is the first value.
struct GridPoint {
  double x = 0, y = 0;
};
using GridLine = std::vector<GridPoint>;  ///< closed if its first point is its last

/// Marching squares, with values linear along the sides of the cells; a saddle is resolved by its mean. Cells
/// with a value that is not finite have no line. Beside a value of at most the floor, where there is none, a
/// line runs midway between the posts: at the outline of a pixel.
/// @param values  width x height, x fastest
/// @return lines in the order of their first cell, no line shorter than two points
std::vector<GridLine> contourLines(const std::vector<float>& values, int width, int height, float level,
                                   float floor = -std::numeric_limits<float>::infinity());

}  // namespace emscape::study
