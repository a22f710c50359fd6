#include "volume/nvdb/nanovdb_grid.h"

#include <algorithm>

namespace emscape::volume {

DenseVolume readyForSampling(const DenseVolume& volume) {
  DenseVolume ready = volume;
  ready.info.categorical = false;
  ready.first_valid_k.clear();
  if (volume.first_valid_k.empty()) return ready;
  const Dims& dims = volume.grid.dims;
  const auto first = [&](int i, int j) -> int {
    return volume.first_valid_k[static_cast<std::size_t>(j) * dims.x + i];
  };
  for (int j = 0; j < dims.y; ++j) {
    for (int i = 0; i < dims.x; ++i) {
      const int own = std::min(first(i, j), dims.z - 1);
      int reached = own;  // the lowest voxel that is a neighbour of one above ground
      for (int v = std::max(j - 1, 0); v <= std::min(j + 1, dims.y - 1); ++v) {
        for (int u = std::max(i - 1, 0); u <= std::min(i + 1, dims.x - 1); ++u) {
          reached = std::min(reached, first(u, v) - 1);
        }
      }
      const float above = volume.values[static_cast<std::size_t>(volume.grid.index(i, j, own))];
      for (int k = 0; k < own; ++k) {
        ready.values[static_cast<std::size_t>(volume.grid.index(i, j, k))] =
            k < reached ? volume.info.floor : above;
      }
    }
  }
  return ready;
}

}  // namespace emscape::volume
