/// A row of voxels, the unit of the CPU's loops.
#pragma once

#include <cstddef>

namespace emscape::emfield {

/// A run of voxels along x: those of the columns from `column` on, all at z = t_m.
struct Row {
  std::size_t column;
  int count;
  float t_m;
};

}  // namespace emscape::emfield
