/// Heights of a march over which a cell's loss is averaged.
#pragma once

#include "emscape/base/host_device.h"

namespace emscape::propagation {

/// From z1_m to z2_m above the ground; empty if z2_m <= z1_m.
struct CellSpan {
  double z1_m, z2_m;
};

/// @param bottom_m       half of cell_m below the lowest cell's centre, above the ground
/// @param cell_m         from the centre of a cell to that of the next
/// @param mean_m         height of a cell
/// @param is_point       only half of a height step about the cell's centre
/// @param height_step_m  of the march
/// @param top_m          above it no field is read
EMSCAPE_HD inline CellSpan cellSpan(double bottom_m, double cell_m, double mean_m, int cell, bool is_point,
                                    double height_step_m, double top_m) {
  const double middle_m = bottom_m + (cell + 0.5) * cell_m,
               half_m = is_point ? height_step_m / 4 : mean_m / 2;
  const double z1_m = middle_m - half_m, z2_m = middle_m + half_m;
  return {z1_m > 0 ? z1_m : 0, z2_m < top_m ? z2_m : top_m};
}

}  // namespace emscape::propagation
