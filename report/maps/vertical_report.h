/// A vertical coverage diagram as a table, JSON and CSV.
#pragma once

#include <string>

#include "emscape/study/vertical/vertical.h"
#include "report/json.h"

namespace emscape::report {

/// Farthest grid point at which the threshold is reached, the lowest one if there are several, and the
/// fraction of points at which it is reached.
struct VerticalReach {
  bool is_any = false;
  bool is_at_edge = false;  ///< of the diagram or of what is known: the threshold may be reached beyond it
  double range_m = 0, height_m = 0;
  double covered_part = 0;  ///< fraction of the points with a value
};
VerticalReach reachOf(const study::VerticalDiagram& diagram, const study::VerticalCut& cut);

/// @param with_grid  false: only contours and reach
Json verticalJson(const study::VerticalDiagram& diagram, bool with_grid);
std::string verticalText(const study::VerticalDiagram& diagram);
/// Writes the rows of the grid, then those of the contours. @throws Error (other) naming the file
void writeVerticalCsv(const study::VerticalDiagram& diagram, const std::string& file);

}  // namespace emscape::report
