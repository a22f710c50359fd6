#include "render/cpu/packets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cpu/packets.cpp"
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

#include "render/cpu/packet_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {

/// Rays of a packet, in the volume's index space.
struct Rays {
  Vec3F start;      ///< where they enter the box
  Vec3F direction;  ///< of unit length
  F length;         ///< in the box and before the limit; 0 where a ray meets no sample
};

/// The part of rays inside the box along one axis; see render::clipAxis().
HWY_INLINE void clipAxis(D origin, D direction, double lower, double upper, D& begin, D& end) {
  const hn::ScalableTag<double> d;
  const D lo = hn::Set(d, lower);
  const D hi = hn::Set(d, upper);
  const D per_unit = hn::Set(d, 1.0) / direction;
  const D to_lower = (lo - origin) * per_unit;
  const D to_upper = (hi - origin) * per_unit;
  const auto parallel = hn::Eq(direction, hn::Zero(d));
  const auto inside = hn::And(hn::Gt(origin, lo), hn::Lt(origin, hi));
  const D far = hn::Set(d, 1e300);
  const D enter =
      hn::IfThenElse(parallel, hn::IfThenElse(inside, hn::Zero(d), far), hn::Min(to_lower, to_upper));
  const D leave = hn::IfThenElse(parallel, far, hn::Max(to_lower, to_upper));
  begin = hn::Max(begin, enter);
  end = hn::Min(end, leave);
}

/// Rays of half a packet (doubles are twice as wide); pixels by x and y, both as whole numbers in doubles.
HWY_INLINE void setHalf(const RaycastTask& task, const double* x, const double* y, const double* limits,
                        float* const to[7]) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, hn::ScalableTag<double>> narrow;
  const CameraView& camera = task.camera;
  const auto set = [&](double value) HWY_ATTR { return hn::Set(d, value); };
  const D width = set(camera.size.width);
  const D height = set(camera.size.height);
  const D half = set(camera.half_height);
  const D px = ((hn::Load(d, x) * set(2.0) + set(1.0) - width) / height + set(camera.shift_x)) * half;
  const D py = (set(1.0) - (hn::Load(d, y) * set(2.0) + set(1.0)) / height + set(camera.shift_y)) * half;
  const D offset_x = set(camera.right.x) * px + set(camera.up.x) * py;
  const D offset_y = set(camera.right.y) * px + set(camera.up.y) * py;
  const D offset_z = set(camera.right.z) * px + set(camera.up.z) * py;
  D origin_x = set(camera.eye.x), origin_y = set(camera.eye.y), origin_z = set(camera.eye.z);
  D dx = set(camera.forward.x), dy = set(camera.forward.y), dz = set(camera.forward.z);
  if (camera.orthographic) {
    origin_x = origin_x + offset_x;
    origin_y = origin_y + offset_y;
    origin_z = origin_z + offset_z;
  } else {
    dx = dx + offset_x;
    dy = dy + offset_y;
    dz = dz + offset_z;
  }
  const D norm = set(1.0) / hn::Sqrt(dx * dx + dy * dy + dz * dz);
  dx = dx * norm;
  dy = dy * norm;
  dz = dz * norm;
  D begin = hn::Zero(d);
  D end = hn::Load(d, limits);
  const Vec3d lower = task.volume.lower();
  const Vec3d upper = task.volume.upper();
  clipAxis(origin_x, dx, lower.x, upper.x, begin, end);
  clipAxis(origin_y, dy, lower.y, upper.y, begin, end);
  clipAxis(origin_z, dz, lower.z, upper.z, begin, end);
  const auto hits = hn::Gt(end, begin);
  begin = hn::IfThenElseZero(hits, begin);
  end = hn::IfThenElseZero(hits, end);
  const auto store = [&](D value, float* where)
                         HWY_ATTR { hn::Store(hn::DemoteTo(narrow, value), narrow, where); };
  store(origin_x + dx * begin, to[0]);
  store(origin_y + dy * begin, to[1]);
  store(origin_z + dz * begin, to[2]);
  store(dx, to[3]);
  store(dy, to[4]);
  store(dz, to[5]);
  store(end - begin, to[6]);
}

