/// Intersection of a ray with an isosurface. Single source for host and device.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "render/cast/ray_segments.h"
#include "render/cast/volume_view.h"

namespace emscape::render {

/// The surface between values below `value` and values of at least `value`.
struct IsoView {
  float value = 0;
  float opacity = 1;
  float r = 1, g = 1, b = 1;  ///< its colour, not premultiplied
};

struct IsoHit {
  bool found = false;
  bool cap = false;  ///< the ray enters the box inside the surface: the box's face is the surface
  float distance = 0;
  float value = 0;  ///< value of the field there
};

/// A point of a ray with the field's value.
struct FieldPoint {
  float distance = 0;
  float value = 0;
  bool known = false;  ///< neither masked nor NaN
};

template <class Sampler>
EMSCAPE_HD FieldPoint fieldPoint(const VolumeView& volume, const RaySegments& segments, float distance) {
  FieldPoint point;
  point.distance = distance;
  point.known = Sampler::sample(volume, segments.at(distance), point.value);
  return point;
}

/// The crossing between two points on either side of the surface: bisected a fixed number of times, then
/// linear. Not found if a masked or NaN sample is between.
/// @accuracy 1/256 of the distance of the points for any field; for smooth ones about the square of this
template <class Sampler>
EMSCAPE_HD IsoHit refineCrossing(const VolumeView& volume, const RaySegments& segments, float iso,
                                 FieldPoint near, FieldPoint far) {
  constexpr int kBisections = 8;
  for (int i = 0; i < kBisections; ++i) {
    const FieldPoint middle = fieldPoint<Sampler>(volume, segments, 0.5F * (near.distance + far.distance));
    if (!middle.known) return {};
    const bool crossed = (middle.value >= iso) != (near.value >= iso);
    (crossed ? far : near) = middle;
  }
  const float part = (iso - near.value) / (far.value - near.value);  // NaN between infinities
  IsoHit hit;
  hit.found = true;
  hit.distance = part <= 1.0F ? lerp(near.distance, far.distance, part) : far.distance;
  hit.value = iso;
  return hit;
}

/// The first crossing of the surface, in either direction, between neighbouring joints of a ray's segments
/// that are neither masked nor NaN.
/// @param enters  the ray enters the box at its start (it does not begin inside): a start inside the surface
///                is a hit
template <class Sampler>
EMSCAPE_HD IsoHit firstCrossing(const VolumeView& volume, const SkipView& skip, const RaySegments& segments,
                                float iso, bool enters) {
  FieldPoint last;
  int next_brick = 0;
  for (int n = 0; n <= segments.count;) {
    const FieldPoint point = fieldPoint<Sampler>(volume, segments, segments.joint(n));
    if (n == 0 && enters && point.known && point.value >= iso) return {true, true, 0.0F, point.value};
    if (last.known && point.known && (last.value >= iso) != (point.value >= iso)) {
      const IsoHit hit = refineCrossing<Sampler>(volume, segments, iso, last, point);
      if (hit.found) return hit;
    }
    last = point;
    int ahead = 1;
    if (skip.levels != nullptr && n >= next_brick) {
      const BrickStep brick = skip.at(volume, segments.at(point.distance), segments.per_voxel);
      const int inside = segments.stepsIn(brick.leave);  // joint n + inside is certainly in the brick
      next_brick = n + inside + 1;
      if (skip.levels[brick.index] < SkipView::kNever && inside > 1) ahead = inside;
    }
    // The last joint in a brick without the surface is on the same side as this one.
    n = n < segments.count && n + ahead > segments.count ? segments.count : n + ahead;
  }
  return {};
}

/// Normal of the box's face that a ray enters by, in index space (and as drawn: axes stay axes).
EMSCAPE_HD inline Vec3f entryNormal(const VolumeView& volume, const Vec3f& start, const Vec3f& direction) {
  const Vec3f lower = vecCast<float>(volume.lower());
  const Vec3f upper = vecCast<float>(volume.upper());
  const auto gap = [](float position, float along, float low, float high) {
    return along > 0.0F ? std::abs(position - low) : along < 0.0F ? std::abs(high - position) : 1e30F;
  };
  const float x = gap(start.x, direction.x, lower.x, upper.x);
  const float y = gap(start.y, direction.y, lower.y, upper.y);
  const float z = gap(start.z, direction.z, lower.z, upper.z);
  if (x <= y && x <= z) return {direction.x > 0.0F ? -1.0F : 1.0F, 0, 0};
  if (y <= z) return {0, direction.y > 0.0F ? -1.0F : 1.0F, 0};
  return {0, 0, direction.z > 0.0F ? -1.0F : 1.0F};
}

}  // namespace emscape::render
