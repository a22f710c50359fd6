/// A transfer function as the ray caster reads it: tables for one sampling step.
#pragma once

#include <cstdint>
#include <vector>

#include "render/compositing.h"
#include "render/transfer_function.h"
#include "volume/bricks.h"

namespace emscape::render {

/// Samples a transfer function at equidistant values; a categorical one has one entry a category and one for
/// none.
/// @accuracy colours and opacities are those of a value within 1/8190 of the function's interval
class TransferTable {
 public:
  TransferTable(const TransferFunction& function, double step_voxels);

  TransferView view() const;
  /// For each brick: 1 if no value within its range has any opacity, so that no sample of it shows.
  std::vector<std::uint8_t> transparentBricks(const volume::BricksView& bricks) const;

 private:
  std::vector<Rgba> samples_;
  std::vector<Rgba> projected_;
  std::vector<int> visible_before_;  ///< how many entries before each have an opacity
  double lowest_ = 0;
  double highest_ = 1;
};

}  // namespace emscape::render
