/// Ray casting through the cells of a mesh on the CPU, vectorised: one ray per lane.
#pragma once

#include "render/cells/cell_march.h"
#include "render/cells/integral/lane_transfer.h"

namespace emscape::render {

/// Marches rays as marchInTurn() does, one ray per lane; a lane whose ray has ended takes the next ray. Areas
/// between rays and edges are computed identically, so that the same cells are crossed. Colours differ by
/// less than 1e-6: the exponential and fused products round differently. Without AVX2 it calls marchInTurn().
class CellPackets {
 public:
  /// @param mesh, psi  must outlive this object; psi has a table
  CellPackets(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi);

  /// @return the number of cells crossed
  long long march(MarchTask* tasks, int count) const;

 private:
  CellMeshView mesh_;
  LaneTransfer transfer_;
};

}  // namespace emscape::render
