/// Result of a march: mean losses of cells of range and height.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "propagation/parabolic_equation/march/march.h"

namespace emscape::propagation {

/// Cells from range 0 and a height upwards. Cells overlap if the field is interpolated between them: linear
/// interpolation between means over adjacent cells differs by up to several dB from the mean about the
/// position; between cells spaced by half or a quarter of their size it is nearly that mean.
struct RadialCells {
  double range_step_m = 0;  ///< from one cell to the next; at least the march's range step
  int ranges = 0;
  double bottom_msl_m = 0;
  double height_step_m = 0;
  int heights = 0;
  bool above_ground = false;  ///< heights are above the ground instead of mean sea level
  bool are_points = false;    ///< the field at the centre height and the last range step instead of the mean
  /// A cell is two range_step_m long: it includes the range steps of the previous cell (not for points).
  bool overlap = false;
  double mean_height_m = 0;  ///< of a cell about its centre; 0: height_step_m

  double meanRange_m() const { return (overlap ? 2 : 1) * range_step_m; }
  double meanHeight_m() const { return mean_height_m > 0 ? mean_height_m : height_step_m; }
};

/// Marches through all cells. Compiled for RadialMarch and LaneMarch.
/// @param march  at range 0
/// @return for each lane the losses over free space (dB), ranges x heights, height fastest: the mean of F^2
/// over all range steps in the cell and the heights in it that are above the ground and below the absorber,
/// in dB. NaN if there are none.
/// @param ended  called after each range of cells; may be empty
/// @throws Error (bad_input) if the cells are shorter than a range step
template <class March>
std::array<std::vector<float>, March::kLaneCount> marchCells(March& march, const RadialCells& cells,
                                                             const std::function<void()>& ended = {});

}  // namespace emscape::propagation
