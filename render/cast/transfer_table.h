/// A transfer function for the ray caster: tables for one sampling step.
#pragma once

#include <vector>

#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "render/cast/compositing.h"
#include "render/cast/skip_rule.h"
#include "volume/bricks.h"

namespace emscape::render {

/// Samples a transfer function at equidistant values; a categorical one has one entry per category and one
/// for none.
/// @accuracy colours and opacities are those of a value within 1/8190 of the function's interval
class TransferTable {
 public:
  TransferTable(const TransferFunction& function, double step_voxels);

  TransferView view() const;
  /// The colour of each entry, opaque.
  const std::vector<Rgba>& opaque() const { return opaque_; }
  /// @param iso_value  of the isosurface, in that mode
  SkipRule skipRule(CompositingMode mode, float iso_value) const;
  int entries() const { return static_cast<int>(samples_.size()); }

 private:
  std::vector<Rgba> samples_;
  std::vector<Rgba> projected_;
  std::vector<Rgba> opaque_;
  std::vector<int> visible_before_;  ///< number of entries before each with an opacity
  double lowest_ = 0;
  double highest_ = 1;
};

/// The data of SkipView.
struct SkipLevels {
  std::vector<float> highest;
  std::vector<float> levels;
};
SkipLevels skipLevels(const SkipRule& rule, const volume::BricksView& bricks);

}  // namespace emscape::render
