/// Columns that are not computed, from those around them, on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/cuda/geometry_kernels.h"
#include "emfield/excess/fill_excess.h"

namespace emscape::emfield::cuda {

/// An emitter whose columns of a part are computed. Pointers are to device memory.
struct DevicePartTask {
  ExcessCode* codes = nullptr;  ///< null: shadow edges alone
  float* shadow_edge_m = nullptr;
  GeometryCounts* counts = nullptr;
};

/// As interpolateColumnsCpu(), and counts unknown columns among the others.
/// @param grid  of device memory, with the part
/// @param row   columns along x
void interpolateColumns(const DevicePartTask* tasks, int count, const ExcessGrid& grid, int row,
                        cudaStream_t stream);

}  // namespace emscape::emfield::cuda
