/// Rays through the cells of a mesh, on the CPU: the oracle of cell projection, and what is drawn without a
/// GPU.
#pragma once

#include <vector>

#include "render/cells/cell_walk.h"

namespace emscape::render {

/// The cell that holds a position (index space); -1 if none does. Looks at all cells, in parallel.
int cellAt(const CellMesh& mesh, const Vec3d& position);

/// A ray that is to be marched.
struct MarchTask {
  RayFrame frame;
  MarchLimits limits;
  std::vector<EntryHit> entries;  ///< ascending
  Rgba color{};                   ///< what it gathers; the march sets it
};

/// Marches rays one after another, each from every entry, and counts what it has not passed yet: a mesh that
/// is not convex is left and entered again.
/// @return the number of cells that were passed
long long marchInTurn(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi,
                      MarchTask* tasks, int count);

}  // namespace emscape::render
