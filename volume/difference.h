/// Difference of two volumes.
#pragma once

#include <string>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// a - b, voxel by voxel, in the unit of differences of the quantity: dB for all decibels, else the
/// quantity's own. A voxel without a field has the value of the quantity's floor: if only one of the volumes
/// has a field, the difference is to the floor; if neither has one, it is 0. Voxels that are masked in one of
/// the volumes are masked. info.floor is 0, info.range_* the range of the values other than 0 (both 0 if
/// there are none).
/// @throws Error (bad_input) if grids, quantities or units differ, and for indices
DenseVolume difference(const DenseVolume& a, const DenseVolume& b);

/// Description of the difference of two volumes of a quantity: name and unit, kDifferenceScale, no
/// range. power_density_dbwm2 becomes power_density_difference_db.
VolumeInfo differenceInfo(const VolumeInfo& of);
bool isDifference(const VolumeInfo& info);
/// @throws Error (bad_input) that names the quantity, for indices
void requireDifference(const std::string& quantity, bool categorical);

}  // namespace emscape::volume
