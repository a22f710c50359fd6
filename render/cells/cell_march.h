/// Ray casting through the cells of a mesh on the CPU; the reference for cell projection.
#pragma once

#include <vector>

#include "render/cells/cell_walk.h"

namespace emscape::render {

/// Cell that contains a position (index space); -1: none. Tests all cells, in parallel.
int cellAt(const CellMesh& mesh, const Vec3d& position);

/// A ray to be marched.
struct MarchTask {
  RayFrame frame;
  MarchLimits limits;
  std::vector<EntryHit> entries;  ///< ascending
  Rgba color{};                   ///< result of the march
};

/// Marches rays one after another, each from all its entries; parts already marched are skipped. A ray may
/// leave and re-enter a mesh that is not convex.
/// @return the number of cells crossed
long long marchInTurn(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi,
                      MarchTask* tasks, int count);

}  // namespace emscape::render
