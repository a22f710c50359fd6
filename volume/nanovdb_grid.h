/// Dense volumes as NanoVDB grids. Internal to the module.
#pragma once

#include "emscape/volume/dense_volume.h"
#include "volume/nanovdb_wrapper.h"

namespace emscape::volume {

/// A grid of the voxels that are neither masked nor at the floor: of floats, of a categorical volume of
/// int32.
/// @throws Error (bad_input) at `place` for categorical values that are no indices
nano::Handle toNano(const DenseVolume& volume, const SourceLocation& place);

/// What toNano() makes a grid of floats from that can be sampled between voxels: nothing is masked, but what
/// was holds the value of the first voxel above it that was not where a sample in the air can reach it, and
/// the floor elsewhere.
DenseVolume readyForSampling(const DenseVolume& volume);

}  // namespace emscape::volume
