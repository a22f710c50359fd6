/// Half-spaces to which a ray is clipped, and the sections on their planes: plain data, single source for
/// host and device.
#pragma once

#include <cmath>

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/render/scene/cut_plane.h"
#include "render/cast/compositing.h"

namespace emscape::render {

/// The part of a ray that planes keep.
struct CutInterval {
  double begin = 0, end = 0;     ///< along the ray; empty if end <= begin
  bool begins_at_plane = false;  ///< the ray enters the kept side there
  bool ends_at_plane = false;    ///< the ray leaves the kept side there
};

/// Planes in the volume's index space.
struct CutView {
  /// Keeps the half-space dot(normal, position) <= offset.
  struct Plane {
    Vec3d normal;
    double offset = 0;
    bool cuts_ground = false;
  };
  Plane planes[kMaxCutPlanes];
  int count = 0;
  const Rgba* colors = nullptr;  ///< opaque, by the index of the transfer function's table
  /// Values within this distance of the floor are no field: sections are transparent there.
  float floor = 0, near_floor = 0;

  /// True if a position is on the removed side of a plane.
  bool removes(const Vec3d& position) const {
    for (int n = 0; n < count; ++n) {
      if (dot(planes[n].normal, position) > planes[n].offset) return true;
    }
    return false;
  }

  /// Clips a part of a ray. @param of_ground  only to the planes that cut the ground
  EMSCAPE_HD void clip(const Vec3d& origin, const Vec3d& direction, bool of_ground,
                       CutInterval& interval) const {
    for (int n = 0; n < count; ++n) {
      const Plane& plane = planes[n];
      if (of_ground && !plane.cuts_ground) continue;
      const double rate = dot(plane.normal, direction);
      const double inside = plane.offset - dot(plane.normal, origin);  // negative on the removed side
      if (rate == 0.0) {
        if (inside < 0.0) interval.end = interval.begin;
        continue;
      }
      const double distance = quotient(inside, rate);
      if (rate < 0.0) {
        if (distance > interval.begin) {
          interval.begin = distance;
          interval.begins_at_plane = true;
        }
      } else if (distance < interval.end) {
        interval.end = distance;
        interval.ends_at_plane = true;
      }
    }
  }

  /// The section's colour, if the volume has a value. @param known  the voxel is not masked
  EMSCAPE_HD Rgba color(const TransferView& transfer, bool known, float value) const {
    return known && std::fabs(value - floor) > near_floor ? colors[transfer.index(transfer.normalized(value))]
                                                          : Rgba{};
  }
};

/// Distances along a ray, from its origin, between which samples are taken.
struct RayBounds {
  float begin = 0;
  float end = 1e30F;
};

/// The part of a pixel's ray that planes keep.
struct CutRay {
  RayBounds bounds;  ///< of samples
  Rgba section;      ///< section behind the samples; transparent: no visible section
};

}  // namespace emscape::render
