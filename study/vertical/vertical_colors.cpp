#include "study/vertical/vertical_colors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "emscape/base/work.h"

namespace emscape::study {
namespace {

constexpr int kColors = 48;      ///< shades of the scale
constexpr double kSpan_db = 80;  ///< of the scale, below the strongest values
constexpr std::size_t kValuesAtOnce = 1 << 16;

}  // namespace

VerticalColors::VerticalColors(const VerticalDiagram& diagram)
    : is_part_(diagram.unit.empty()), floor_(diagram.floor) {
  std::map<double, std::size_t> tens;  // values by the next multiple of ten
  std::size_t count = 0;
  float least = std::numeric_limits<float>::infinity(), greatest = -least;
  for (const VerticalCut& cut : diagram.cuts) {
    for (std::size_t n = 0; n < cut.values.size(); ++n) {
      if (n % kValuesAtOnce == 0) checkpoint();
      const float value = cut.values[n];
      if (!std::isfinite(value) || !hasField(value)) continue;
      ++tens[10 * std::ceil(static_cast<double>(value) / 10)];
      ++count;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
  }
  if (!is_part_ && count > 0) {
    // Close to the emitter the values increase without limit: the uppermost hundredth is left out.
    std::size_t below = 0;
    for (const auto& [ten, values] : tens) {
      high_ = ten;
      below += values;
      if (below > count * 99 / 100) break;
    }
    low_ = std::max(10 * std::floor(static_cast<double>(least) / 10), high_ - kSpan_db);
    if (high_ - low_ < 10) low_ = high_ - 10;
    has_lower_ = static_cast<double>(least) < low_;
    has_higher_ = static_cast<double>(greatest) > high_;
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
