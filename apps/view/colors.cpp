#include "apps/view/colors.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::view {

render::TransferFunction adjusted(const render::TransferFunction& function,
                                  const ColorAdjustment& adjustment) {
  render::TransferFunction result = function;
  if (function.categorical || adjustment.empty()) return result;
  const double lowest = function.lowest();
  const double highest = function.highest();
  if (!adjustment.color_map.empty()) {
    result.name = adjustment.color_map;
    result.colors.clear();
    for (const render::ColorMap::Point& point : render::colorMap(adjustment.color_map).points) {
      result.colors.push_back({lowest + point.at * (highest - lowest), point.color});
    }
  }
  for (auto& point : result.opacities) {
    point.opacity = std::clamp(point.opacity * adjustment.opacity_factor, 0.0, 1.0);
  }
  if (adjustment.range) {
    const double min = adjustment.range->min;
    const double max = adjustment.range->max;
    if (!(min < max))
      throw Error(ErrorCode::bad_input, fmt::format("range {:g}..{:g}: expected MIN below MAX", min, max));
    const auto moved = [&](double at) { return min + (at - lowest) / (highest - lowest) * (max - min); };
    for (auto& point : result.colors) point.at = moved(point.at);
    for (auto& point : result.opacities) point.at = moved(point.at);
  }
  return result;
}

}  // namespace emscape::view
