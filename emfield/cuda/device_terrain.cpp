#include "emfield/cuda/device_terrain.h"

#include "base/cuda/staged_copy.h"

namespace emscape::emfield::cuda {

DeviceTerrain::DeviceTerrain(const scenario::TerrainView& terrain, cudaStream_t stream) {
  std::vector<scenario::TerrainRaster> rasters(terrain.rasters, terrain.rasters + terrain.count);
  for (scenario::TerrainRaster& raster : rasters) {
    heights_.emplace_back();
    emscape::cuda::uploadStaged(
        heights_.back(), raster.heights_msl_m,
        static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows), stream);
    raster.heights_msl_m = heights_.back().data();
  }
  rasters_.upload(rasters, stream);
}

}  // namespace emscape::emfield::cuda
