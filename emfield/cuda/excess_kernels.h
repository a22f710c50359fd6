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

/// Summary of a block of posts along an azimuth; see DiffractionColumn.
struct FanBlock {
  float highest_msl_m, lowered_msl_m;
};

/// `diffraction` over some intervals of an emitter's fan, over all of them for tilted columns: one thread per
/// column, which reads its profile from the fan as often as it needs it.
struct DiffractionTask {
  DiffractionExcess model;
  AirLoss air;
  FanSector sector;  ///< heights, azimuth fastest
  ExcessOutputs to;
  /// Of each block of posts and each azimuth, azimuth fastest; made by fillDiffraction().
  FanBlock* blocks = nullptr;
  TerrainSums* sums = nullptr;  ///< before the block

  /// Blocks along an azimuth of so many posts.
  EMSCAPE_HD static constexpr int blockCount(int posts) {
    return (posts + kDiffractionBlock - 1) / kDiffractionBlock;
  }
};
/// @param extent         of the tasks' sectors
/// @param grid           of device memory
/// @param row            columns along x
/// @param tilted         whether the columns are
/// @param first_valid_k  voxels below get no excess; null: none is below
void fillDiffraction(const DiffractionTask* tasks, const SectorExtent& extent, const ExcessGrid& grid,
                     int row, bool tilted, const std::uint16_t* first_valid_k, cudaStream_t stream);

/// Any model: one thread per column, with its own scratch memory.
/// @param excess     its tables in device memory
/// @param grid, fan  of device memory; fan: range fastest, none for models without terrain
/// @param scratch    device memory; its size bounds the number of columns computed at a time
void fillExcess(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                const FanHeights& fan, const ExcessOutputs& to, void* scratch, std::size_t scratch_bytes,
                cudaStream_t stream);

}  // namespace emscape::emfield::cuda
