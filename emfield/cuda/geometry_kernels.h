/// Stages 1 and 2 on the device: columns, fans, shadow edges of several emitters at once.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>

#include "emfield/combine.h"
#include "emfield/shadow_edge.h"
#include "emfield/terrain_fan.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield::cuda {

/// The grid's columns on the device.
struct DeviceColumns {
  const GridColumn* columns = nullptr;
  int count = 0;
  int row = 0;  ///< columns along x
  const float* t_m = nullptr;
  int layers = 0;
  double middle_m = 0;
  bool tilted = false;
};

/// Counters of the kernels for an emitter.
struct GeometryCounts {
  int unknown_columns = 0;
  unsigned warnings = 0;  ///< of the excess model, on all columns
  unsigned long long near_voxels = 0;
};

/// A column's coordinates in a fan.
struct FanIndex {
  double azimuth_index = 0;
  double range_m = 0;
};

/// An emitter whose columns are located. Pointers are to device memory.
struct LocateTask {
  Station station;
  FanView fan;                      ///< range_count 0: no fan is needed
  float* numbers = nullptr;         ///< kColumnNumbers x columns
  float* shadow_edge_m = nullptr;   ///< initialised with "nothing is in shadow"
  FanIndex* fan_indices = nullptr;  ///< one per column
  /// One per azimuth: the number of ranges nearer than some column. Tilted columns need all ranges.
  int* used_ranges = nullptr;
  float near2_m2 = 0;  ///< square of the far field's distance
  GeometryCounts* counts = nullptr;
};

/// Some neighbouring intervals of an emitter's fan. Pointers are to device memory.
struct FanSector {
  LocateTask emitter;
  int first_interval = 0, interval_count = 0;
  scenario::TerrainView terrain;
  bool has_terrain = false;            ///< false: a smooth earth at mean sea level
  RangeTerms<float>* terms = nullptr;  ///< of the fan's ranges
  bool holds_slopes = true;            ///< false: heights
  /// Of (interval_count + 1) azimuths and the fan's ranges: heights above mean sea level, or slopes to the
  /// terrain, later replaced by the grazing slopes.
  float* samples = nullptr;
  long long azimuth_stride = 0, range_stride = 0;

  /// Number of samples needed on an azimuth of the sector.
  EMSCAPE_HD int usedRanges(int azimuth) const {
    const int used = emitter.used_ranges[first_interval + azimuth];
    return used < emitter.fan.range_count ? used : emitter.fan.range_count;
  }
};

/// Computes the numbers, fan indices and used ranges of all columns, and counts near voxels.
void locateColumns(const LocateTask* tasks, int count, const DeviceColumns& columns, cudaStream_t stream);

/// Launch dimensions for a batch of sectors: the maximum over them.
struct SectorExtent {
  int sectors = 0;
  int azimuths = 0;
  int ranges = 0;
};
/// Reads the terrain along the azimuths of the sectors.
void readFans(const FanSector* sectors, const SectorExtent& extent, cudaStream_t stream);
/// Converts slopes to grazing slopes, and these to the columns' shadow edges; counts unknown columns.
void findShadowEdges(const FanSector* sectors, const SectorExtent& extent, const DeviceColumns& columns,
                     cudaStream_t stream);

}  // namespace emscape::emfield::cuda
