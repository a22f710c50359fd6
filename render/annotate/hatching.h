/// Hatching of areas whose value is not known: lines from the lower left to the upper right.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/annotate/canvas.h"

namespace emscape::render {

constexpr Ink kHatchInk{{0.24F, 0.26F, 0.30F}, 0.85};
/// Lengths at 1200 x 900: from line to line along a row of pixels, and width of a line.
constexpr double kHatchStep = 10, kHatchWidth = 1.5;

/// Part of a pixel that a line covers, 0..1.
/// @param unit  as Style::unit
inline double hatchAt(int x, int y, double unit) {
  const double step = kHatchStep * unit, along = std::fmod(x + y + 1.0, step);
  const double off = std::min(along, step - along) * std::sqrt(0.5);
  return std::clamp(kHatchWidth * unit / 2 - off + 0.5, 0.0, 1.0);
}

}  // namespace emscape::render
