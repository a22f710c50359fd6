/// Rays through the cells of a mesh in the lanes of vector registers, on the CPU.
#pragma once

#include <vector>

#include "render/cells/cell_march.h"

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

  /// A TransferInterval as lanes read it.
  struct Interval {
    double lower, upper;
    double base;      ///< lower; 0 where the interval is uniform
    double per_unit;  ///< 1 / (upper - lower); 0 where the interval is uniform
    double extinction, extinction_rise;
    double color[3], color_rise[3];
    double clear;      ///< 1: no extinction; else 0
    double unused[3];  ///< sixteen numbers in all: lanes find theirs by a shift
  };

 private:
  CellMeshView mesh_;
  IntervalsView transfer_;
  PsiLookup psi_;
  std::vector<Interval> intervals_;
};

}  // namespace emscape::render
