/// Stages 3 and 4 on the device.
#pragma once

#include <cuda_runtime_api.h>

#include <vector>

#include "emfield/channels/products.h"
#include "emfield/combine/combine.h"
#include "emfield/combine/occupancy.h"
#include "volume/cuda/device_storage.h"

namespace emscape::emfield::cuda {

/// One pass over the grid, as combineCpu(): all pointers are to device memory.
/// @param first_valid_k  lowest layer above ground of each column, null: 0. Values below it are undefined.
void combine(const CombineTask& task, const std::uint16_t* first_valid_k, cudaStream_t stream);

/// One radar's pass, as radarCpu(): all pointers are to device memory.
/// @param first_valid_k  as for combine
void addRadar(const RadarPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream);

/// One emitter's pass, as occupancyCpu(): all pointers are to device memory.
/// @param first_valid_k  as for combine
void addOccupancy(const OccupancyPass& pass, const std::uint16_t* first_valid_k, cudaStream_t stream);

/// How the sums of two groups of emitters become that of all.
enum class Merge {
  add,
  either,  ///< probability of at least one of two independent events: a + b (1 - a)
  larger,
  stronger  ///< the value of the larger `second`
};
/// @param plan  of a channel
Merge mergeOf(const ChannelPlan& plan);

/// Merges two groups' sums of all voxels, on the stream. @param into  may be `a`
void mergeSums(Merge merge, ConstAccumulator a, ConstAccumulator b, Accumulator into, std::size_t voxels,
               cudaStream_t stream);

/// A value range that kernels extend: floats as integers of the same order.
struct DeviceRange {
  unsigned lowest = ~0u, highest = 0;

  /// @return empty if nothing is above the floor
  volume::ValueRange range(float floor) const;
};

/// One channel's values into a volume.
struct DeviceProductTask {
  ProductScale product;
  const float* accumulator = nullptr;
  const float* second = nullptr;                ///< see Accumulator
  const std::int32_t* first_valid_k = nullptr;  ///< null: all voxels are valid
  volume::VoxelWriter voxels;
  DeviceRange* range = nullptr;  ///< in device memory, reset
};
void makeProduct(const DeviceProductTask& task, cudaStream_t stream);

}  // namespace emscape::emfield::cuda
