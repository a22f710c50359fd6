/// Stage 2 of the models with an excess loss, on the device.
#pragma once

#include <cuda_runtime_api.h>

#include "emfield/cuda/geometry_kernels.h"
#include "emfield/fill_excess.h"
#include "propagation/diffraction/column.h"

namespace emscape::emfield::cuda {

using propagation::DiffractionExcess;
using propagation::kDiffractionBlock;
using propagation::TerrainSums;

/// An emitter with an excess loss. Pointers are to device memory.
struct ExcessOutputs {
  ExcessOutput out;
  GeometryCounts* counts = nullptr;
};

/// What DiffractionColumn knows of a block of posts along an azimuth.
struct FanBlock {
  float highest_msl_m, lowered_msl_m;
};

/// `diffraction` over some intervals of an emitter's fan, over all of them for columns that lean: a thread a
/// column, the profile read from the fan as often as it is needed.
struct DiffractionTask {
  DiffractionExcess model;
  AirLoss air;
  FanPiece piece;  ///< heights, azimuth fastest
  ExcessOutputs to;
  /// Of each block of posts and each azimuth, azimuth fastest; made by fillDiffraction().
  FanBlock* blocks = nullptr;
  TerrainSums* sums = nullptr;  ///< before the block

  /// Blocks along an azimuth of so many posts.
  EMSCAPE_HD static constexpr int blockCount(int posts) {
    return (posts + kDiffractionBlock - 1) / kDiffractionBlock;
  }
};
/// @param extent         of the tasks' pieces
/// @param grid           of device memory
/// @param row            columns along x
/// @param leans          whether the columns do
/// @param first_valid_k  voxels below get no excess; null: none is below
void fillDiffraction(const DiffractionTask* tasks, const PieceExtent& extent, const ExcessGrid& grid, int row,
                     bool leans, const std::uint16_t* first_valid_k, cudaStream_t stream);

/// Any model: a thread a column with memory of its own.
/// @param excess     its tables in device memory
/// @param grid, fan  of device memory; fan: range fastest, none for models without terrain
/// @param scratch    device memory; the more there is of it, the more columns are computed at a time
void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const FanHeights& fan, const ExcessOutputs& to, void* scratch, std::size_t scratch_bytes,
                cudaStream_t stream);

}  // namespace emscape::emfield::cuda
