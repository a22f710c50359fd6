/// The largest estimated error that the pattern `adaptive` accepts.
#pragma once

#include "emscape/render/pattern.h"

namespace emscape::render {

/// Bounds of the tolerance (see kDefaultTolerance_levels). The first passes, whose errors spread, are held to
/// a part of it.
constexpr double kMinTolerance_levels = 1.0 / 16;
constexpr double kMaxTolerance_levels = 64;

/// The tolerance of the next frame: that of the last one, moved such that what a frame costs (time, or rays)
/// approaches a budget smoothly, at most by a factor of two a frame.
/// @param cost    of the last frame, >= 0
/// @param budget  in the unit of `cost`, > 0
/// @return        kMinTolerance_levels..kMaxTolerance_levels
double nextTolerance_levels(double tolerance_levels, double cost, double budget);

/// Keeps frames below a number of rays: raises the tolerance from frame to frame while they cast more, and
/// lowers it again when they do not.
class ToleranceController {
 public:
  /// Tolerance of the next frame. @param asked_levels  is the minimum
  double levels(double asked_levels) const;
  /// Reports a frame. @param max_rays  that it should have cast, > 0
  void drawn(double levels, double rays, double max_rays);

 private:
  double held_levels_ = 0;  ///< in force if larger than the tolerance asked for
  double last_levels_ = 1, last_rays_ = 1;
  double power_ = 0.5;  ///< rays are taken as proportional to 1 / tolerance to this power
};

}  // namespace emscape::render
