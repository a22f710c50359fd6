/// How large an estimated error the pattern `adaptive` lets pass.
#pragma once

#include "emscape/render/pattern.h"

namespace emscape::render {

/// Bounds of the tolerance (see kDefaultTolerance_levels). The first passes, whose errors spread, are held to
/// a part of it.
constexpr double kLeastTolerance_levels = 1.0 / 16;
constexpr double kLargestTolerance_levels = 64;

/// The tolerance of the next frame: that of the last one, moved such that what a frame costs (time, or rays)
/// approaches a budget smoothly, at most by a factor of two a frame.
/// @param cost    of the last frame, >= 0
/// @param budget  in the unit of `cost`, > 0
/// @return        kLeastTolerance_levels..kLargestTolerance_levels
double nextTolerance_levels(double tolerance_levels, double cost, double budget);

/// Keeps frames to a number of rays: where they cast more the tolerance is raised from one frame to the next,
/// and lowered again where they do not.
class ToleranceHold {
 public:
  /// That of the next frame. @param asked_levels  is kept where it casts no more rays than it should
  double levels(double asked_levels) const;
  /// What a frame came to. @param most_rays  that it should have cast, > 0
  void drawn(double levels, double rays, double most_rays);

 private:
  double held_levels_ = 0;  ///< counts where it is the larger one
  double last_levels_ = 1, last_rays_ = 1;
  double power_ = 0.5;  ///< rays are taken as proportional to 1 / tolerance to this power
};

}  // namespace emscape::render
