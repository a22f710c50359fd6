/// The heights of a march that a cell's loss is the mean of.
#pragma once

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// From z1_m to z2_m above the ground; none if z2_m is not above z1_m.
struct CellSpan {
  double z1_m, z2_m;
};

/// @param bottom_m       of the lowest cell, above the ground
/// @param cell_m         height of a cell
/// @param is_point       only half of a height step about the cell's middle
/// @param height_step_m  of the march
/// @param top_m          above it no field is read
EMSCAPE_HD inline CellSpan cellSpan(double bottom_m, double cell_m, int cell, bool is_point,
                                    double height_step_m, double top_m) {
  const double middle_m = bottom_m + (cell + 0.5) * cell_m, quarter_m = height_step_m / 4;
  const double z1_m = is_point ? middle_m - quarter_m : bottom_m + cell * cell_m;
  const double z2_m = is_point ? middle_m + quarter_m : bottom_m + (cell + 1) * cell_m;
  return {z1_m > 0 ? z1_m : 0, z2_m < top_m ? z2_m : top_m};
}

}  // namespace emscape::propagation
