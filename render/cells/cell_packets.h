/// Rays through the cells of a mesh in the lanes of vector registers, on the CPU.
#pragma once

#include "render/cells/cell_march.h"
#include "render/cells/lane_transfer.h"

namespace emscape::render {

/// Marches rays as marchInTurn() does, each in a lane of its own; a lane whose ray has ended takes the next
/// ray. What rays span with edges is computed as there, so that the same cells are passed; colours differ by
/// less than 1e-6, as the exponential and fused products round otherwise. Without AVX2 it is marchInTurn().
class CellPackets {
 public:
  /// @param mesh, psi  must outlive this object; psi has a table
  CellPackets(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi);

  /// @return the number of cells that were passed
  long long march(MarchTask* tasks, int count) const;

 private:
  CellMeshView mesh_;
  LaneTransfer transfer_;
};

}  // namespace emscape::render
