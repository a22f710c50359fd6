/// What a march leaves: mean losses of cells of range and height.
#pragma once

#include <array>
#include <vector>

#include "propagation/parabolic_equation/march.h"

namespace emscape::propagation {

/// Cells from range 0 and a height upwards. Where the field between them is wanted they overlap: linear
/// interpolation between means over cells side by side is up to some dB off a mean about the place, and
/// nearly that mean between cells that are half or a quarter of their size apart.
struct RadialCells {
  double range_step_m = 0;  ///< from one cell to the next; at least the march's range step
  int ranges = 0;
  double bottom_msl_m = 0;
  double height_step_m = 0;
  int heights = 0;
  bool above_ground = false;  ///< heights count from the ground instead of mean sea level
  bool are_points = false;  ///< the field at the middle height and the last range step, in place of the mean
  /// A cell is two range_step_m long: it holds the range steps of the one before, too (not of points).
  bool overlap = false;
  double mean_height_m = 0;  ///< of a cell about its middle; 0: height_step_m

  double meanRange_m() const { return (overlap ? 2 : 1) * range_step_m; }
  double meanHeight_m() const { return mean_height_m > 0 ? mean_height_m : height_step_m; }
};

/// Marches through all cells. Compiled for RadialMarch and LaneMarch.
/// @param march  at range 0
/// @return for each lane the losses over free space (dB), ranges x heights, height fastest: the mean of F^2
/// over all range steps in the cell and the heights in it that are above the ground and below the absorber,
/// in dB. NaN where there are none.
/// @throws Error (bad_input) if the cells are shorter than a range step
template <class March>
std::array<std::vector<float>, March::kLaneCount> marchCells(March& march, const RadialCells& cells);

}  // namespace emscape::propagation
