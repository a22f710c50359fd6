/// A transfer function as the lanes of vector registers read it.
#pragma once

#include <vector>

#include "render/cells/ray_integral.h"

namespace emscape::render {

/// A TransferInterval as lanes read it.
struct LaneInterval {
  double lower, upper;
  double base;      ///< lower; 0 where the interval is uniform
  double per_unit;  ///< 1 / (upper - lower); 0 where the interval is uniform
  double extinction, extinction_rise;
  double color[3], color_rise[3];
  double clear;      ///< 1: no extinction; else 0
  double unused[3];  ///< sixteen numbers in all: lanes find theirs by a shift
};

/// What rays of a picture share, as plain data.
struct LaneTransferView {
  IntervalsView intervals;
  PsiLookup psi;
  const LaneInterval* lanes = nullptr;  ///< the intervals
};

/// The same with its memory.
class LaneTransfer {
 public:
  /// @param intervals, psi  must outlive this object; psi has a table
  LaneTransfer(const IntervalsView& intervals, const PsiLookup& psi);

  LaneTransferView view() const { return {intervals_, psi_, lanes_.data()}; }

 private:
  IntervalsView intervals_;
  PsiLookup psi_;
  std::vector<LaneInterval> lanes_;
};

}  // namespace emscape::render
