/// A transfer function as the ray caster reads it: tables for one sampling step.
#pragma once

#include <cstdint>
#include <vector>

#include "render/compositing.h"
#include "render/transfer_function.h"
#include "volume/bricks.h"

namespace emscape::render {

/// What SkipView refers to.
struct SkipLevels {
  std::vector<float> highest;
  std::vector<float> levels;
};

/// Samples a transfer function at equidistant values; a categorical one has one entry a category and one for
/// none.
/// @accuracy colours and opacities are those of a value within 1/8190 of the function's interval
class TransferTable {
 public:
  TransferTable(const TransferFunction& function, double step_voxels);

  TransferView view() const;
  /// @param iso_value  of the isosurface, in that mode
  SkipLevels skipLevels(const volume::BricksView& bricks, CompositingMode mode, float iso_value) const;

 private:
  /// Whether any value of a range has an opacity.
  bool anyVisible(const volume::ValueRange& range) const;

  std::vector<Rgba> samples_;
  std::vector<Rgba> projected_;
  std::vector<int> visible_before_;  ///< how many entries before each have an opacity
  double lowest_ = 0;
  double highest_ = 1;
};

}  // namespace emscape::render
