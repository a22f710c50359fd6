/// Stage 2 of the model `horizon`: from a terrain fan to the height below which each column lies in shadow.
#pragma once

#include <vector>

#include "emfield/terrain_fan.h"

namespace emscape::emfield {

/// For each column the z (m, in the grid's frame) of the shadow's edge: voxels at or above it are lit.
/// -infinity: nothing is in shadow; +infinity: all is; NaN: unknown, because the path crosses missing
/// terrain. A leaning column that leaves and enters shadow counts as shadow up to its last dark voxel.
/// @accuracy against a walk along the ray: the fan's resolution
std::vector<float> shadowEdges(const Station& station, const GridColumns& columns,
                               const std::vector<FanCoordinates>& coordinates, const TerrainFan& fan);

}  // namespace emscape::emfield
