#include "render/cpu/packets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cpu/packets.cpp"
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

#include "render/cpu/packet_sampling-inl.h"
#include "render/cpu/packet_shading-inl.h"
#include "render/cpu/packet_surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {

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
HWY_INLINE void setHalf(const RaycastTask& task, const double* x, const double* y, const double* first,
                        const double* last, float* const to[8]) {
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
  D begin = hn::Load(d, first);
  D end = hn::Load(d, last);
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
  store(begin, to[7]);
}

HWY_INLINE Rays setRays(const RaycastTask& task, const Pixel* pixels, const RayBounds* bounds, int count) {
  constexpr std::size_t kLanes = hn::MaxLanes(hn::ScalableTag<float>());
  HWY_ALIGN double x[kLanes], y[kLanes], begin[kLanes], end[kLanes];
  HWY_ALIGN float parts[8][kLanes];
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    const Pixel pixel = pixels[lane < count ? lane : 0];
    x[lane] = pixel.x;
    y[lane] = pixel.y;
    const RayBounds bound = lane >= count ? RayBounds{0, 0} : bounds != nullptr ? bounds[lane] : RayBounds{};
    begin[lane] = bound.begin;
    end[lane] = bound.end;
  }
  const std::size_t half = hn::Lanes(hn::ScalableTag<double>());
  for (std::size_t lane = 0; lane < kLanes; lane += half) {
    float* const to[8] = {parts[0] + lane, parts[1] + lane, parts[2] + lane, parts[3] + lane,
                          parts[4] + lane, parts[5] + lane, parts[6] + lane, parts[7] + lane};
    setHalf(task, x + lane, y + lane, begin + lane, end + lane, to);
  }
  const hn::ScalableTag<float> f;
  return {{hn::Load(f, parts[0]), hn::Load(f, parts[1]), hn::Load(f, parts[2])},
          {hn::Load(f, parts[3]), hn::Load(f, parts[4]), hn::Load(f, parts[5])},
          hn::Load(f, parts[6]),
          hn::Gt(hn::Load(f, parts[7]), hn::Zero(f))};
}

/// See OccupancyLookahead.
class LanesAhead {
 public:
  HWY_INLINE LanesAhead(const RaycastTask& task, const Rays& rays, const Segments& segments,
                        const BrickWalk& bricks)
      : task_(task),
        rays_(rays),
        segments_(segments),
        bricks_(bricks),
        highest_(hn::Zero(kF)),
        until_(hn::Zero(kF)) {}

  /// The lanes on whose ray a sample from `next` on can have a larger f.
  HWY_INLINE M exceeds(M lanes, F next, F f) {
    const M stale = hn::And(lanes, hn::Ge(next, until_));
    if (!hn::AllFalse(kF, stale)) walk(stale, next);
    return hn::And(lanes, hn::Gt(highest_, f));
  }

 private:
  HWY_INLINE void walk(M lanes, F next) {
    highest_ = hn::IfThenElse(lanes, hn::Set(kF, -1.0F), highest_);
    until_ = hn::IfThenElse(lanes, segments_.count, until_);
    for (M on = hn::And(lanes, hn::Lt(next, segments_.count)); !hn::AllFalse(kF, on);
         on = hn::And(on, hn::Lt(next, segments_.count))) {
      I brick;
      const F leave = bricks_.look(rays_.start.along(rays_.direction, segments_.middle(next)), brick);
      const F found = hn::GatherIndex(kF, task_.skip.highest, brick);
      next = hn::Min(next + hn::Set(kF, 1.0F) + hn::Floor(leave * segments_.per_step), segments_.count);
      const M higher = hn::And(on, hn::Ge(found, highest_));
      highest_ = hn::IfThenElse(higher, found, highest_);
      until_ = hn::IfThenElse(higher, next, until_);
    }
  }

  const RaycastTask& task_;
  const Rays& rays_;
  const Segments& segments_;
  const BrickWalk& bricks_;
  F highest_, until_;
};

