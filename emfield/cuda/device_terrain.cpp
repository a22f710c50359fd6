#include "emfield/cuda/device_terrain.h"

#include "base/cuda/staged_copy.h"

namespace emscape::emfield::cuda {

DeviceTerrain::DeviceTerrain(const scenario::TerrainView& terrain, cudaStream_t stream)
    : cover_(terrain.cover) {
  upload(terrain.rasters, terrain.count, rasters_, stream);
  upload(terrain.surfaces, terrain.surface_count, surfaces_, stream);
  if (terrain.count > 0) tile_heights_.upload(highestOfTiles(terrain.rasters[0], tile_columns_), stream);
  if (!cover_.isSet()) return;
  emscape::cuda::uploadStaged(
      cover_cells_, cover_.cells,
      static_cast<std::size_t>(cover_.columns) * static_cast<std::size_t>(cover_.rows), stream);
  cover_classes_.upload(
      std::vector<scenario::CoverValues>(cover_.classes, cover_.classes + cover_.class_count), stream);
  cover_.cells = cover_cells_.data();
  cover_.classes = cover_classes_.data();
}

void DeviceTerrain::upload(const scenario::TerrainRaster* from, int count,
                           emscape::cuda::Buffer<scenario::TerrainRaster>& to, cudaStream_t stream) {
  std::vector<scenario::TerrainRaster> rasters(from, from + count);
  for (scenario::TerrainRaster& raster : rasters) {
    heights_.emplace_back();
    emscape::cuda::uploadStaged(
        heights_.back(), raster.heights_msl_m,
        static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows), stream);
    raster.heights_msl_m = heights_.back().data();
  }
  if (!rasters.empty()) to.upload(rasters, stream);
}

}  // namespace emscape::emfield::cuda