HWY_INLINE Rays setRays(const RaycastTask& task, const Pixel* pixels, const float* limits, int count) {
  constexpr std::size_t kLanes = hn::MaxLanes(hn::ScalableTag<float>());
  HWY_ALIGN double x[kLanes], y[kLanes], end[kLanes];
  HWY_ALIGN float parts[7][kLanes];
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    const Pixel pixel = pixels[lane < count ? lane : 0];
    x[lane] = pixel.x;
    y[lane] = pixel.y;
    end[lane] = lane >= count ? 0.0 : (limits != nullptr ? limits[lane] : 1e300);
  }
  const std::size_t half = hn::Lanes(hn::ScalableTag<double>());
  for (std::size_t lane = 0; lane < kLanes; lane += half) {
    float* const to[7] = {parts[0] + lane, parts[1] + lane, parts[2] + lane, parts[3] + lane,
                          parts[4] + lane, parts[5] + lane, parts[6] + lane};
    setHalf(task, x + lane, y + lane, end + lane, to);
  }
  const hn::ScalableTag<float> f;
  return {{hn::Load(f, parts[0]), hn::Load(f, parts[1]), hn::Load(f, parts[2])},
          {hn::Load(f, parts[3]), hn::Load(f, parts[4]), hn::Load(f, parts[5])},
          hn::Load(f, parts[6])};
}

/// The modes, lane by lane; see render/compositing.h for what they are. live() gives the lanes for which a
/// later sample can matter; add() those that the sample changed.
struct DvrLanes {
  static constexpr bool kNeedsColor = true;
  Color sum;
  HWY_INLINE DvrLanes() : sum(Color::zero()) {}
  HWY_INLINE M live(const RaycastTask& task, M active) const {
    return task.exact ? active : hn::And(active, hn::Le(sum.a, hn::Set(kF, kOpaqueEnough)));
  }
  HWY_INLINE M canSkip(F level) const { return hn::Lt(level, hn::Set(kF, SkipView::kNever)); }
  HWY_INLINE M add(const RaycastTask& /*task*/, M /*active*/, F /*f*/, const Color& sample) {
    sum = sum.plus(sample, hn::Set(kF, 1.0F) - sum.a);
    return hn::Gt(sample.a, hn::Zero(kF));
  }
  HWY_INLINE Color result(const RaycastTask& /*task*/) const { return sum; }
};

struct MipLanes {
  static constexpr bool kNeedsColor = false;
  F highest;
  HWY_INLINE MipLanes() : highest(hn::Set(kF, -1.0F)) {}
  HWY_INLINE M live(const RaycastTask& task, M active) const {
    return hn::And(active, hn::Lt(highest, hn::Set(kF, task.volume_highest_f)));
  }
  HWY_INLINE M canSkip(F level) const { return hn::Le(level, highest); }
  HWY_INLINE M add(const RaycastTask& /*task*/, M active, F f, const Color& /*sample*/) {
    const M raised = hn::And(active, hn::Gt(f, highest));
    highest = hn::IfThenElse(raised, f, highest);
    return raised;
  }
  HWY_INLINE Color result(const RaycastTask& task) const {
    const M any = hn::Ge(highest, hn::Zero(kF));
    const I index = tableIndex(task.transfer, hn::IfThenElseZero(any, highest));
    return lookUp(task.transfer.projected, index).where(any);
  }
};

struct MidaLanes {
  static constexpr bool kNeedsColor = true;
  Color sum;
  MipLanes mip;
  HWY_INLINE MidaLanes() : sum(Color::zero()) {}
  HWY_INLINE M live(const RaycastTask& task, M active) const {
    if (task.exact) return active;
    return hn::Or(hn::And(active, hn::Le(sum.a, hn::Set(kF, kOpaqueEnough))), mip.live(task, active));
  }
  HWY_INLINE M canSkip(F level) const { return mip.canSkip(level); }
  HWY_INLINE M add(const RaycastTask& task, M active, F f, const Color& sample) {
    const F one = hn::Set(kF, 1.0F);
    const F before = hn::Max(mip.highest, hn::Zero(kF));
    const F delta = hn::IfThenElseZero(active, hn::Max(f - before, hn::Zero(kF)));
    const M raised = mip.add(task, active, f, sample);
    const F beta = one - delta * hn::Set(kF, 1.0F + (task.mida_gamma < 0.0F ? task.mida_gamma : 0.0F));
    sum = sum.times(beta).plus(sample, one - beta * sum.a);
    return hn::Or(raised, hn::Gt(sample.a, hn::Zero(kF)));
  }
  HWY_INLINE Color result(const RaycastTask& task) const {
    if (task.mida_gamma <= 0.0F) return sum;
    return sum.times(hn::Set(kF, 1.0F - task.mida_gamma))
        .plus(mip.result(task), hn::Set(kF, task.mida_gamma));
  }
};

