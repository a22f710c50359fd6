#include "render/cells/cell_packets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cells/cell_packets.cpp"
#include <hwy/foreach_target.h>  // compiles the rest once for each kind of vector register
#include <hwy/highway.h>
//
#include "render/cells/integral/integral_lanes-inl.h"

#ifndef EMSCAPE_RENDER_CELLS_CELL_PACKETS_ONCE
#define EMSCAPE_RENDER_CELLS_CELL_PACKETS_ONCE
namespace emscape::render {
namespace {

/// Data shared by all rays of a picture.
struct PacketScene {
  CellMeshView mesh;
  LaneTransferView transfer;
};

}  // namespace
}  // namespace emscape::render
#endif

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {
namespace {

#if HWY_CAP_GE256

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

/// Rays in progress, one per lane; see march().
class MarchLanes {
 public:
  MarchLanes(const PacketScene& scene, MarchTask* tasks, int count)
      : scene_(scene), next_(tasks), end_(tasks + count), integral_(scene.transfer) {
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
  /// Continues a lane with its ray's next entry, or with another ray; if there is none, the lane is idle.
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

  /// @return false if the ray has no further valid entry
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

  /// Crosses a cell. @return the lanes whose march has ended
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
    // The next cell is found before the integral, which takes long.
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
  return marchInTurn(scene.mesh, scene.transfer.intervals, scene.transfer.psi, tasks, count);
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
    : mesh_(mesh), transfer_(transfer, psi) {}

long long CellPackets::march(MarchTask* tasks, int count) const {
  const PacketScene scene{mesh_, transfer_.view()};
  return HWY_DYNAMIC_DISPATCH(marchLanes)(scene, tasks, count);
}

}  // namespace emscape::render
#endif
