/// A frame: which of its pixels are cast, how it is drawn, and its cost.
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

/// How the pixels at edges of an exact picture are made. Smooth: their colours are means of several rays, so
/// that silhouettes are no stairs.
enum class Edges { as_cast, smooth };

/// How each pixel of a frame is produced: cast or interpolated.
struct FramePlan {
  Pattern pattern = Pattern::full;
  Interpolation interpolation = Interpolation::float32;  ///< adaptive always predicts in float
  double tolerance_levels = kDefaultTolerance_levels;    ///< for adaptive; see AdaptiveFrame::draw()
  /// For adaptive: of the pixels whose ray meets the box, the fraction that a frame may cast after the first
  /// few frames; > 0
  double ray_share = kDefaultRayShare;
  Edges edges = Edges::as_cast;  ///< for full

  /// The picture of a still or a film.
  static FramePlan exact() {
    FramePlan plan;
    plan.edges = Edges::smooth;
    return plan;
  }
};

/// Cost of a frame or a restoration.
struct FrameReport {
  Pattern pattern = Pattern::full;
  long long rays = 0;
  long long samples = 0;      ///< of the volume; 0 if not counted (RenderSettings::plain, or a GPU)
  double cast_ms = 0;         ///< on a GPU the whole frame, by the GPU's clock
  double interpolate_ms = 0;  ///< 0 on a GPU
  bool complete = true;       ///< false: it was stopped, and the picture must not be shown

  double total_ms() const { return cast_ms + interpolate_ms; }
};

}  // namespace emscape::render
