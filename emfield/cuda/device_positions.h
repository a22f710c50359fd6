/// The columns of a surface in the memory of the GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "base/cuda/cuda_memory.h"
#include "emfield/columns/grid_columns.h"
#include "emfield/cuda/device_terrain.h"

namespace emscape::emfield::cuda {

/// Results of a PositionTask, with the terrain from which they were computed.
struct DevicePositions {
  std::shared_ptr<const DeviceTerrain> terrain;  ///< null: none
  emscape::cuda::Buffer<PositionColumn> columns;
  emscape::cuda::Buffer<float> ground_msl_m;  ///< empty without terrain
  emscape::cuda::Buffer<std::uint16_t> first_valid_k;

  std::size_t bytes() const {
    return columns.size() * sizeof(PositionColumn) + ground_msl_m.size() * sizeof(float) +
           first_valid_k.size() * sizeof(std::uint16_t);
  }
};

}  // namespace emscape::emfield::cuda
