/// Casting one pixel of a scene: single source for host and device over plain data.
///
/// Rays are in *index space*, where voxel (i, j, k) has its centre at (i, j, k): every voxel is a unit cube,
/// and lengths along a ray are in voxels for any spacing and vertical exaggeration. A ray crosses the box of
/// voxels, -0.5 .. dims - 0.5 along each axis. From its entry it is divided into segments of one step, the
/// last one shorter, and sampled in the middle of each segment with the opacity of the segment's length.
/// Hence homogeneous fog is exact for any step length. There is no jitter: a pixel depends only on its
/// coordinates and the scene.
#pragma once

#include "base/math/device_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "render/cast/compositing.h"
#include "render/cast/cut.h"
#include "render/cast/ground.h"
#include "render/cast/isosurface.h"
#include "render/cast/ray_segments.h"
#include "render/cast/rgba.h"
#include "render/cast/shading.h"
#include "render/cast/volume_view.h"

namespace emscape::render {

/// A ray in index space: the direction has unit length, so that its parameter counts voxels.
template <class Real>
struct RayOf {
  Vec3<Real> origin;
  Vec3<Real> direction;
};
using Ray = RayOf<double>;

/// A camera in index space.
struct CameraView {
  Vec3d eye;
  Vec3d forward, right, up;  ///< of one unit of length; not orthogonal if voxels are not cubes
  double half_height = 1;
  double shift_x = 0, shift_y = 0;
  bool orthographic = false;
  ImageSize size;

  EMSCAPE_HD Ray ray(int x, int y) const {
    const Ray through = rayThrough<double>(x, y);
    return {through.origin, through.direction * reciprocalRoot(dot(through.direction, through.direction))};
  }
  /// The same with a direction of some length.
  template <class Real>
  EMSCAPE_HD RayOf<Real> rayThrough(int x, int y) const {
    const auto real = [](auto number) { return static_cast<Real>(number); };
    const Real half = real(0.5);
    const Real width = real(size.width), height = real(size.height);
    const Real plane_x = (quotient(2 * (x + half) - width, height) + real(shift_x)) * real(half_height);
    const Real plane_y = (1 - quotient(2 * (y + half), height) + real(shift_y)) * real(half_height);
    const Vec3<Real> offset = vecCast<Real>(right) * plane_x + vecCast<Real>(up) * plane_y;
    return {orthographic ? vecCast<Real>(eye) + offset : vecCast<Real>(eye),
            orthographic ? vecCast<Real>(forward) : vecCast<Real>(forward) + offset};
  }
};

/// The part of a ray in a box; empty if end <= begin. Never begins behind the origin.
template <class Real>
struct RayIntervalOf {
  Real begin = 0, end = 0;
};
using RayInterval = RayIntervalOf<double>;

/// The box test for one axis. Rays in the plane of a face count as outside.
template <class Real>
EMSCAPE_HD inline void clipAxis(Real origin, Real direction, Real lower, Real upper,
                                RayIntervalOf<Real>& interval) {
  const Real per_unit = reciprocal(direction);
  const Real to_lower = (lower - origin) * per_unit;
  const Real to_upper = (upper - origin) * per_unit;
  Real enter = direction > 0 ? to_lower : to_upper;
  Real leave = direction > 0 ? to_upper : to_lower;
  if (direction == 0) {
    enter = interval.begin;
    leave = origin > lower && origin < upper ? interval.end : interval.begin;
  }
  interval.begin = enter > interval.begin ? enter : interval.begin;
  interval.end = leave < interval.end ? leave : interval.end;
}

template <class Real>
EMSCAPE_HD inline RayIntervalOf<Real> clip(const RayOf<Real>& ray, const Vec3<Real>& lower,
                                           const Vec3<Real>& upper) {
  RayIntervalOf<Real> interval{0, static_cast<Real>(1e30)};
  clipAxis(ray.origin.x, ray.direction.x, lower.x, upper.x, interval);
  clipAxis(ray.origin.y, ray.direction.y, lower.y, upper.y, interval);
  clipAxis(ray.origin.z, ray.direction.z, lower.z, upper.z, interval);
  return interval;
}

/// Intersection of a ray with the ground. Where planes cut the ground, a wall is visible.
EMSCAPE_HD inline GroundHit groundHit(const GroundView& ground, const CutView& cut, const Ray& ray) {
  const RayInterval over_ground = clip(ray, ground.lower, ground.upper);
  CutInterval left{over_ground.begin, over_ground.end};
  cut.clip(ray.origin, ray.direction, true, left);
  if (!(left.end > left.begin)) return {};
  GroundHit hit = ground.firstHit(ray.origin, ray.direction, left.begin, left.end);
  if (left.begins_at_plane && hit.found && hit.distance == left.begin) {
    hit.is_surface = false;
    hit.color = ground.cutColor(static_cast<float>(ray.origin.z + ray.direction.z * left.begin));
  }
  return hit;
}

/// Colours of samples by their index in a transfer function's table, for RaycastTask::castVolume().
struct TableColors {
  const Rgba* samples = nullptr;
  EMSCAPE_HD const Rgba& at(int index) const { return samples[index]; }
};

/// The layer of values at a height above the ground that is painted on it.
struct MapLayerView {
  bool on = false;
  float height_voxels = 0;
  float opacity = 1;
  float quiet = 0;  ///< of a difference: smaller values are transparent, twice as large ones have `opacity`

