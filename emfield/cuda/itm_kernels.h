/// Stage 2 of the model `itm` on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/cuda/excess_kernels.h"

namespace emscape::emfield::cuda {

/// @param task     its pointers to device memory
/// @param to       its excess holds that of fillDiffraction(), without the air
/// @param scratch  limits the number of columns in progress
void fillItm(const ExcessTask<propagation::ItmExcess>& task, const ExcessOutputs& to,
             const ScratchMemory& scratch, cudaStream_t stream);

}  // namespace emscape::emfield::cuda
