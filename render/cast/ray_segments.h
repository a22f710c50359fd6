/// A ray inside the volume, divided into the segments in which it is sampled; the maximum value ahead on it.
#pragma once

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "render/cast/volume_view.h"

namespace emscape::render {

/// The part of a ray in the box of voxels, from its entry: segments of one step, the last one shorter.
struct RaySegments {
  Vec3f start;
  Vec3f direction;     ///< of unit length: distances are in voxels
  Vec3f per_voxel;     ///< 1 / direction
  float length = 0;    ///< >= 0
  float step = 1;      ///< > 0
  float per_step = 1;  ///< 1 / step
  int whole = 0;       ///< number of segments of a whole step
  int count = 0;       ///< number of segments

  EMSCAPE_HD RaySegments(const Vec3f& first, const Vec3f& along, float length_voxels, float step_voxels)
      : start(first),
        direction(along),
        per_voxel{reciprocal(along.x), reciprocal(along.y), reciprocal(along.z)},
        length(length_voxels),
        step(step_voxels),
        per_step(reciprocal(step_voxels)),
        whole(static_cast<int>(quotient(length_voxels, step_voxels))),
        count(whole + (last() > 0.0F ? 1 : 0)) {}

  /// Length of the last segment, if it is shorter than a step.
  EMSCAPE_HD float last() const { return length - static_cast<float>(whole) * step; }
  /// Distance of the middle of segment n, 0 <= n < count.
  EMSCAPE_HD float middle(int n) const { return n < whole ? wholeMiddle(n) : length - 0.5F * last(); }
  /// The same of a whole segment.
  EMSCAPE_HD float wholeMiddle(int n) const { return (static_cast<float>(n) + 0.5F) * step; }
  /// Distance of the joint before segment n; n = count: of the end.
  EMSCAPE_HD float joint(int n) const { return n <= whole ? static_cast<float>(n) * step : length; }
  EMSCAPE_HD Vec3f at(float distance) const { return from(start, distance); }
  /// As at(), for a start that is shifted.
  EMSCAPE_HD Vec3f from(const Vec3f& shifted_start, float distance) const {
    return {multiplyAdd(direction.x, distance, shifted_start.x),
            multiplyAdd(direction.y, distance, shifted_start.y),
            multiplyAdd(direction.z, distance, shifted_start.z)};
  }
  /// Number of whole steps in a distance, at most `count`; exact except for rounding, which the distances of
  /// BrickStep allow for.
  EMSCAPE_HD int stepsIn(float distance) const {
    const float steps = distance * per_step;
    return steps < static_cast<float>(count) ? static_cast<int>(steps) : count;
  }
};

/// The maximum f that the samples ahead on a ray can have, from the bricks that contain them. It is cached
/// until the ray has left the brick with the maximum; results do not depend on earlier calls.
class OccupancyLookahead {
 public:
  EMSCAPE_HD OccupancyLookahead(const SkipView& skip, const VolumeView& volume, const RaySegments& segments)
      : skip_(skip), volume_(volume), segments_(segments) {}

  /// True if the sample of any segment from `next` on can have a larger f.
  EMSCAPE_HD bool exceeds(int next, float f) {
    if (next >= until_) walk(next);
    return highest_ > f;
  }

 private:
  EMSCAPE_HD void walk(int next) {
    highest_ = -1.0F;
    until_ = segments_.count;
    while (next < segments_.count) {
      const BrickStep brick = skip_.at(volume_, segments_.at(segments_.middle(next)), segments_.per_voxel);
      next += 1 + segments_.stepsIn(brick.leave);
      if (skip_.highest[brick.index] < highest_) continue;
      highest_ = skip_.highest[brick.index];
      until_ = next;
    }
  }

  const SkipView& skip_;
  const VolumeView& volume_;
  const RaySegments& segments_;
  float highest_ = 0;
  int until_ = 0;
};

}  // namespace emscape::render
