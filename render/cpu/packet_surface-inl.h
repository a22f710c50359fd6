/// The isosurface in packets of rays, lane by lane; see render/cast/isosurface.h. Included once for each
/// instruction set by packets.cpp.
#if defined(EMSCAPE_RENDER_CPU_PACKET_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EMSCAPE_RENDER_CPU_PACKET_SURFACE_INL_H_
#undef EMSCAPE_RENDER_CPU_PACKET_SURFACE_INL_H_
#else
#define EMSCAPE_RENDER_CPU_PACKET_SURFACE_INL_H_
#endif

#include "render/cpu/packet_sampling-inl.h"
#include "render/cpu/packet_shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {

/// Points of the rays with the field's value; see render::FieldPoint.
struct Points {
  F distance, value;
  M known;
};

/// Searches the first crossing of the isosurface on each ray of a packet.
class SurfaceSearch {
 public:
  HWY_INLINE SurfaceSearch(const RaycastTask& task, const Rays& rays)
      : task_(task),
        rays_(rays),
        iso_(hn::Set(kF, task.iso.value)),
        bricks_(task, rays.direction),
        segments_(rays, task.step_voxels) {}

  HWY_INLINE Color color() {
    const F zero = hn::Zero(kF);
    M active = hn::Gt(rays_.length, zero);
    M found = hn::FirstN(kF, 0);
    M cap = found;
    Points hit{zero, zero, found};
    Points last{zero, zero, found};
    F n = zero;
    F next_brick = zero;
    while (!hn::AllFalse(kF, active)) {
      // March until every lane has crossed the surface or left the box, then refine the crossings together.
      M crossed = hn::FirstN(kF, 0);
      Points near = last;
      Points far = last;
      while (!hn::AllFalse(kF, active)) {
        const Points point = pointsAt(segments_.joint(n), active);
        const M inside = hn::Ge(point.value, iso_);
        const M at_entry = hn::And(hn::And(hn::Eq(n, zero), rays_.enters), hn::And(point.known, inside));
        cap = hn::Or(cap, at_entry);
        hit = chosen(at_entry, point, hit);
        const M across = hn::And(hn::And(hn::And(active, hn::AndNot(at_entry, point.known)), last.known),
                                 hn::Xor(inside, hn::Ge(last.value, iso_)));
        near = chosen(across, last, near);
        far = chosen(across, point, far);
        crossed = hn::Or(crossed, across);
        last = chosen(active, point, last);
        n = hn::IfThenElse(active, next(n, point.distance, active, next_brick), n);
        active = hn::AndNot(hn::Or(across, at_entry), hn::And(active, hn::Le(n, segments_.count)));
      }
      if (hn::AllFalse(kF, crossed)) break;
      const M refined = refine(crossed, near, far, hit);
      found = hn::Or(found, refined);
      active = hn::And(hn::AndNot(refined, crossed), hn::Le(n, segments_.count));
    }
    return shaded(found, cap, hit);
  }

 private:
  HWY_INLINE Points pointsAt(F distance, M lanes) const {
    M known = lanes;
    const F value =
        sampleVolume<ValueReader>(task_.volume, rays_.start.along(rays_.direction, distance), known);
    return {distance, value, known};
  }

  static HWY_INLINE Points chosen(M mask, const Points& a, const Points& b) {
    return {hn::IfThenElse(mask, a.distance, b.distance), hn::IfThenElse(mask, a.value, b.value),
            hn::Or(hn::And(mask, a.known), hn::AndNot(mask, b.known))};
  }

  /// The joint to examine after n: the last one of a brick without the surface.
  HWY_INLINE F next(F n, F distance, M active, F& next_brick) const {
    const F one = hn::Set(kF, 1.0F);
    F ahead = one;
    const M look = hn::And(active, hn::Ge(n, next_brick));
    if (task_.skip.levels != nullptr && !hn::AllFalse(kF, look)) {
      I brick;
      const F leave = bricks_.look(rays_.start.along(rays_.direction, distance), brick);
      const F level = hn::GatherIndex(kF, task_.skip.levels, brick);
      const F inside = hn::Min(hn::Floor(leave * segments_.per_step), segments_.count);
      next_brick = hn::IfThenElse(look, n + inside + one, next_brick);
      const M skips =
          hn::And(look, hn::And(hn::Lt(level, hn::Set(kF, SkipView::kNever)), hn::Gt(inside, one)));
      ahead = hn::IfThenElse(skips, inside, one);
    }
    const F to = n + ahead;
    return hn::IfThenElse(hn::And(hn::Lt(n, segments_.count), hn::Gt(to, segments_.count)), segments_.count,
                          to);
  }

