/// Transfer function laid out for vector lanes.
#pragma once

#include <vector>

#include "render/cells/integral/ray_integral.h"

namespace emscape::render {

/// A TransferInterval laid out for vector lanes.
struct LaneInterval {
  double lower, upper;
  double base;      ///< lower; 0 if the interval is uniform
  double per_unit;  ///< 1 / (upper - lower); 0 if the interval is uniform
  double extinction, extinction_rise;
  double color[3], color_rise[3];
  double clear;      ///< 1: no extinction; else 0
  double unused[3];  ///< padding to sixteen numbers, so that a shift gives the offset
};

/// Transfer function and Psi of all rays of a picture, as plain data.
struct LaneTransferView {
  IntervalsView intervals;
  PsiLookup psi;
  const LaneInterval* lanes = nullptr;  ///< the intervals
};

/// Owner of a LaneTransferView's memory.
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
