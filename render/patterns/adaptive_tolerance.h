/// The largest estimated error that the pattern `adaptive` accepts.
#pragma once

#include "emscape/render/scene/frame.h"

namespace emscape::render {

/// Bounds of the tolerance (see kDefaultTolerance_levels). The first passes, whose errors propagate, have a
/// fraction of it.
constexpr double kMinTolerance_levels = 1.0 / 16;
constexpr double kMaxTolerance_levels = 64;

/// The tolerance of the next frame: that of the last one, changed so that the cost of a frame (time or rays)
/// approaches a budget smoothly, at most by a factor of two per frame.
/// @param cost    of the last frame, >= 0
/// @param budget  in the unit of `cost`, > 0
/// @return        kMinTolerance_levels..kMaxTolerance_levels
double nextTolerance_levels(double tolerance_levels, double cost, double budget);

/// Limits the number of rays per frame: raises the tolerance from frame to frame while they cast more, and
/// otherwise lowers it again.
class ToleranceController {
 public:
  /// Tolerance of the next frame. @param asked_levels the minimum
  double levels(double asked_levels) const;
  /// Reports a frame. @param max_rays  limit of the number of rays, > 0
  void drawn(double levels, double rays, double max_rays);

 private:
  double held_levels_ = 0;  ///< used if larger than the requested tolerance
  double last_levels_ = 1, last_rays_ = 1;
  double power_ = 0.5;  ///< exponent: rays are assumed to be proportional to 1 / tolerance to this power
};

}  // namespace emscape::render
