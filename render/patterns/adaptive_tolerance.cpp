#include "render/patterns/adaptive_tolerance.h"

#include <algorithm>
#include <cmath>

namespace emscape::render {

double nextTolerance_levels(double tolerance_levels, double cost, double budget) {
  // Times are about inversely proportional to the square root of the tolerance; an exponent below 2 is
  // damped.
  constexpr double kResponse = 1.5;
  const double factor = std::clamp(std::pow(cost / budget, kResponse), 0.5, 2.0);
  return std::clamp(tolerance_levels * factor, kMinTolerance_levels, kMaxTolerance_levels);
}

double ToleranceController::levels(double asked_levels) const {
  return std::max(asked_levels, held_levels_);
}

void ToleranceController::drawn(double levels, double rays, double max_rays) {
  // The number of rays falls with a power of the tolerance; the last two frames determine the exponent.
  constexpr double kAim = 0.98;
  const double fall = std::log(last_rays_ / std::max(rays, 1.0));
  const double rise = std::log(std::max(levels, kMinTolerance_levels) / last_levels_);
  if (std::abs(rise) > 0.01) power_ = 0.5 * (power_ + std::clamp(fall / rise, 0.2, 1.5));
  last_rays_ = std::max(rays, 1.0);
  last_levels_ = std::max(levels, kMinTolerance_levels);
  const double factor = std::clamp(std::pow(last_rays_ / (kAim * max_rays), 1 / power_), 1.0 / 16, 16.0);
  held_levels_ = std::min(last_levels_ * factor, kMaxTolerance_levels);
}

}  // namespace emscape::render