  EMSCAPE_HD float opacityOf(float value) const {
    if (!(quiet > 0.0F)) return opacity;
    const float above = fabsf(value) / quiet - 1.0F;
    return opacity * (above < 0.0F ? 0.0F : above > 1.0F ? 1.0F : above);
  }
};

/// A scene ready to be cast. Sampler: TrilinearSampler or NearestSampler; Compositor: see compositing.h.
struct RaycastTask {
  CameraView camera;
  VolumeView volume;
  TransferView transfer;
  SkipView skip;
  GroundView ground;
  CutView cut;
  ShadingView shading;
  IsoView iso;
  MapLayerView map;
  float step_voxels = 1;
  float mida_gamma = 0;
  float volume_highest_f = 1;
  float opaque_enough = kOpaqueEnough;  ///< or kNeverOpaqueEnough

  EMSCAPE_HD bool isExact() const { return opaque_enough > 1.0F; }

  /// Intersection of a pixel's ray with the ground.
  EMSCAPE_HD GroundHit groundAt(int x, int y) const {
    return ground.heights != nullptr ? groundHit(ground, cut, camera.ray(x, y)) : GroundHit{};
  }

  /// The colour of a point on the ground's surface with the map layer, which has the colours of sections. It
  /// is transparent where the volume has no value, or next to no difference; planes do not cut it.
  /// @param distance  of the point, along the ray of the pixel  @param ground  its colour without the layer
  template <class Sampler>
  EMSCAPE_HD Rgba mapColor(int x, int y, float distance, const Rgba& ground_color) const {
    const Ray ray = camera.ray(x, y);
    Vec3d at = ray.origin + ray.direction * static_cast<double>(distance);
    at.z += static_cast<double>(map.height_voxels);
    const Vec3d lower = volume.lower(), upper = volume.upper();
    const bool inside = at.x >= lower.x && at.y >= lower.y && at.z >= lower.z && at.x <= upper.x &&
                        at.y <= upper.y && at.z <= upper.z;
    float value = 0;
    if (!inside || !Sampler::sample(volume, vecCast<float>(at), value)) return ground_color;
    return over(cut.color(transfer, true, value) * map.opacityOf(value), ground_color);
  }

  /// The part of a pixel's ray that the planes keep in front of the ground; all up to `limit` if they do not
  /// cut it. @param limit distance of the ground
  template <class Sampler>
  EMSCAPE_HD CutRay cutRay(int x, int y, float limit) const {
    const Ray ray = camera.ray(x, y);
    const RayInterval inside = clip(ray, volume.lower(), volume.upper());
    CutInterval left{inside.begin, inside.end};
    cut.clip(ray.origin, ray.direction, false, left);
    if (limit < left.end) {
      left.end = limit;
      left.ends_at_plane = false;
    }
    if (!(left.end > left.begin)) return {{0.0F, 0.0F}, {}};
    CutRay result{{0.0F, limit}, {}};
    if (left.begins_at_plane) {
      result.bounds.begin = static_cast<float>(left.begin);
      result.section = sectionAt<Sampler>(ray, left.begin);
      if (result.section.a > 0.0F) {
        result.bounds.end = result.bounds.begin;
        return result;
      }
    }
    if (left.ends_at_plane) {
      result.bounds.end = static_cast<float>(left.end);
      result.section = sectionAt<Sampler>(ray, left.end);
    }
    return result;
  }

