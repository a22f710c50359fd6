#include "render/cast/transfer_table.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"

namespace emscape::render {
namespace {

constexpr int kEntries = 4096;
constexpr double kMaxCategories = 65536;

Rgba premultiplied(const Rgb& color, double opacity) {
  const float a = static_cast<float>(opacity);
  return {color.r * a, color.g * a, color.b * a, a};
}

}  // namespace

TransferTable::TransferTable(const TransferFunction& function, double step_voxels) {
  if (function.opacities.empty()) throw Error(ErrorCode::other, "transfer function without points");
  int entries = kEntries;
  lowest_ = function.lowest();
  highest_ = function.highest();
  if (function.categorical) {
    lowest_ = -1;  // none
    highest_ = std::clamp(std::floor(highest_ + 0.5), 0.0, kMaxCategories);
    entries = static_cast<int>(highest_ - lowest_) + 1;
  }
  std::vector<double> opacities;
  double largest = 0;
  const double spacing = (highest_ - lowest_) / (entries - 1);
  for (int i = 0; i < entries; ++i) {
    opacities.push_back(function.opacity(lowest_ + i * spacing));
    largest = std::max(largest, opacities.back());
  }
  visible_before_.push_back(0);
  for (int i = 0; i < entries; ++i) {
    const double opacity = opacities[static_cast<std::size_t>(i)];
    const Rgb color = function.color(lowest_ + i * spacing);
    samples_.push_back(premultiplied(color, 1 - std::pow(1 - opacity, step_voxels)));
    opaque_.push_back(premultiplied(color, 1));
    projected_.push_back(premultiplied(color, largest > 0 ? opacity / largest : 0));
    visible_before_.push_back(visible_before_.back() + (samples_.back().a > 0 ? 1 : 0));
  }
}

TransferView TransferTable::view() const {
  return {samples_.data(), projected_.data(), static_cast<int>(samples_.size()) - 1,
          static_cast<float>(lowest_), static_cast<float>(1.0 / (highest_ - lowest_))};
}

SkipRule TransferTable::skipRule(CompositingMode mode, float iso_value) const {
  return {view(), visible_before_.data(), mode, iso_value};
}

SkipLevels skipLevels(const SkipRule& rule, const volume::BricksView& bricks) {
  if (bricks.edge != 1 << SkipView::kEdgeBits) throw Error(ErrorCode::other, "bricks of another size");
  const std::size_t count = static_cast<std::size_t>(bricks.dims.count());
  SkipLevels skip{std::vector<float>(count), std::vector<float>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const BrickLevel brick = rule.of(bricks.ranges[i]);
    skip.highest[i] = brick.highest;
    skip.levels[i] = brick.level;
  }
  return skip;
}

}  // namespace emscape::render
