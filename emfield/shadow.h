/// Stage 2 of the model `horizon`: from a terrain fan to the height below which each column is in shadow.
#pragma once

#include <vector>

#include "emfield/terrain_fan.h"

namespace emscape::emfield {

/// For each column of the fan's intervals the z (m, in the grid's frame) of the shadow's edge: voxels at or
/// above it are lit. -infinity: nothing is in shadow; +infinity: all is; NaN: unknown, because the path
/// crosses missing terrain. A tilted column that leaves and enters shadow is in shadow up to its last dark
/// voxel; the fan must then hold all intervals.
/// @param edges_m  one per column; columns of other intervals are not changed
/// @accuracy against a walk along the ray: the fan's resolution
void findShadowEdges(const Station& station, const GridColumns& columns,
                     const std::vector<FanCoordinates>& coordinates, const FanShape& shape,
                     const TerrainFan& fan, std::vector<float>& edges_m);

}  // namespace emscape::emfield