  /// The volume in a pixel, premultiplied.
  /// @param bounds  the ground or a section ends the ray
  template <class Compositor, class Sampler>
  EMSCAPE_HD Rgba castVolume(int x, int y, RayBounds bounds) const {
    return castVolume<Compositor, Sampler, true, 1>(x, y, bounds, TableColors{transfer.samples},
                                                    volume_highest_f);
  }

  /// The same with the transfer function's colours in other memory.
  /// @param kMayShade  false: without the code for shading; shades_fog must not be set
  /// @param kBatch  number of samples that are fetched before the first is composited; the result does not
  ///                depend on it
  template <class Compositor, class Sampler, bool kMayShade, int kBatch, class Colors>
  EMSCAPE_HD Rgba castVolume(int x, int y, RayBounds bounds, const Colors& colors, float highest_f) const {
    const RaySegments segments = segmentsOf(x, y, bounds);
    JoinedParts<Compositor> ray(Compositor(opaque_enough, mida_gamma, highest_f));
    for (int part = 0; part < Compositor::kParts && segments.count > 0; ++part) {
      Compositor next = ray.behind();
      const bool done = castPart<Compositor, Sampler, kMayShade, kBatch>(segments, part, colors, next);
      ray.join(next);
      if (done) break;
    }
    return ray.whole().result(transfer);
  }

  /// One of Compositor::kParts parts of a ray, the first one in front.
  /// @return true if nothing behind it matters
  template <class Compositor, class Sampler, bool kMayShade, int kBatch, class Colors>
  EMSCAPE_HD bool castPart(const RaySegments& segments, int part, const Colors& colors,
                           Compositor& compositor) const {
    constexpr int kParts = Compositor::kParts;
    // Whole batches for any kBatch, and nearly as many in each part.
    const int batches = (segments.whole + kMaxRayParts - 1) / kMaxRayParts;
    const int begin = batches * part / kParts * kMaxRayParts;
    const int next = batches * (part + 1) / kParts * kMaxRayParts;
    const int end = next < segments.whole ? next : segments.whole;
    return march<Compositor, Sampler, kMayShade, kBatch>(segments, begin, end, part + 1 == kParts, colors,
                                                         compositor);
  }

  /// The segments of a pixel's ray in the volume; none if it misses it.
  EMSCAPE_HD RaySegments segmentsOf(int x, int y, RayBounds bounds) const {
    const Ray ray = camera.ray(x, y);
    const RayInterval inside = insideOf(ray, bounds);
    return segmentsOf(ray, inside.end > inside.begin ? inside : RayInterval{});
  }

  /// The isosurface in a pixel, premultiplied.
  template <class Sampler>
  EMSCAPE_HD Rgba castSurface(int x, int y, RayBounds bounds) const {
    const Ray ray = camera.ray(x, y);
    const RayInterval inside = insideOf(ray, bounds);
    if (!(inside.end > inside.begin)) return {};
    const RaySegments segments = segmentsOf(ray, inside);
    const IsoHit hit = firstCrossing<Sampler>(volume, skip, segments, iso.value, inside.begin > 0.0);
    if (!hit.found) return {};
    const Rgba color{iso.r * iso.opacity, iso.g * iso.opacity, iso.b * iso.opacity, iso.opacity};
    const Vec3f to_viewer = shading.toViewer(segments.direction);
    if (hit.cap)
      return shading.lit(color, entryNormal(volume, segments.start, segments.direction), to_viewer);
    const Vec3f gradient = gradientAt<Sampler>(volume, segments.at(hit.distance), hit.value);
    if (!ShadingView::isSlope(gradient)) return color;
    return shading.lit(color, shading.normal(gradient), to_viewer);
  }

