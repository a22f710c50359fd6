/// The ray integral in the lanes of vector registers; see ray_integral.h. Included once for each kind of
/// vector register.
#if defined(EMSCAPE_RENDER_CELLS_INTEGRAL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EMSCAPE_RENDER_CELLS_INTEGRAL_LANES_INL_H_
#undef EMSCAPE_RENDER_CELLS_INTEGRAL_LANES_INL_H_
#else
#define EMSCAPE_RENDER_CELLS_INTEGRAL_LANES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "render/cells/integral/lane_transfer.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {
namespace {  // rounding depends on each source's compilation

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

/// One number per lane, in memory.
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

/// RayIntegral, one ray per lane.
class IntegralLanes {
 public:
  explicit IntegralLanes(const LaneTransferView& transfer) : transfer_(transfer) {}

  void reset(int lane) {
    red_.of[lane] = green_.of[lane] = blue_.of[lane] = 0;
    through_.of[lane] = 1;
    interval_.of[lane] = transfer_.intervals.count - 1;
  }
  Rgba color(int lane) const {
    return {static_cast<float>(red_.of[lane]), static_cast<float>(green_.of[lane]),
            static_cast<float>(blue_.of[lane]), static_cast<float>(1 - through_.of[lane])};
  }
  HWY_INLINE D through() const { return through_(); }
  double through(int lane) const { return through_.of[lane]; }

  /// See RayIntegral::add(). @param on  lanes that have a segment
  HWY_INLINE void add(M on, D front, D back, D length) {
    if (hn::AllFalse(kD, on)) return;
    // Usually all are in one interval.
    const std::int64_t first = interval_.of[hn::FindKnownFirstTrue(kD, on)];
    const OneInterval one_interval{transfer_.lanes[first]};
    const M inside = hn::And(hn::Ge(hn::Min(front, back), one_interval(&LaneInterval::lower)),
                             hn::Le(hn::Max(front, back), one_interval(&LaneInterval::upper)));
    if (HWY_LIKELY(hn::AllFalse(kD, hn::AndNot(inside, on)))) {
      interval_ = chosen(on, hn::Set(kL, first), interval_());
      addPiece(on, one_interval, front, back, length);
      return;
    }
    const L one = hn::Set(kL, 1);
    L interval = interval_();
    const M rises = hn::Gt(back, front);
    const M falls = hn::Lt(back, front);
    D lower = field(interval, &LaneInterval::lower);
    D upper = field(interval, &LaneInterval::upper);
    for (;;) {  // at a control point the interval towards the back is used
      const M up = hn::And(on, chosen(rises, hn::Le(upper, front), hn::Lt(upper, front)));
      const M down = hn::And(on, chosen(falls, hn::Ge(lower, front), hn::Gt(lower, front)));
      if (HWY_LIKELY(hn::AllFalse(kD, hn::Or(up, down)))) break;
      interval = chosen(up, interval + one, chosen(down, interval - one, interval));
      lower = field(interval, &LaneInterval::lower);
      upper = field(interval, &LaneInterval::upper);
    }
    const D per_value = length / (back - front);  // not used where they are equal
    D value = front, left = length;
    for (;;) {
      const M ends = chosen(rises, hn::Le(back, upper), hn::Ge(back, lower));
      const D end = hn::IfThenElse(ends, back, hn::IfThenElse(rises, upper, lower));
      const M whole = hn::And(ends, hn::Eq(value, front));
      left = hn::IfThenElse(whole, length, (end - value) * per_value);
      addPiece(on, Intervals{transfer_.lanes, interval}, value, end, left);
      const M further = hn::AndNot(ends, on);
      if (HWY_LIKELY(hn::AllFalse(kD, further))) break;
      on = further;
      value = hn::IfThenElse(further, end, value);
      interval = chosen(further, chosen(rises, interval + one, interval - one), interval);
      lower = field(interval, &LaneInterval::lower);
      upper = field(interval, &LaneInterval::upper);
    }
    interval_ = interval;
  }

 private:
  /// The numbers of an interval of each lane.
  struct Intervals {
    const LaneInterval* lanes;
    L interval;

    HWY_INLINE D operator()(double LaneInterval::*member) const {
      static_assert(sizeof(LaneInterval) == 16 * sizeof(double));
      return hn::GatherIndex(kD, &(lanes->*member), hn::ShiftLeft<4>(interval));
    }
    HWY_INLINE D operator()(double (LaneInterval::*member)[3], int n) const {
      return hn::GatherIndex(kD, &(lanes->*member)[n], hn::ShiftLeft<4>(interval));
    }
  };
  /// The same if all lanes have one interval.
  struct OneInterval {
    const LaneInterval& interval;

    HWY_INLINE D operator()(double LaneInterval::*member) const { return hn::Set(kD, interval.*member); }
    HWY_INLINE D operator()(double (LaneInterval::*member)[3], int n) const {
      return hn::Set(kD, (interval.*member)[n]);
    }
  };
  HWY_INLINE D field(L interval, double LaneInterval::*member) const {
    return Intervals{transfer_.lanes, interval}(member);
  }

  template <class Fields>
  HWY_INLINE void addPiece(M on, const Fields& field, D front, D back, D length) {
    const D zero = hn::Zero(kD), one = hn::Set(kD, 1.0), half = hn::Set(kD, 0.5);
    on = hn::And(on, hn::Gt(length, zero));
    on = hn::And(on, hn::Eq(field(&LaneInterval::clear), zero));
    if (hn::AllFalse(kD, on)) return;
    const D base = field(&LaneInterval::base);
    const D per_unit = field(&LaneInterval::per_unit);
    const D low = field(&LaneInterval::extinction);
    const D rise = field(&LaneInterval::extinction_rise);
    // Zero in the other lanes: their values may be undefined.
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
      return hn::MulAdd(weight, field(&LaneInterval::color, n),
                        hn::MulAdd(weight_rise, field(&LaneInterval::color_rise, n), sum));
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
    const D low = mixed(transfer_.psi.values), high = mixed(transfer_.psi.values + kEntries);
    return hn::MulAdd(high, v, low * (one - v));
  }

  const LaneTransferView& transfer_;
  Reals red_, green_, blue_, through_;
  Wholes interval_;
};
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#endif  // include guard
