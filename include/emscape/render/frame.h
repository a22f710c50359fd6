/// A frame: how it is to be drawn, and what it took.
#pragma once

#include "emscape/render/pattern.h"

namespace emscape::render {

/// How each pixel of a frame is produced: cast or interpolated.
struct FramePlan {
  Pattern pattern = Pattern::full;
  Interpolation interpolation = Interpolation::float32;  ///< adaptive always predicts in float
  double tolerance_levels = kDefaultTolerance_levels;    ///< of adaptive, see AdaptiveFrame::draw()
  /// Of adaptive: fraction of the pixels whose ray meets the box that a frame may cast, after the first few
  /// frames; > 0
  double ray_share = kDefaultRayShare;
};

/// What a frame, or the restoration of one, took.
struct FrameReport {
  Pattern pattern = Pattern::full;
  long long rays = 0;
  long long samples = 0;      ///< of the volume; 0 where they are not counted (the plain form, a GPU)
  double cast_ms = 0;         ///< on a GPU by its own clock, and of the whole frame
  double interpolate_ms = 0;  ///< 0 on a GPU
  bool complete = true;       ///< false: it was stopped; the picture then holds nothing to be shown

  double total_ms() const { return cast_ms + interpolate_ms; }
};

}  // namespace emscape::render
