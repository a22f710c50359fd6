/// Statistics of the values of a volume.
#pragma once

#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Counts over all voxels; minimum, maximum and mean over the valid voxels, which are neither masked nor NaN.
struct Statistics {
  long long voxels = 0;
  long long valid = 0;
  long long masked = 0;
  long long nan = 0;       ///< of those not masked
  long long at_floor = 0;  ///< valid ones without a field
  float min = 0;           ///< over the valid voxels; 0 if there are none
  float max = 0;
  double mean = 0;
};

/// Computed in parallel; bit-identical for any number of threads.
Statistics statisticsOf(const DenseVolume& volume);

/// Counts of valid voxels in equal bins.
struct Histogram {
  float lower = 0;  ///< lower edge of the first bin
  float upper = 0;  ///< upper edge of the last bin, which includes it
  std::vector<long long> counts;
  long long below = 0;  ///< less than lower
  long long above = 0;  ///< greater than upper
};

/// @param bins  1..65536, @param lower, @param upper  finite, lower < upper
/// @throws Error (bad_input) outside these
Histogram histogramOf(const DenseVolume& volume, int bins, float lower, float upper);

/// Whether the range in a volume's metadata is that of a volume without a value: all voxels are masked or at
/// the floor.
bool holdsNothing(const VolumeInfo& info);

/// Sets info.range_min and range_max to the smallest and largest valid finite value that is not the floor;
/// both to the floor if there is none, or to 0 if the floor is kNoFloor.
void setRangeFromValues(DenseVolume& volume);

}  // namespace emscape::volume
