/// Stage 2 of the models with an excess loss, on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/cuda/geometry_kernels.h"
#include "emfield/excess/fill_excess.h"

namespace emscape::emfield::cuda {

using propagation::DiffractionExcess;

/// Results of an emitter with an excess loss. Pointers are to device memory.
struct ExcessOutputs {
  ExcessOutput out;
  GeometryCounts* counts = nullptr;
};

/// Device memory of the columns in progress; its size limits their number.
struct ScratchMemory {
  void* data = nullptr;
  std::size_t bytes = 0;
};

/// `parabolic_equation` of one emitter. Pointers are to device memory.
struct EquationTask {
  propagation::PeExcess model;  ///< with its tables of losses
  AirLoss air;
  Station station;
  GroundPosts ground;
  ExcessOutputs to;  ///< over terrain, its excess holds that of fillDiffraction(), without the air
};
/// One thread per column, which keeps the posts of its horizons.
/// @param grid  of device memory
/// @param row   columns along x
void fillEquation(const EquationTask& task, const ExcessGrid& grid, int row, const ScratchMemory& scratch,
                  cudaStream_t stream);

/// Any other model: one thread per column, with its own scratch memory. Of `itm` the excess holds that of
/// fillDiffraction(), without the air.
/// @param excess        its tables in device memory
/// @param grid, ground  of device memory
void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const GroundPosts& ground, const ExcessOutputs& to, const ScratchMemory& scratch,
                cudaStream_t stream);

}  // namespace emscape::emfield::cuda
