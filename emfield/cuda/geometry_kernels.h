/// Stages 1 and 2 on the device: columns and shadow edges of several emitters at once.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

#include "emfield/combine/combine.h"
#include "emfield/excess/shadow_edge.h"
#include "emfield/geometry/clutter_map.h"

namespace emscape::emfield::cuda {

/// The grid's columns on the device.
struct DeviceColumns {
  ColumnsView columns;
  int count = 0;
  int row = 0;  ///< columns along x
  const float* t_m = nullptr;
  int layers = 0;
  double middle_m = 0;
};

/// Counters of the kernels for an emitter.
struct GeometryCounts {
  int unknown_columns = 0;
  unsigned warnings = 0;  ///< of the excess model, on all columns
  unsigned long long near_voxels = 0;
};

/// An emitter whose columns are located. Pointers are to device memory.
struct LocateTask {
  Station station;
  float* numbers = nullptr;        ///< kColumnNumbers x columns
  float* shadow_edge_m = nullptr;  ///< initialised with "nothing is in shadow"
  float near2_m2 = 0;              ///< square of the far field's distance
  GeometryCounts* counts = nullptr;
};

/// An emitter of the model `horizon`. Pointers are to device memory.
struct DeviceShadowTask {
  ShadowTask task;
  RangeTerms<float>* terms = nullptr;  ///< those of the task; overwritten
  float* shadow_edge_m = nullptr;      ///< one per column; overwritten
  GeometryCounts* counts = nullptr;
};

/// Computes the numbers of all columns and counts near voxels.
void locateColumns(const LocateTask* tasks, int count, const DeviceColumns& columns, cudaStream_t stream);

/// Finds the columns' shadow edges and counts unknown columns.
/// @param ranges  the largest number of posts of a task
/// @param grid    of device memory
/// @param row     columns along x
void findShadowEdges(const DeviceShadowTask* tasks, int count, int ranges, const ExcessGrid& grid, int row,
                     cudaStream_t stream);

/// Sets the bytes of columns with an unknown shadow edge to 1, the others to 0.
void markUnknownColumns(const float* shadow_edge_m, int columns, std::uint8_t* unknown, cudaStream_t stream);

/// Fills a radar's map of surface clutter, as fillClutterMapCpu(). Pointers are to device memory.
void fillClutterMap(const ClutterMapTask& task, ClutterCell* cells, cudaStream_t stream);

}  // namespace emscape::emfield::cuda
