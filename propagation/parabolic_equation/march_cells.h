/// What a march leaves: mean losses of cells of range and height.
#pragma once

#include <array>
#include <vector>

#include "propagation/parabolic_equation/march.h"

namespace emscape::propagation {

/// Cells from range 0 and a height upwards.
struct RadialCells {
  double range_step_m = 0;  ///< at least the march's range step
  int ranges = 0;
  double bottom_msl_m = 0;
  double height_step_m = 0;
  int heights = 0;
  bool above_ground = false;  ///< heights count from the ground instead of mean sea level
  bool are_points = false;  ///< the field at the middle height and the last range step, in place of the mean
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
