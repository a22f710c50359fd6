#include "emfield/cuda/device_terrain.h"

namespace emscape::emfield::cuda {
DeviceTerrain::DeviceTerrain(const scenario::TerrainView& terrain) {
  std::vector<scenario::TerrainRaster> rasters(terrain.rasters, terrain.rasters + terrain.count);
  for (scenario::TerrainRaster& raster : rasters) {
    heights_.emplace_back();
    heights_.back().upload(raster.heights_msl_m,
                           static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows));
    raster.heights_msl_m = heights_.back().data();
  }
  rasters_.upload(rasters);
}

}  // namespace emscape::emfield::cuda