  /// See refineCrossing(). @return lanes whose crossing lies between known values
  HWY_INLINE M refine(M lanes, Points near, Points far, Points& hit) const {
    constexpr int kBisections = 8;
    const M near_inside = hn::Ge(near.value, iso_);
    for (int i = 0; i < kBisections; ++i) {
      const Points middle = pointsAt(hn::Set(kF, 0.5F) * (near.distance + far.distance), lanes);
      lanes = hn::And(lanes, middle.known);
      const M across = hn::Xor(hn::Ge(middle.value, iso_), near_inside);
      far = chosen(across, middle, far);
      near = chosen(across, near, middle);
    }
    const F part = (iso_ - near.value) / (far.value - near.value);
    hit = chosen(lanes, {lerp(near.distance, far.distance, part), iso_, lanes}, hit);
    return lanes;
  }

  HWY_INLINE Color shaded(M found, M cap, const Points& hit) const {
    const M shown = hn::Or(found, cap);
    if (hn::AllFalse(kF, shown)) return Color::zero();
    const IsoView& iso = task_.iso;
    const Color plain{hn::Set(kF, iso.r * iso.opacity), hn::Set(kF, iso.g * iso.opacity),
                      hn::Set(kF, iso.b * iso.opacity), hn::Set(kF, iso.opacity)};
    const Light light(task_.shading, rays_.direction);
    const Vec3F position = rays_.start.along(rays_.direction, hit.distance);
    const Vec3F gradient = gradientAt(task_.volume, position, hit.value, found);
    const F zero = hn::Zero(kF);
    const F one = hn::Set(kF, 1.0F);
    const M steep = hn::Gt(gradient.x * gradient.x + gradient.y * gradient.y + gradient.z * gradient.z, zero);
    const Vec3F surface = light.normal({hn::IfThenElse(steep, gradient.x, one), gradient.y, gradient.z});
    const Vec3F face = entryNormal();
    const Vec3F normal{hn::IfThenElse(cap, face.x, surface.x), hn::IfThenElse(cap, face.y, surface.y),
                       hn::IfThenElse(cap, face.z, surface.z)};
    const Color lit = light.lit(plain, normal);
    const M flat = hn::AndNot(cap, hn::Not(steep));
    return Color::chosen(flat, plain, lit).where(shown);
  }

  /// See render::entryNormal().
  HWY_INLINE Vec3F entryNormal() const {
    const auto lower = task_.volume.lower();
    const auto upper = task_.volume.upper();
    const F x = gap(rays_.start.x, rays_.direction.x, lower.x, upper.x);
    const F y = gap(rays_.start.y, rays_.direction.y, lower.y, upper.y);
    const F z = gap(rays_.start.z, rays_.direction.z, lower.z, upper.z);
    const M by_x = hn::And(hn::Le(x, y), hn::Le(x, z));
    const M by_y = hn::AndNot(by_x, hn::Le(y, z));
    const M by_z = hn::Not(hn::Or(by_x, by_y));
    return {hn::IfThenElseZero(by_x, against(rays_.direction.x)),
            hn::IfThenElseZero(by_y, against(rays_.direction.y)),
            hn::IfThenElseZero(by_z, against(rays_.direction.z))};
  }
  static HWY_INLINE F gap(F position, F along, double low, double high) {
    const F zero = hn::Zero(kF);
    const F to_low = hn::Abs(position - hn::Set(kF, static_cast<float>(low)));
    const F to_high = hn::Abs(hn::Set(kF, static_cast<float>(high)) - position);
    return hn::IfThenElse(hn::Gt(along, zero), to_low,
                          hn::IfThenElse(hn::Lt(along, zero), to_high, hn::Set(kF, 1e30F)));
  }
  static HWY_INLINE F against(F direction) {
    const F one = hn::Set(kF, 1.0F);
    return hn::IfThenElse(hn::Gt(direction, hn::Zero(kF)), hn::Neg(one), one);
  }

  const RaycastTask& task_;
  const Rays& rays_;
  const F iso_;
  const BrickWalk bricks_;
  const Segments segments_;
};

}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#endif
