/// A transfer function as intervals on which extinction and colour are linear in the value.
#pragma once

#include <vector>

#include "emscape/render/transfer_function.h"
#include "render/cells/ray_integral.h"

namespace emscape::render {

/// Between two control points of the transfer function its colour is linear. Its opacity a is linear as well,
/// and with it the extinction of one reference step, -ln(1 - a), is not: control points are added until the
/// opacity of a step differs from the function's by at most kOpacityError. A jump stays a jump. Opacity 1 is
/// taken for 1 - 2^-24.
class LinearTransfer {
 public:
  static constexpr double kOpacityError = 1e-4;

  /// @param function  not categorical
  explicit LinearTransfer(const TransferFunction& function);

  const std::vector<TransferInterval>& intervals() const { return intervals_; }
  /// Valid as long as this object.
  IntervalsView view() const { return {intervals_.data(), static_cast<int>(intervals_.size())}; }

 private:
  std::vector<TransferInterval> intervals_;
};

}  // namespace emscape::render
