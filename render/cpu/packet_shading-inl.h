/// Shading of packets of rays, lane by lane; see render/cast/shading.h. Included once for each instruction
/// set by packets.cpp.
#if defined(EMSCAPE_RENDER_CPU_PACKET_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef EMSCAPE_RENDER_CPU_PACKET_SHADING_INL_H_
#undef EMSCAPE_RENDER_CPU_PACKET_SHADING_INL_H_
#else
#define EMSCAPE_RENDER_CPU_PACKET_SHADING_INL_H_
#endif

#include "render/cast/shading.h"
#include "render/cpu/packet_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace emscape::render {
namespace HWY_NAMESPACE {

/// See differenceAlong(). @param center  with its component along the axis clamped to the outer voxels'
/// centres
/// @param component  that component, which is changed and restored
HWY_INLINE F differenceAlong(const VolumeView& volume, Vec3F center, F Vec3F::*component, int voxels, F value,
                             M lanes) {
  const F last = hn::Set(kF, static_cast<float>(voxels - 1));
  const F one = hn::Set(kF, 1.0F);
  const F held = hn::Min(hn::Max(center.*component, hn::Zero(kF)), last);
  F before = hn::Min(held, one);
  F after = hn::Min(last - held, one);
  M has_low = lanes;
  M has_high = lanes;
  center.*component = held - before;
  const F low = sampleVolume<ValueReader>(volume, center, has_low);
  center.*component = held + after;
  const F high = sampleVolume<ValueReader>(volume, center, has_high);
  before = hn::IfThenElseZero(has_low, before);
  after = hn::IfThenElseZero(has_high, after);
  const F apart = before + after;
  const F difference = hn::IfThenElse(has_high, high, value) - hn::IfThenElse(has_low, low, value);
  return hn::IfThenElseZero(hn::Gt(apart, hn::Zero(kF)), difference / apart);
}

/// See gradientAt().
HWY_INLINE Vec3F gradientAt(const VolumeView& volume, const Vec3F& position, F value, M lanes) {
  return {differenceAlong(volume, position, &Vec3F::x, volume.dims.x, value, lanes),
          differenceAlong(volume, position, &Vec3F::y, volume.dims.y, value, lanes),
          differenceAlong(volume, position, &Vec3F::z, volume.dims.z, value, lanes)};
}

/// See ShadingView, whose functions these are.
class Light {
 public:
  HWY_INLINE Light(const ShadingView& shading, const Vec3F& direction)
      : voxel_{hn::Set(kF, shading.voxel.x), hn::Set(kF, shading.voxel.y), hn::Set(kF, shading.voxel.z)},
        to_light_{hn::Set(kF, shading.to_light.x), hn::Set(kF, shading.to_light.y),
                  hn::Set(kF, shading.to_light.z)},
        to_viewer_(unit({hn::Neg(direction.x) * voxel_.x, hn::Neg(direction.y) * voxel_.y,
                         hn::Neg(direction.z) * voxel_.z})),
        half_(unit({to_light_.x + to_viewer_.x, to_light_.y + to_viewer_.y, to_light_.z + to_viewer_.z})) {}

  HWY_INLINE Vec3F normal(const Vec3F& gradient) const {
    return unit({gradient.x / voxel_.x, gradient.y / voxel_.y, gradient.z / voxel_.z});
  }

  HWY_INLINE Color lit(const Color& color, const Vec3F& surface_normal) const {
    const F facing = hn::CopySignToAbs(hn::Set(kF, 1.0F), dot(surface_normal, to_viewer_));
    const F toward = hn::Max(dot(surface_normal, to_light_) * facing, hn::Zero(kF));
    const F diffuse =
        hn::MulAdd(hn::Set(kF, ShadingView::kDiffuse), toward, hn::Set(kF, ShadingView::kAmbient));
    static_assert(ShadingView::kShininess == 32, "five squarings");
    F power = hn::Max(dot(surface_normal, half_) * facing, hn::Zero(kF));
    for (int i = 0; i < 5; ++i) power = power * power;
    const F specular = hn::Set(kF, ShadingView::kSpecular) * power * color.a;
    return {hn::Min(hn::MulAdd(color.r, diffuse, specular), color.a),
            hn::Min(hn::MulAdd(color.g, diffuse, specular), color.a),
            hn::Min(hn::MulAdd(color.b, diffuse, specular), color.a), color.a};
  }

  HWY_INLINE Color litFog(const Color& sample, const Vec3F& gradient) const {
    const F squared = dot(gradient, gradient);
    const M any = hn::Gt(squared, hn::Zero(kF));
    constexpr float kFaint = ShadingView::kFaintGradient * ShadingView::kFaintGradient;
    const F strength = hn::IfThenElseZero(any, squared / (squared + hn::Set(kF, kFaint)));
    const Vec3F up{hn::IfThenElse(any, gradient.x, hn::Set(kF, 1.0F)), gradient.y, gradient.z};
    const Color shaded = lit(sample, normal(up));
    return {lerp(sample.r, shaded.r, strength), lerp(sample.g, shaded.g, strength),
            lerp(sample.b, shaded.b, strength), sample.a};
  }

 private:
  static HWY_INLINE F dot(const Vec3F& a, const Vec3F& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
  }
  static HWY_INLINE Vec3F unit(const Vec3F& v) {
    const F scale = hn::Set(kF, 1.0F) / hn::Sqrt(dot(v, v));
    return {v.x * scale, v.y * scale, v.z * scale};
  }

  const Vec3F voxel_, to_light_, to_viewer_, half_;
};

}  // namespace HWY_NAMESPACE
}  // namespace emscape::render
HWY_AFTER_NAMESPACE();

#endif
