/// The patterns of pixel interpolation: which pixels of a frame are cast.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"

namespace emscape::render {

using emscape::toString;

/// Cast pixels: all; x even; (x + y) even; x and y even; those that cannot be predicted (Pattern::adaptive).
enum class Pattern { full, columns, checkerboard, quarter, adaptive };
constexpr auto namesOf(Pattern) {
  return std::array{"full", "columns", "checkerboard", "quarter", "adaptive"};
}
/// @throws Error (usage) that lists the names
Pattern parsePattern(const std::string& name);
/// All patterns, by falling number of rays; adaptive, whose rays depend on the picture, is the last.
const std::vector<Pattern>& allPatterns();

/// Precision of interpolated pixels: premultiplied float, or 8-bit levels as in Feng et al. 2016 (for its
/// tables).
enum class Interpolation { float32, bits8 };
constexpr auto namesOf(Interpolation) {
  return std::array{"float", "8bit"};
}
/// "float" or "8bit". @throws Error (usage)
Interpolation parseInterpolation(const std::string& name);

/// Default tolerance of the pattern adaptive: estimated error (levels of 255) above which a pixel is cast.
constexpr double kDefaultTolerance_levels = 0.6;
/// Default of the largest fraction that an adaptive frame casts, of the pixels whose rays meet the volume's
/// box: that of quarter.
constexpr double kDefaultRayShare = 0.25;

}  // namespace emscape::render
