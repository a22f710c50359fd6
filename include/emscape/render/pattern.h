/// The patterns of pixel interpolation: which pixels of a frame are cast.
#pragma once

#include <string>
#include <vector>

namespace emscape::render {

/// Source pixels: all; x even; (x + y) even; x and y even; those that cannot be predicted
/// (Pattern::adaptive).
enum class Pattern { full, columns, checkerboard, quarter, adaptive };
const char* toString(Pattern pattern);
/// @throws Error (usage) that lists the names
Pattern parsePattern(const std::string& name);
/// Every pattern, that with the most rays first; adaptive, whose rays depend on the picture, is the last.
const std::vector<Pattern>& allPatterns();

/// How missing pixels are interpolated: in premultiplied float, or in 8-bit levels as the paper does (for its
/// tables).
enum class Interpolation { float32, bits8 };
const char* toString(Interpolation interpolation);
/// "float" or "8bit". @throws Error (usage)
Interpolation parseInterpolation(const std::string& name);

/// Default tolerance of the pattern adaptive: estimated error (levels of 255) above which a pixel is cast.
constexpr double kDefaultTolerance_levels = 0.6;
/// Part of the pixels whose rays meet the volume's box that an adaptive frame casts at most by default: that
/// of quarter.
constexpr double kDefaultRayShare = 0.25;

}  // namespace emscape::render
