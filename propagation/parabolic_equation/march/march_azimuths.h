/// March of the parabolic equation over all azimuths around an emitter.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "propagation/parabolic_equation/march/march_cells.h"

namespace emscape::propagation {

/// One emitter's march: parameters common to its azimuths, and those of each azimuth.
struct AzimuthMarch {
  MarchGrid grid;
  PeSource source;
  PeSurface surface;
  RadialCells cells;
  int azimuths = 0;
  /// Number of range cells marched of each azimuth; empty: all.
  std::vector<int> ranges;
  /// One for all azimuths, or one per azimuth.
  std::vector<RefractivityAlongPath> air;
  /// Heights above mean sea level at 0, 1, 2, ... range steps, `ground_steps` of them per azimuth; level
  /// beyond the last. Empty: 0 m everywhere.
  std::vector<float> ground_msl_m;
  std::size_t ground_steps = 0;

  int rangesOf(int azimuth) const { return ranges.empty() ? cells.ranges : ranges[std::size_t(azimuth)]; }
  /// Max number of range cells over the group of kStepLanes azimuths marched together on a CPU.
  int rangesOfGroup(int azimuth) const;
  /// Number of range cells of all azimuths; times the grid's heights, it gives the cost of the march.
  long long rangesOfAll() const {
    return ranges.empty() ? static_cast<long long>(azimuths) * cells.ranges
                          : std::accumulate(ranges.begin(), ranges.end(), 0LL);
  }
  /// Number of losses of all azimuths.
  std::size_t cellCount() const { return std::size_t(azimuths) * cells.ranges * cells.heights; }
};

/// @throws Error (bad_input) for a grid outside its limits (checkGrid()), cells shorter than a range step, or
/// sizes that do not fit
void checkMarch(const AzimuthMarch& march);

/// Marches all azimuths in float, in parallel.
/// @param excess_db  cellCount() elements: losses over free space (dB) as of marchCells(), azimuth slowest,
/// then range, then height; those beyond rangesOf() an azimuth are not written
/// @throws Error (bad_input) as RadialMarch() and marchCells(), for N below kMinBlockIntervals, or if the
/// sizes do not fit
void marchAzimuths(const AzimuthMarch& march, float* excess_db);

/// Limits of N on the GPU; the smaller one also on the CPU. automaticGrid() gives at least 256.
constexpr int kMinBlockIntervals = 128, kMaxBlockIntervals = 8192;

/// marchAzimuths() on the GPU, without halving within 0.05 dB of it where F > -60 dB.
/// @throws Error (device) without CUDA or a GPU; (bad_input) also for N outside 128 .. 8192, and for the
/// narrow form over terrain
void marchAzimuthsOnGpu(const AzimuthMarch& march, float* excess_db);

/// |u| of an azimuth after a step, at heights above the ground 0, 1, ... height steps.
struct FieldColumn {
  double range_m = 0, ground_msl_m = 0, height_step_m = 0;
  std::vector<float> amplitude;
};
/// Columns of the GPU's march, for comparison with RadialMarch.
/// @param steps  ascending, 1 or more
/// @return azimuths x steps
/// @throws as marchAzimuthsOnGpu()
std::vector<FieldColumn> columnsOnGpu(const AzimuthMarch& march, const std::vector<int>& steps);

}  // namespace emscape::propagation
