/// Stage 2 of the model `horizon` over many vertical columns: most are decided by bounds of the slopes to the
/// terrain, which the paths of a sector share; of the others a part of the path is read.
#pragma once

#include <vector>

#include "emfield/excess/shadow_edge.h"
#include "emfield/ground/terrain_bounds.h"

namespace emscape::emfield {

/// Sets the edges of shadow of vertical columns. The heights of a column are above or below its edge
/// as they are by ShadowTask::edge_m(); the edge may differ between them.
/// @param task    with terms of the posts
/// @param bounds  usable
/// @return for each column whether it is left: those beside missing terrain, and others
std::vector<char> findSurfaceShadows(const ShadowTask& task, const ExcessGrid& grid,
                                     const TerrainBounds& bounds, float* edges_m);

}  // namespace emscape::emfield
