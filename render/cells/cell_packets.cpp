#include "render/cells/cell_packets.h"

#include "base/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cells/cell_packets.cpp"
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

#ifndef EMSCAPE_RENDER_CELLS_CELL_PACKETS_ONCE
#define EMSCAPE_RENDER_CELLS_CELL_PACKETS_ONCE
namespace emscape::render {
namespace {

/// What all rays of a picture share.
struct PacketScene {
  CellMeshView mesh;
  IntervalsView transfer;
  PsiLookup psi;
  const CellPackets::Interval* intervals;
};

}  // namespace
}  // namespace emscape::render
#endif

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {
namespace {

#if HWY_CAP_GE256
namespace hn = hwy::HWY_NAMESPACE;

using TagD = hn::ScalableTag<double>;
using TagL = hn::ScalableTag<std::int64_t>;
using TagI = hn::Rebind<std::int32_t, TagD>;
using TagF = hn::Rebind<float, TagD>;
using D = hn::Vec<TagD>;
using L = hn::Vec<TagL>;
using I = hn::Vec<TagI>;
using M = hn::Mask<TagD>;
constexpr TagD kD;
constexpr TagL kL;
constexpr TagI kI;
constexpr TagF kF;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(kD));

HWY_INLINE I narrow(L x) {
  const hn::Rebind<std::uint32_t, TagD> half;
  const hn::RebindToUnsigned<TagL> wide;
  return hn::BitCast(kI, hn::TruncateTo(half, hn::BitCast(wide, x)));
}
HWY_INLINE L gather(const std::int32_t* base, L index) {
  return hn::PromoteTo(kL, hn::GatherIndex(kI, base, narrow(index)));
}
HWY_INLINE D gather(const float* base, L index) {
  return hn::PromoteTo(kD, hn::GatherIndex(kF, base, narrow(index)));
}
HWY_INLINE L chosen(M mask, L yes, L no) {
  return hn::IfThenElse(hn::RebindMask(kL, mask), yes, no);
}
HWY_INLINE D chosen(M mask, D yes, D no) {
  return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE M chosen(M mask, M yes, M no) {
  return hn::Or(hn::And(mask, yes), hn::AndNot(mask, no));
}
HWY_INLINE M isSame(L a, L b) {
  return hn::RebindMask(kD, hn::Eq(a, b));
}

/// A number of every lane, in memory.
struct alignas(64) Reals {
  double of[kLanes] = {};
  HWY_INLINE D operator()() const { return hn::Load(kD, of); }
  HWY_INLINE void operator=(D value) { hn::Store(value, kD, of); }
};
struct alignas(64) Wholes {
  std::int64_t of[kLanes] = {};
  HWY_INLINE L operator()() const { return hn::Load(kL, of); }
  HWY_INLINE void operator=(L value) { hn::Store(value, kL, of); }
};

/// See Corner.
struct LaneCorner {
  Reals u, v, distance, value;
  Wholes point;
};

/// The same in registers.
struct CornerV {
  D u, v, distance, value;
  L point;
};
HWY_INLINE CornerV loaded(const LaneCorner& c) {
  return {c.u(), c.v(), c.distance(), c.value(), c.point()};
}
HWY_INLINE void store(const CornerV& from, LaneCorner& to) {
  to.u = from.u;
  to.v = from.v;
  to.distance = from.distance;
  to.value = from.value;
  to.point = from.point;
}
HWY_INLINE CornerV chosen(M mask, const CornerV& yes, const CornerV& no) {
  return {chosen(mask, yes.u, no.u), chosen(mask, yes.v, no.v), chosen(mask, yes.distance, no.distance),
          chosen(mask, yes.value, no.value), chosen(mask, yes.point, no.point)};
}
HWY_INLINE D spanned(const CornerV& a, const CornerV& b) {
  return a.u * b.v - a.v * b.u;
}
/// See Crossing::mean().
HWY_INLINE D mean(const D* area, D sum, M is_face, D a, D b, D c) {
  const D weighed = area[0] * a + area[1] * b + area[2] * c;
  const D inside = weighed / sum;
  if (HWY_LIKELY(hn::AllTrue(kD, is_face))) return inside;
  return chosen(is_face, inside, (a + b + c) / hn::Set(kD, 3.0));
}

/// What RayIntegral does, a lane each.
class IntegralLanes {
 public:
  explicit IntegralLanes(const PacketScene& scene) : scene_(scene) {}

  void reset(int lane) {
    red_.of[lane] = green_.of[lane] = blue_.of[lane] = 0;
    through_.of[lane] = 1;
    last_.of[lane] = NAN;
  }
  Rgba color(int lane) const {
    return {static_cast<float>(red_.of[lane]), static_cast<float>(green_.of[lane]),
            static_cast<float>(blue_.of[lane]), static_cast<float>(1 - through_.of[lane])};
  }
  HWY_INLINE D through() const { return through_(); }
  double through(int lane) const { return through_.of[lane]; }

  /// See RayIntegral::add(). @param on  lanes that have a segment
  HWY_INLINE void add(M on, D front, D back, D length) {
    const L one = hn::Set(kL, 1);
    L interval = interval_();
    const M stale = hn::AndNot(hn::Eq(front, last_()), on);  // at first last_ is NaN
    if (HWY_UNLIKELY(!hn::AllFalse(kD, stale))) interval = found(stale, front, interval);
    last_ = chosen(on, back, last_());
    const M rises = hn::Gt(back, front);
    const M falls = hn::Lt(back, front);
    D lower = field(interval, &CellPackets::Interval::lower);
    D upper = field(interval, &CellPackets::Interval::upper);
    for (;;) {  // at a control point the interval is that towards the back
      const M up = hn::And(on, hn::And(rises, hn::Le(upper, front)));
      const M down = hn::And(on, hn::And(falls, hn::Ge(lower, front)));
      if (HWY_LIKELY(hn::AllFalse(kD, hn::Or(up, down)))) break;
      interval = chosen(up, interval + one, chosen(down, interval - one, interval));
      lower = field(interval, &CellPackets::Interval::lower);
      upper = field(interval, &CellPackets::Interval::upper);
    }
    const D per_value = length / (back - front);  // not used where they are equal
    D value = front, left = length;
    for (;;) {
      const M ends = chosen(rises, hn::Le(back, upper), hn::Ge(back, lower));
      const D end = hn::IfThenElse(ends, back, hn::IfThenElse(rises, upper, lower));
      const M whole = hn::And(ends, hn::Eq(value, front));
      left = hn::IfThenElse(whole, length, (end - value) * per_value);
      addPiece(on, interval, value, end, left);
      const M further = hn::AndNot(ends, on);
      if (HWY_LIKELY(hn::AllFalse(kD, further))) break;
      on = further;
      value = hn::IfThenElse(further, end, value);
      interval = chosen(further, chosen(rises, interval + one, interval - one), interval);
      lower = field(interval, &CellPackets::Interval::lower);
      upper = field(interval, &CellPackets::Interval::upper);
    }
    interval_ = interval;
  }

 private:
  HWY_INLINE D field(L interval, double CellPackets::Interval::*member) const {
    static_assert(sizeof(CellPackets::Interval) == 16 * sizeof(double));
    return hn::GatherIndex(kD, &(scene_.intervals->*member), hn::ShiftLeft<4>(interval));
  }
  HWY_INLINE D field(L interval, double (CellPackets::Interval::*member)[3], int n) const {
    return hn::GatherIndex(kD, &(scene_.intervals->*member)[n], hn::ShiftLeft<4>(interval));
  }

  /// The interval in which the value of some lanes lies; that of the others is as before.
  HWY_NOINLINE L found(M lanes, D front, L interval) const {
    Wholes to;
    Reals value;
    to = interval;
    value = front;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(kD, lanes, bits);
    for (int lane = 0; lane < kLanes; ++lane) {
      if ((bits[0] >> lane & 1) != 0) to.of[lane] = scene_.transfer.indexOf(value.of[lane]);
    }
    return to();
  }

  HWY_INLINE void addPiece(M on, L interval, D front, D back, D length) {
    const D zero = hn::Zero(kD), one = hn::Set(kD, 1.0), half = hn::Set(kD, 0.5);
    on = hn::And(on, hn::Gt(length, zero));
    on = hn::And(on, hn::Eq(field(interval, &CellPackets::Interval::clear), zero));
    if (hn::AllFalse(kD, on)) return;
    const D base = field(interval, &CellPackets::Interval::base);
    const D per_unit = field(interval, &CellPackets::Interval::per_unit);
    const D low = field(interval, &CellPackets::Interval::extinction);
    const D rise = field(interval, &CellPackets::Interval::extinction_rise);
    // Zero in the other lanes: what they hold may be unknown.
    const D at_front = hn::IfThenElseZero(on, (front - base) * per_unit);
    const D at_back = hn::IfThenElseZero(on, (back - base) * per_unit);
    const D depth_front = hn::IfThenElseZero(on, hn::MulAdd(at_front, rise, low) * length);
    const D depth_back = hn::IfThenElseZero(on, hn::MulAdd(at_back, rise, low) * length);
    const D opacity = one - hn::Exp(kD, hn::Neg(half * (depth_front + depth_back)));
    const D of_psi = psi(depth_back, depth_front);
    const D through = through_();
    const D weight_front = hn::IfThenElseZero(on, (one - of_psi) * through);
    const D weight_back = hn::IfThenElseZero(on, (of_psi - one + opacity) * through);
    const D weight = weight_front + weight_back;
    const D weight_rise = hn::MulAdd(weight_front, at_front, weight_back * at_back);
    const auto mixed = [&](D sum, int n) HWY_ATTR {
      return hn::MulAdd(weight, field(interval, &CellPackets::Interval::color, n),
                        hn::MulAdd(weight_rise, field(interval, &CellPackets::Interval::color_rise, n), sum));
    };
    red_ = mixed(red_(), 0);
    green_ = mixed(green_(), 1);
    blue_ = mixed(blue_(), 2);
    through_ = hn::IfThenElse(on, hn::NegMulAdd(through, opacity, through), through);
  }

  /// See PsiLookup.
  HWY_INLINE D psi(D back, D front) const {
    const auto set = [](double x) HWY_ATTR { return hn::Set(kD, x); };
    const D greater = hn::Max(back, front);
    const D apart = back - front;
    // 1 - front / 3 - back / 6 + (front^2 / 3 + front apart / 4 + apart^2 / 20) / 2
    const D squares = hn::MulAdd(front * front, set(1.0 / 3),
                                 hn::MulAdd(front * apart, set(0.25), apart * apart * set(0.05)));
    D result = hn::MulAdd(squares, set(0.5), set(1.0) - front * set(1.0 / 3) - back * set(1.0 / 6));
    const M deep = hn::Ge(greater, set(PsiLookup::kSmallDepth));
    if (hn::AllFalse(kD, deep)) return result;
    result = hn::IfThenElse(deep, interpolated(back, front), result);
    const M far = hn::Gt(greater, set(PsiLookup::kMaxDepth));
    if (HWY_LIKELY(hn::AllFalse(kD, far))) return result;
    Reals of_back, of_front, to;
    of_back = back;
    of_front = front;
    to = result;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double b = of_back.of[lane], f = of_front.of[lane];
      if (b > PsiLookup::kMaxDepth || f > PsiLookup::kMaxDepth) to.of[lane] = render::psi(b, f);
    }
    return to();
  }
  HWY_INLINE D interpolated(D back, D front) const {
    constexpr int kEntries = PsiLookup::kEntries;
    const D one = hn::Set(kD, 1.0), scale = hn::Set(kD, kEntries - 1.0), most = hn::Set(kD, kEntries - 2.0);
    const D x = back / (one + back) * scale, y = front / (one + front) * scale;
    const D i = hn::Min(hn::Floor(x), most), j = hn::Min(hn::Floor(y), most);
    const D u = x - i, v = y - j;
    const L entry =
        hn::PromoteTo(kL, hn::DemoteTo(kI, hn::MulAdd(j, hn::Set(kD, static_cast<double>(kEntries)), i)));
    const auto mixed = [&](const float* values) HWY_ATTR {
      const auto* pairs = reinterpret_cast<const std::int64_t*>(values);
      const L pair = hn::GatherOffset(kL, pairs, hn::ShiftLeft<2>(entry));
      const D first = hn::PromoteTo(kD, hn::BitCast(kF, narrow(pair)));
      const D second = hn::PromoteTo(kD, hn::BitCast(kF, narrow(hn::ShiftRight<32>(pair))));
      return hn::MulAdd(second, u, first * (one - u));
    };
    const D low = mixed(scene_.psi.values), high = mixed(scene_.psi.values + kEntries);
    return hn::MulAdd(high, v, low * (one - v));
  }

  const PacketScene& scene_;
  Reals red_, green_, blue_, through_, last_;
  Wholes interval_;
};

/// Rays on their ways, a lane each; see march().
class MarchLanes {
 public:
  MarchLanes(const PacketScene& scene, MarchTask* tasks, int count)
      : scene_(scene), next_(tasks), end_(tasks + count), integral_(scene) {
    for (int lane = 0; lane < kLanes; ++lane) refill(lane);
  }

  long long march() {
    long long cells = 0;
    while (busy_ > 0) {
      cells += busy_;
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(kD, step(), bits);
      if (HWY_LIKELY(bits[0] == 0)) continue;
      for (int lane = 0; lane < kLanes; ++lane) {
        if ((bits[0] >> lane & 1) != 0) refill(lane);
      }
    }
    return cells;
  }

 private:
  /// Lets a lane go on with its ray's next entry, or with another ray; without one it is idle.
  HWY_NOINLINE void refill(int lane) {
    if (MarchTask* const task = task_[lane]) {
      --busy_;
      been_.of[lane] = fmax(distance_.of[lane], been_.of[lane]);
      if (enter(lane)) return;
      task->color = integral_.color(lane);
      task_[lane] = nullptr;
    }
    while (next_ < end_) {
      MarchTask& task = *next_++;
      task_[lane] = &task;
      entry_[lane] = 0;
      been_.of[lane] = -HUGE_VAL;
      integral_.reset(lane);
      if (enter(lane)) return;
      task.color = integral_.color(lane);
      task_[lane] = nullptr;
    }
    live_.of[lane] = 0;
    cell_.of[lane] = fourth_.of[lane] = 0;
  }

  /// @return false if the ray has no further entry that counts
  bool enter(int lane) {
    const MarchTask& task = *task_[lane];
    if (entry_[lane] == task.entries.size()) return false;
    const EntryHit& entry = task.entries[entry_[lane]++];
    if (entry.distance >= task.limits.distance || integral_.through(lane) < task.limits.through) return false;
    const Crossing crossing = entryOf(scene_.mesh, task.frame, entry.face);
    for (int n = 0; n < 3; ++n) {
      const Corner& corner = crossing.corner[n];
      LaneCorner& to = corner_[n];
      to.u.of[lane] = corner.at.u;
      to.v.of[lane] = corner.at.v;
      to.distance.of[lane] = corner.at.distance;
      to.value.of[lane] = corner.value;
      to.point.of[lane] = corner.point;
      area_[n].of[lane] = crossing.area[n];
    }
    const RayFrame::Parts parts = task.frame.parts();
    for (int n = 0; n < 3; ++n) {
      axis_[n].of[lane] = parts.axis[n];
      origin_[n].of[lane] = parts.origin[n];
    }
    slope_u_.of[lane] = parts.slope_u;
    slope_v_.of[lane] = parts.slope_v;
    per_w_.of[lane] = parts.per_w;
    limit_.of[lane] = task.limits.distance;
    least_through_.of[lane] = task.limits.through;
    distance_.of[lane] = entry.distance;
    value_.of[lane] = crossing.value();
    standing_.of[lane] = 0;
    cell_.of[lane] = entry.face >> 2;
    fourth_.of[lane] = scene_.mesh.vertex(entry.face >> 2, entry.face & 3);
    live_.of[lane] = 1;
    ++busy_;
    return true;
  }

  HWY_INLINE CornerV cornerOf(L point) const {
    const auto* const points = &scene_.mesh.points->x;
    const L base = point + point + point;
    const auto along = [&](int n)
                           HWY_ATTR { return hn::GatherIndex(kD, points, base + axis_[n]()) - origin_[n](); };
    const D u = along(0), v = along(1), w = along(2);
    return {u - slope_u_() * w, v - slope_v_() * w, w * per_w_(), gather(scene_.mesh.values, point), point};
  }

  /// Passes a cell. @return the lanes whose march has ended
  HWY_INLINE M step() {
    const D zero = hn::Zero(kD);
    const M live = hn::Gt(live_(), zero);
    // leave()
    const CornerV c0 = loaded(corner_[0]), c1 = loaded(corner_[1]), c2 = loaded(corner_[2]);
    const CornerV fourth = cornerOf(fourth_());
    const D e0 = spanned(fourth, c0), e1 = spanned(fourth, c1), e2 = spanned(fourth, c2);
    const D inside0 = hn::Min(e1, hn::Neg(e2)), area0 = e1 - e2 + area_[0]();
    const D inside1 = hn::Min(e2, hn::Neg(e0)), area1 = e2 - e0 + area_[1]();
    const D inside2 = hn::Min(e0, hn::Neg(e1)), area2 = e0 - e1 + area_[2]();
    const auto better = [](D inside, D best, D area, D best_area) HWY_ATTR {
      return hn::Or(hn::Gt(inside, best), hn::And(hn::Eq(inside, best), hn::Gt(area, best_area)));
    };
    const M is1 = better(inside1, inside0, area1, area0);
    const D best = hn::IfThenElse(is1, inside1, inside0), best_area = hn::IfThenElse(is1, area1, area0);
    const M is2 = better(inside2, best, area2, best_area);
    const CornerV first = chosen(is2, c0, chosen(is1, c2, c1));
    const CornerV second = chosen(is2, c1, chosen(is1, c0, c2));
    const L behind = chosen(is2, c2.point, chosen(is1, c1.point, c0.point));
    const D of_first = chosen(is2, e0, chosen(is1, e2, e1));
    const D of_second = chosen(is2, e1, chosen(is1, e0, e2));
    const D opposite = chosen(is2, area_[2](), chosen(is1, area_[1](), area_[0]()));
    const D area[3] = {hn::Max(zero, hn::Neg(of_second)), hn::Max(zero, of_first), opposite};
    const D sum = area[0] + area[1] + area[2];
    const M is_face = hn::Gt(sum, zero);
    // The next cell is looked for before the integral, which takes long.
    const L cell = cell_();
    const L four = hn::ShiftLeft<2>(cell);
    const auto vertex = [&](int n) HWY_ATTR { return gather(scene_.mesh.vertices + n, four); };
    const L local = chosen(isSame(vertex(0), behind), hn::Zero(kL),
                           chosen(isSame(vertex(1), behind), hn::Set(kL, 1),
                                  chosen(isSame(vertex(2), behind), hn::Set(kL, 2), hn::Set(kL, 3))));
    const L other = gather(scene_.mesh.other_side, four + local);
    const M outside = hn::RebindMask(kD, hn::Lt(other, hn::Zero(kL)));
    const L entered = chosen(outside, hn::Zero(kL), other);
    cell_ = hn::ShiftRight<2>(entered);
    fourth_ = gather(scene_.mesh.vertices, entered);
    store(first, corner_[0]);
    store(second, corner_[1]);
    store(fourth, corner_[2]);
    for (int n = 0; n < 3; ++n) area_[n] = area[n];

    const D distance = distance_(), value = value_();
    const D next =
        hn::Max(mean(area, sum, is_face, first.distance, second.distance, fourth.distance), distance);
    const D next_value = mean(area, sum, is_face, first.value, second.value, fourth.value);
    const D standing = hn::IfThenElse(hn::Gt(next, distance), zero, standing_() + hn::Set(kD, 1.0));
    standing_ = standing;
    const D begin = hn::Max(hn::Max(distance, been_()), zero), end = hn::Min(next, limit_());
    const M counts = hn::And(hn::And(live, hn::Gt(end, begin)),
                             hn::And(hn::Eq(value, value), hn::Eq(next_value, next_value)));
    if (!hn::AllFalse(kD, counts)) {
      D front = value, back = next_value;
      const M late = hn::Gt(begin, distance), early = hn::Lt(end, next);
      if (HWY_UNLIKELY(!hn::AllFalse(kD, hn::And(counts, hn::Or(late, early))))) {
        const D slope = (next_value - value) / (next - distance);
        front = hn::IfThenElse(late, value + slope * (begin - distance), value);
        back = hn::IfThenElse(early, value + slope * (end - distance), next_value);
      }
      integral_.add(counts, front, back, end - begin);
    }
    distance_ = next;
    value_ = next_value;
    const M ended = hn::Or(hn::Or(outside, hn::Ge(next, limit_())),
                           hn::Or(hn::Lt(integral_.through(), least_through_()),
                                  hn::Ge(standing, hn::Set(kD, static_cast<double>(kMaxStanding)))));
    return hn::And(live, ended);
  }

  const PacketScene& scene_;
  MarchTask* next_;
  MarchTask* end_;
  int busy_ = 0;
  MarchTask* task_[kLanes] = {};
  std::size_t entry_[kLanes] = {};
  IntegralLanes integral_;
  Wholes axis_[3];
  Reals origin_[3], slope_u_, slope_v_, per_w_;
  Reals limit_, least_through_, live_;
  LaneCorner corner_[3];
  Reals area_[3];
  Wholes cell_, fourth_;
  Reals been_, distance_, value_, standing_;
};

long long marchLanes(const PacketScene& scene, MarchTask* tasks, int count) {
  return MarchLanes(scene, tasks, count).march();
}
#else
long long marchLanes(const PacketScene& scene, MarchTask* tasks, int count) {
  return marchInTurn(scene.mesh, scene.transfer, scene.psi, tasks, count);
}
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace emscape::render {

HWY_EXPORT(marchLanes);

CellPackets::CellPackets(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi)
    : mesh_(mesh), transfer_(transfer), psi_(psi) {
  for (const TransferInterval* from = transfer.intervals; from < transfer.intervals + transfer.count;
       ++from) {
    Interval to{};
    to.lower = from->lower;
    to.upper = from->upper;
    to.base = from->uniform ? 0 : from->lower;
    to.per_unit = from->uniform ? 0 : 1 / (from->upper - from->lower);
    to.extinction = from->extinction[0];
    to.extinction_rise = from->extinction[1] - from->extinction[0];
    const Rgb &low = from->color[0], &high = from->color[1];
    const float lows[] = {low.r, low.g, low.b}, highs[] = {high.r, high.g, high.b};
    for (int n = 0; n < 3; ++n) {
      to.color[n] = static_cast<double>(lows[n]);
      to.color_rise[n] = static_cast<double>(highs[n]) - static_cast<double>(lows[n]);
    }
    to.clear = from->clear ? 1 : 0;
    intervals_.push_back(to);
  }
}

long long CellPackets::march(MarchTask* tasks, int count) const {
  const PacketScene scene{mesh_, transfer_, psi_, intervals_.data()};
  return HWY_DYNAMIC_DISPATCH(marchLanes)(scene, tasks, count);
}

}  // namespace emscape::render
#endif