/// Marches a packet of rays; see RaycastTask::march().
template <class Lanes>
HWY_INLINE Color castPacket(const RaycastTask& task, const Rays& rays, long long& samples) {
  const F step = hn::Set(kF, task.step_voxels);
  const F half = hn::Set(kF, 0.5F);
  const F one = hn::Set(kF, 1.0F);
  const F per_step = hn::Set(kF, 1.0F / task.step_voxels);
  const F whole = hn::Floor(rays.length * per_step);
  const bool skips = task.skip.levels != nullptr;
  const BrickWalk bricks(task, rays.direction);
  Lanes lanes;
  F n = hn::Zero(kF);
  F next_brick = hn::Zero(kF);
  M active = hn::Lt(n, whole);
  M unchanged = active;  // lanes whose last sample changed nothing
  while (true) {
    // Lanes in a new brick look whether they can pass over it, and over those behind it. While most lanes
    // find something to show this would be in vain.
    M look = hn::And(hn::And(active, unchanged), hn::Ge(n, next_brick));
    if (skips && 2 * hn::CountTrue(kF, look) >= hn::CountTrue(kF, active)) {
      while (!hn::AllFalse(kF, look)) {
        const Vec3F position = rays.start.along(rays.direction, (n + half) * step);
        F level;
        const F leave = bricks.look(position, level);
        const F beyond = hn::Min(n + one + hn::Floor(leave * per_step), whole);
        next_brick = hn::IfThenElse(look, beyond, next_brick);
        look = hn::And(look, lanes.canSkip(level));
        n = hn::IfThenElse(look, beyond, n);
        active = hn::And(active, hn::Lt(n, whole));
        look = hn::And(look, active);
      }
    }
    if (hn::AllFalse(kF, active)) break;
    const Vec3F position = rays.start.along(rays.direction, (n + half) * step);
    M shown = active;
    const F value = sampleVolume(task.volume, position, shown);
    const F f = normalized(task.transfer, value);
    Color color = Color::zero();
    if (Lanes::kNeedsColor) color = lookUp(task.transfer.samples, tableIndex(task.transfer, f)).where(shown);
    unchanged = hn::Not(lanes.add(task, shown, f, color));
    samples += static_cast<long long>(hn::CountTrue(kF, active));
    n = n + one;
    active = hn::And(lanes.live(task, active), hn::Lt(n, whole));
  }
  // The last piece of each ray is shorter than a step.
  const F rest = rays.length - whole * step;
  M last = lanes.live(task, hn::Gt(rest, hn::Zero(kF)));
  if (!hn::AllFalse(kF, last)) {
    const Vec3F position = rays.start.along(rays.direction, rays.length - half * rest);
    M shown = last;
    const F f = normalized(task.transfer, sampleVolume(task.volume, position, shown));
    Color color = Color::zero();
    if (Lanes::kNeedsColor) {
      color =
          lookUp(task.transfer.samples, tableIndex(task.transfer, f)).where(shown).shortened(rest * per_step);
    }
    lanes.add(task, shown, f, color);
  }
  return lanes.result(task);
}

template <class Lanes>
HWY_INLINE long long castAll(const RaycastTask& task, const Pixel* pixels, const float* limits, int count,
                             Rgba* fronts) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(hn::ScalableTag<float>()));
  HWY_ALIGN float rgba[4 * kLanes];
  long long samples = 0;
  for (int first = 0; first < count; first += kLanes) {
    const int used = count - first < kLanes ? count - first : kLanes;
    const Rays rays = setRays(task, pixels + first, limits != nullptr ? limits + first : nullptr, used);
    const Color color = castPacket<Lanes>(task, rays, samples);
    hn::StoreInterleaved4(color.r, color.g, color.b, color.a, kF, rgba);
    for (int lane = 0; lane < used; ++lane) {
      fronts[first + lane] = {rgba[4 * lane], rgba[4 * lane + 1], rgba[4 * lane + 2], rgba[4 * lane + 3]};
    }
  }
  return samples;
}

long long cast(const RaycastTask& task, CompositingMode mode, const Pixel* pixels, const float* limits,
               int count, Rgba* fronts) {
  switch (mode) {
    case CompositingMode::mida:
      return castAll<MidaLanes>(task, pixels, limits, count, fronts);
    case CompositingMode::mip:
      return castAll<MipLanes>(task, pixels, limits, count, fronts);
    default:
      return castAll<DvrLanes>(task, pixels, limits, count, fronts);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace emscape::render {

HWY_EXPORT(cast);

bool packetsCanCast(const VolumeView& volume) {
  constexpr long long kMostVoxels = 1LL << 31;
  return !volume.has_nan && volume.dims.x >= 2 && volume.dims.count() < kMostVoxels;
}

long long castPackets(const RaycastTask& task, CompositingMode mode, const Pixel* pixels, const float* limits,
                      int count, Rgba* fronts) {
  return HWY_DYNAMIC_DISPATCH(cast)(task, mode, pixels, limits, count, fronts);
}

}  // namespace emscape::render
#endif
