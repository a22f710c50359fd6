/// A frame: what is ordered, and what it took.
#pragma once

#include "emscape/render/pattern.h"

namespace emscape::render {

/// How the pixels of a frame are come by.
struct FramePlan {
  Pattern pattern = Pattern::full;
  Interpolation interpolation = Interpolation::float32;  ///< adaptive predicts in float always
  double tolerance_levels = kDefaultTolerance_levels;    ///< of adaptive, see AdaptiveFrame::draw()
  /// Of adaptive: part of the pixels whose ray meets the box that frames keep to, after the first few; > 0
  double ray_share = kDefaultRayShare;
};

/// What a frame, or the restoration of one, took.
struct FrameReport {
  Pattern pattern = Pattern::full;
  long long rays = 0;
  long long samples = 0;      ///< taken of the volume; 0 where they are not counted (the plain form, a GPU)
  double cast_ms = 0;         ///< on a GPU its own time, by events, and that of all work: kernels overlap
  double interpolate_ms = 0;  ///< 0 on a GPU
  bool complete = true;       ///< false: it was stopped; the picture then holds nothing to be shown

  double total_ms() const { return cast_ms + interpolate_ms; }
};

}  // namespace emscape::render
