/// The ground in the memory of the GPU.
#pragma once

#include <cstdint>
#include <vector>

#include "base/cuda/cuda_memory.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield::cuda {

/// A copy of a terrain's rasters and land cover; heights are computed by the same function as on the host.
class DeviceTerrain {
 public:
  DeviceTerrain() = default;
  /// Copies on a stream; later work on the stream can use it.
  /// @throws Error (device)
  DeviceTerrain(const scenario::TerrainView& terrain, cudaStream_t stream);

  /// For kernels, while this object lives.
  scenario::TerrainView view() const {
    return {rasters_.data(), static_cast<int>(rasters_.size()), surfaces_.data(),
            static_cast<int>(surfaces_.size()), cover_};
  }
  HighestOfTiles tiles() const { return {tile_heights_.data(), tile_columns_}; }

 private:
  void upload(const scenario::TerrainRaster* from, int count,
              emscape::cuda::Buffer<scenario::TerrainRaster>& to, cudaStream_t stream);

  std::vector<emscape::cuda::Buffer<float>> heights_;
  emscape::cuda::Buffer<scenario::TerrainRaster> rasters_, surfaces_;
  emscape::cuda::Buffer<std::uint8_t> cover_cells_;
  emscape::cuda::Buffer<scenario::CoverValues> cover_classes_;
  scenario::LandCoverView cover_;
  emscape::cuda::Buffer<float> tile_heights_;
  int tile_columns_ = 0;
};

}  // namespace emscape::emfield::cuda
