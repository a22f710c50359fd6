/// Stage 2 of the model `horizon` on the CPU.
#pragma once

#include "emfield/excess/fill_excess.h"

namespace emscape::emfield {

/// The z of the shadow's edge in each column; see ShadowTask.
/// @param bounds   of the terrain, for vertical columns, whose edges are only as precise as their heights
/// need; null: none
/// @param edges_m  one per column of the grid
void findShadowEdgesCpu(const Station& station, const GroundPosts& ground, const ExcessGrid& grid,
                        const TerrainBounds* bounds, float* edges_m);

}  // namespace emscape::emfield
