/// Rays through the cells of a mesh, on the CPU: the oracle of cell projection, and what is drawn without a
/// GPU.
#pragma once

#include <vector>

#include "render/cells/cell_walk.h"

namespace emscape::render {

/// The cell that holds a position (index space); -1 if none does. Looks at all cells, in parallel.
int cellAt(const CellMesh& mesh, const Vec3d& position);

/// Marches from every entry, in ascending order, and counts what the ray has not passed yet: a mesh that is
/// not convex is left and entered again.
/// @param entries  sorted here
void marchAll(const CellMeshView& mesh, const RayFrame& frame, std::vector<EntryHit>& entries,
              const MarchLimits& limits, RayIntegral& integral, long long& cells);

}  // namespace emscape::render
