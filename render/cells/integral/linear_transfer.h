/// Transfer function as intervals with extinction and colour linear in the value.
#pragma once

#include <vector>

#include "emscape/render/transfer/transfer_function.h"
#include "render/cells/integral/ray_integral.h"

namespace emscape::render {

/// Colour and opacity a are linear between two control points of the transfer function. The extinction of one
/// reference step, -ln(1 - a), is not: control points are added until the opacity of a step differs from the
/// function's by at most kOpacityError. Discontinuities are kept. Opacity 1 is replaced by 1 - 2^-24.
class LinearTransfer {
 public:
  static constexpr double kOpacityError = 1e-4;

  /// @param function  not categorical
  explicit LinearTransfer(const TransferFunction& function);

  const std::vector<TransferInterval>& intervals() const { return intervals_; }
  /// Valid during this object's lifetime.
  IntervalsView view() const { return {intervals_.data(), static_cast<int>(intervals_.size())}; }

 private:
  std::vector<TransferInterval> intervals_;
};

}  // namespace emscape::render
