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

/// What the kernels count for an emitter.
struct GeometryCounts {
  int unknown_columns = 0;
  unsigned remarks = 0;  ///< of the excess model, on all columns
  unsigned long long near_voxels = 0;
};

/// A column's place in a fan.
struct FanPlace {
  double azimuth_index = 0;
  double range_m = 0;
};

/// An emitter whose columns are located. Pointers are to device memory.
struct LocateTask {
  Station station;
  FanView fan;                     ///< range_count 0: no fan is needed
  float* numbers = nullptr;        ///< kColumnNumbers x columns
  float* shadow_edge_m = nullptr;  ///< set to "nothing is in shadow"
  FanPlace* places = nullptr;      ///< one a column
  /// One an azimuth, raised to the ranges that some column lies behind. Columns that lean may do so anywhere.
  int* used_ranges = nullptr;
  float near2_m2 = 0;  ///< square of the far field's distance
  GeometryCounts* counts = nullptr;
};

/// Some neighbouring intervals of an emitter's fan. Pointers are to device memory.
struct FanPiece {
  LocateTask emitter;
  int first_interval = 0, interval_count = 0;
  scenario::TerrainView terrain;
  bool has_terrain = false;            ///< false: a smooth earth at mean sea level
  RangeTerms<float>* terms = nullptr;  ///< of the fan's ranges
  bool holds_slopes = true;            ///< false: heights
  /// Of (interval_count + 1) azimuths and the fan's ranges: heights above mean sea level, or slopes to the
  /// terrain and in the end the grazing slopes.
  float* samples = nullptr;
  long long azimuth_stride = 0, range_stride = 0;

  /// Samples of the piece's azimuth that are needed.
  EMSCAPE_HD int usedRanges(int azimuth) const {
    const int used = emitter.used_ranges[first_interval + azimuth];
    return used < emitter.fan.range_count ? used : emitter.fan.range_count;
  }
};

/// Numbers, places and used ranges of all columns; near voxels.
void locateColumns(const LocateTask* tasks, int count, const DeviceColumns& columns, cudaStream_t stream);

/// What the largest of some pieces needs of a launch.
struct PieceExtent {
  int pieces = 0;
  int azimuths = 0;
  int ranges = 0;
};
/// Terrain along the azimuths of some pieces.
void readFans(const FanPiece* pieces, const PieceExtent& extent, cudaStream_t stream);
/// Slopes of the pieces that hold them become grazing slopes, and these the columns' shadow edges; counts
/// what is unknown.
void findShadowEdges(const FanPiece* pieces, const PieceExtent& extent, const DeviceColumns& columns,
                     cudaStream_t stream);

}  // namespace emscape::emfield::cuda
