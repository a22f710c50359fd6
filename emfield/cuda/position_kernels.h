/// Kernels over the positions of a surface.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/columns/position_columns.h"

namespace emscape::emfield::cuda {

/// Number of parts into which the kernels divide the positions.
constexpr int kPositionsParts = 1024;

/// Computes the columns of a surface. Pointers are to device memory.
/// @param parts  kPositionsParts sums
void computePositions(const PositionTask& task, int positions, const GeoidView& geoid, PositionsPart* parts,
                      cudaStream_t stream);

/// Largest distance (m) from the middle of a surface to a position with ground, of each part. Sets the
/// columns of positions that are left out to that in the middle.
/// @param task      of computePositions()
/// @param geodesy   of the middle
/// @param beyond_m  kPositionsParts distances
void spanPositions(const PositionTask& task, int positions, const PositionColumn& middle,
                   const FastGeodesy& geodesy, double* beyond_m, cudaStream_t stream);

}  // namespace emscape::emfield::cuda
