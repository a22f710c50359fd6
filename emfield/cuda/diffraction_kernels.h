/// Stage 2 of `diffraction` on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/cuda/geometry_kernels.h"
#include "emfield/excess/column_diffraction.h"

namespace emscape::emfield::cuda {

/// `diffraction` of one emitter. Pointers are to device memory.
struct DeviceDiffractionTask {
  DiffractionTask task;
  GeometryCounts* counts = nullptr;
};

/// Several emitters at once: one thread per column.
/// @param grid   in device memory; layers that do not count get no excess
/// @param row    columns along x
void fillDiffraction(const DeviceDiffractionTask* tasks, int count, const ExcessGrid& grid, int row,
                     cudaStream_t stream);

}  // namespace emscape::emfield::cuda