/// The modes, lane by lane; see render/cast/compositing.h. live() returns the lanes for which a sample from
/// `next` on can matter, add() those that the sample changed.
struct DvrLanes {
  static constexpr bool kNeedsColor = true;
  Color sum;
  HWY_INLINE DvrLanes() : sum(Color::zero()) {}
  HWY_INLINE M live(const RaycastTask& task, LanesAhead& /*ahead*/, M active, F /*next*/) const {
    return task.isExact() ? active : hn::And(active, hn::Le(sum.a, hn::Set(kF, kOpaqueEnough)));
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
  HWY_INLINE M live(const RaycastTask& task, LanesAhead& /*ahead*/, M active, F /*next*/) const {
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
  HWY_INLINE M live(const RaycastTask& task, LanesAhead& ahead, M active, F next) const {
    if (task.isExact()) return active;
    const M opaque = hn::And(active, hn::Gt(sum.a, hn::Set(kF, kOpaqueEnough)));
    if (hn::AllFalse(kF, opaque)) return active;
    return hn::Or(hn::AndNot(opaque, active), ahead.exceeds(opaque, next, mip.highest));
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
template <class Lanes, class Reader, bool kShades>
HWY_INLINE Color castPacket(const RaycastTask& task, const Rays& rays, long long& samples) {
  const F one = hn::Set(kF, 1.0F);
  const F half = hn::Set(kF, 0.5F);
  const Segments segments(rays, task.step_voxels);
  const BrickWalk bricks(task, rays.direction);
  const Light light(task.shading, rays.direction);
  LanesAhead ahead(task, rays, segments, bricks);
  Lanes lanes;
  // Adds the sample of some lanes; returns those that it changed.
  const auto take = [&](const Vec3F& position, M shown, bool last) HWY_ATTR {
    const F value = sampleVolume<Reader>(task.volume, position, shown);
    const F f = normalized(task.transfer, value);
    Color color = Color::zero();
    if (Lanes::kNeedsColor) {
      color = lookUp(task.transfer.samples, tableIndex(task.transfer, f)).where(shown);
      const M visible = hn::Gt(color.a, hn::Zero(kF));
      if (kShades && !hn::AllFalse(kF, visible)) {
        const F scale = hn::Set(kF, task.transfer.scale);
        const Vec3F gradient = gradientAt(task.volume, position, value, visible);
        color = light.litFog(color, {gradient.x * scale, gradient.y * scale, gradient.z * scale});
      }
      if (last) color = color.shortened(segments.last * segments.per_step);
    }
    return lanes.add(task, shown, f, color);
  };

  F n = hn::Zero(kF);
  F next_brick = hn::Zero(kF);
  M active = hn::Lt(n, segments.whole);
  M unchanged = active;  // lanes whose last sample changed nothing
  while (true) {
    // Lanes in a new brick test whether they can skip it and those behind it. While most lanes have visible
    // samples, this is not worthwhile.
    M look = hn::And(hn::And(active, unchanged), hn::Ge(n, next_brick));
    if (task.skip.levels != nullptr && 2 * hn::CountTrue(kF, look) >= hn::CountTrue(kF, active)) {
      while (!hn::AllFalse(kF, look)) {
        I brick;
        const F leave = bricks.look(rays.start.along(rays.direction, (n + half) * segments.step), brick);
        const F beyond = hn::Min(n + one + hn::Floor(leave * segments.per_step), segments.whole);
        next_brick = hn::IfThenElse(look, beyond, next_brick);
        look = hn::And(look, lanes.canSkip(hn::GatherIndex(kF, task.skip.levels, brick)));
        n = hn::IfThenElse(look, beyond, n);
        active = hn::And(active, hn::Lt(n, segments.whole));
        look = hn::And(look, active);
      }
    }
    if (hn::AllFalse(kF, active)) break;
    const Vec3F position = rays.start.along(rays.direction, (n + half) * segments.step);
    unchanged = hn::Not(take(position, active, false));
    samples += static_cast<long long>(hn::CountTrue(kF, active));
    n = n + one;
    active = hn::And(lanes.live(task, ahead, active, n), hn::Lt(n, segments.whole));
  }
  const M rest = lanes.live(task, ahead, hn::Lt(segments.whole, segments.count), segments.whole);
  if (!hn::AllFalse(kF, rest)) {
    take(rays.start.along(rays.direction, segments.middle(segments.whole)), rest, true);
  }
  return lanes.result(task);
}

HWY_INLINE Color castSurface(const RaycastTask& task, const Rays& rays, long long& /*samples*/) {
  return SurfaceSearch(task, rays).color();
}

using CastPacket = Color (*)(const RaycastTask&, const Rays&, long long&);

template <CastPacket kCast>
HWY_NOINLINE long long castAll(const RaycastTask& task, const Pixel* pixels, const RayBounds* bounds,
                               int count, Rgba* fronts) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(hn::ScalableTag<float>()));
  HWY_ALIGN float rgba[4 * kLanes];
  long long samples = 0;
  for (int first = 0; first < count; first += kLanes) {
    const int used = count - first < kLanes ? count - first : kLanes;
    const Rays rays = setRays(task, pixels + first, bounds != nullptr ? bounds + first : nullptr, used);
    const Color color = kCast(task, rays, samples);
    hn::StoreInterleaved4(color.r, color.g, color.b, color.a, kF, rgba);
    for (int lane = 0; lane < used; ++lane) {
      fronts[first + lane] = {rgba[4 * lane], rgba[4 * lane + 1], rgba[4 * lane + 2], rgba[4 * lane + 3]};
    }
  }
  return samples;
}

/// The modes without shading.
template <class Lanes>
HWY_INLINE long long castPlain(const RaycastTask& task, const Pixel* pixels, const RayBounds* bounds,
                               int count, Rgba* fronts) {
  return task.volume.coded.codes != nullptr
             ? castAll<castPacket<Lanes, CodedReader, false>>(task, pixels, bounds, count, fronts)
             : castAll<castPacket<Lanes, ValueReader, false>>(task, pixels, bounds, count, fronts);
}

/// The modes with shading, which needs small differences that codes would round.
template <class Lanes>
HWY_INLINE long long castFog(const RaycastTask& task, const Pixel* pixels, const RayBounds* bounds, int count,
                             Rgba* fronts) {
  return task.shading.shades_fog
             ? castAll<castPacket<Lanes, ValueReader, true>>(task, pixels, bounds, count, fronts)
             : castPlain<Lanes>(task, pixels, bounds, count, fronts);
}

long long cast(const RaycastTask& task, CompositingMode mode, const Pixel* pixels, const RayBounds* bounds,
               int count, Rgba* fronts) {
  switch (mode) {
    case CompositingMode::mida:
      return castFog<MidaLanes>(task, pixels, bounds, count, fronts);
    case CompositingMode::mip:
      return castPlain<MipLanes>(task, pixels, bounds, count, fronts);
    case CompositingMode::iso:
      return castAll<castSurface>(task, pixels, bounds, count, fronts);
    case CompositingMode::dvr:
      break;
  }
  return castFog<DvrLanes>(task, pixels, bounds, count, fronts);
}

}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace emscape::render {

HWY_EXPORT(cast);

bool packetsCanCast(const VolumeView& volume) {
  constexpr long long kMaxVoxels = 1LL << 31;
  return volume.all_finite && volume.dims.x >= 2 && volume.dims.count() < kMaxVoxels;
}

namespace {
/// True if a volume's codes are as accurate as its values for the transfer table.
bool codesServe(const QuantizedValues& coded, const Dims& dims, const TransferView& transfer) {
  constexpr long long kMaxCodes = 1LL << 30;  // their byte offsets are 32-bit numbers
  constexpr float kCoarsest = 1.0F / 4096;    // of the transfer function's interval
  return coded.codes != nullptr && dims.count() < kMaxCodes && coded.step() * transfer.scale <= kCoarsest;
}
}  // namespace

long long castPackets(const RaycastTask& given, CompositingMode mode, const Pixel* pixels,
                      const RayBounds* bounds, int count, Rgba* fronts) {
  RaycastTask task = given;
  if (!codesServe(task.volume.coded, task.volume.dims, task.transfer)) task.volume.coded.codes = nullptr;
  return HWY_DYNAMIC_DISPATCH(cast)(task, mode, pixels, bounds, count, fronts);
}

}  // namespace emscape::render
#endif
