/// Voxels of a NanoVDB grid, for RaycastTask's samplers.
#pragma once

#include "render/cast/volume_view.h"
#include "volume/sparse/sparse_block.h"

namespace emscape::render::cuda {

class GridVoxels : public volume::SparseVoxels {
 public:
  EMSCAPE_HD explicit GridVoxels(const VolumeView& volume)
      : volume::SparseVoxels(volume.sparse, volume.dims) {}
};

}  // namespace emscape::render::cuda
