/// Dense volumes as NanoVDB grids. Internal to the module.
#pragma once

#include "emscape/volume/dense_volume.h"
#include "volume/sparse/nanovdb_wrapper.h"

namespace emscape::volume {

/// A grid of the voxels that are neither masked nor at the floor: of floats, or of int32 for a categorical
/// volume.
/// @throws Error (bad_input) at `location` for categorical values that are not indices
nano::Handle toNano(const DenseVolume& volume, const SourceLocation& location);

/// The volume from which toNano() makes a grid of floats for sampling between voxels: without a mask. Masked
/// voxels that a sample above ground can reach repeat the first value above them; the others have the floor.
DenseVolume readyForSampling(const DenseVolume& volume);

}  // namespace emscape::volume