 private:
  /// Whole segments begin .. end of a ray, and, if requested, the last one, which is shorter.
  /// @return true if nothing behind them matters
  template <class Compositor, class Sampler, bool kMayShade, int kBatch, class Colors>
  EMSCAPE_HD bool march(const RaySegments& segments, int begin, int end, bool with_last, const Colors& colors,
                        Compositor& compositor) const {
    OccupancyLookahead ahead(skip, volume, segments);
    const Vec3f to_viewer = kMayShade ? shading.toViewer(segments.direction) : Vec3f{};
    // Adds the sample of segment n, of `part` of a step. @return true if nothing behind it matters
    const auto take = [&](int n, float part, float value, float f, Rgba sample) {
      if (compositor.ignores(f, sample)) return false;
      if constexpr (Compositor::kNeedsColor) {
        if (kMayShade && shading.shades_fog && sample.a > 0.0F) {
          const Vec3f gradient = gradientAt<Sampler>(volume, segments.at(segments.middle(n)), value);
          sample = shading.litFog(sample, gradient * transfer.scale, to_viewer);
        }
        if (part < 1.0F) sample = shortened(sample, part);
      }
      compositor.add(f, sample);
      return compositor.done(ahead, n + 1);
    };
    const auto colorOf = [&](float f) {
      return Compositor::kNeedsColor ? colors.at(transfer.index(f)) : Rgba{};
    };
    const float shift = Sampler::kShift;
    const Vec3f fetch_start = segments.start + Vec3f{shift, shift, shift};
    int next_brick = 0;  // the first sample that may be in another brick than the last one tested
    for (int n = begin; n < end;) {
      if (skip.levels != nullptr && n >= next_brick) {
        const BrickStep brick = skip.at(volume, segments.at(segments.wholeMiddle(n)), segments.per_voxel);
        next_brick = n + 1 + segments.stepsIn(brick.leave);
        if (compositor.canSkip(skip.levels[brick.index])) {
          n = next_brick;
          continue;
        }
      }
      // Stage by stage and with few branches, so that the fetches of a batch overlap.
      float values[kBatch];
      float fs[kBatch];
      Rgba samples[kBatch];
      EMSCAPE_UNROLL
      for (int i = 0; i < kBatch; ++i) {
        values[i] = Sampler::fetch(volume, segments.from(fetch_start, segments.wholeMiddle(n + i)));
      }
      if (volume.masked_below > 0) {
        EMSCAPE_UNROLL
        for (int i = 0; i < kBatch; ++i) {
          if (nearestIsMasked(volume, segments.at(segments.wholeMiddle(n + i)))) values[i] = NAN;
        }
      }
      EMSCAPE_UNROLL
      for (int i = 0; i < kBatch; ++i) {
        fs[i] = transfer.normalized(values[i]);
        samples[i] = colorOf(fs[i]);
      }
      bool ends = false;
      EMSCAPE_UNROLL
      for (int i = 0; i < kBatch; ++i) {
        const bool shows = values[i] == values[i] && (i == 0 || n + i < end);
        if constexpr (Compositor::kEndsItself && !kMayShade) {
          compositor.addIf(shows, fs[i], samples[i]);
        } else {
          if (shows && !ends) ends = take(n + i, 1.0F, values[i], fs[i], samples[i]);
        }
      }
      if (Compositor::kEndsItself ? compositor.done(ahead, n + kBatch) : ends) return true;
      n += kBatch;
    }
    float value = 0;
    if (!with_last || segments.whole == segments.count ||
        !Sampler::sample(volume, segments.at(segments.middle(segments.whole)), value)) {
      return false;
    }
    const float f = transfer.normalized(value);
    return take(segments.whole, quotient(segments.last(), step_voxels), value, f, colorOf(f));
  }

  EMSCAPE_HD RayInterval insideOf(const Ray& ray, RayBounds bounds) const {
    RayInterval inside = clip(ray, volume.lower(), volume.upper());
    if (bounds.begin > inside.begin) inside.begin = bounds.begin;
    if (bounds.end < inside.end) inside.end = bounds.end;
    return inside;
  }
  template <class Sampler>
  EMSCAPE_HD Rgba sectionAt(const Ray& ray, double distance) const {
    float value = 0;
    const bool known = Sampler::sample(volume, vecCast<float>(ray.origin + ray.direction * distance), value);
    return cut.color(transfer, known, value);
  }
  EMSCAPE_HD RaySegments segmentsOf(const Ray& ray, const RayInterval& inside) const {
    return {vecCast<float>(ray.origin + ray.direction * inside.begin), vecCast<float>(ray.direction),
            static_cast<float>(inside.end - inside.begin), step_voxels};
  }
};

}  // namespace emscape::render
