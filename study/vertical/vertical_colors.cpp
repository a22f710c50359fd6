#include "study/vertical/vertical_colors.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace emscape::study {
namespace {

constexpr int kColors = 48;      ///< shades of the scale
constexpr double kSpan_db = 80;  ///< of the scale, below the strongest values

}  // namespace

VerticalColors::VerticalColors(const VerticalDiagram& diagram)
    : is_part_(diagram.unit.empty()), floor_(diagram.floor) {
  std::vector<float> known;
  for (const VerticalCut& cut : diagram.cuts) {
    std::copy_if(cut.values.begin(), cut.values.end(), std::back_inserter(known),
                 [&](float value) { return std::isfinite(value) && hasField(value); });
  }
  std::sort(known.begin(), known.end());
  if (!is_part_ && !known.empty()) {
    // Close to the emitter the values increase without limit: the uppermost hundredth is left out.
    const auto strong = static_cast<double>(known[known.size() * 99 / 100]);
    high_ = 10 * std::ceil(strong / 10);
    low_ = std::max(10 * std::floor(static_cast<double>(known.front()) / 10), high_ - kSpan_db);
    if (high_ - low_ < 10) low_ = high_ - 10;
  }
  for (const render::ColorMap::Point& point : render::colorMap("viridis").points) {
    function_.colors.push_back({low_ + point.at * (high_ - low_), point.color});
  }
  function_.opacities = {{low_, 0}, {high_, 0}};
}

int VerticalColors::shadeOf(float value) const {
  if (std::isnan(value) || !hasField(value)) return -1;
  const double part = (static_cast<double>(value) - low_) / (high_ - low_);
  return std::clamp(static_cast<int>(part * kColors), 0, kColors - 1);
}

render::Ink VerticalColors::inkOf(int shade) const {
  return {function_.color(low_ + (shade + 0.5) / kColors * (high_ - low_))};
}

}  // namespace emscape::study
