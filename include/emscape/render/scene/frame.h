/// A frame: how it is drawn, and its cost.
#pragma once

#include "emscape/render/scene/pattern.h"

namespace emscape::render {

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
