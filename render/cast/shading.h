/// Shading of surfaces and fog: the gradient of a volume as a normal, and Blinn-Phong reflection. Single
/// source for host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "render/cast/rgba.h"
#include "render/cast/volume_view.h"

namespace emscape::render {

/// One directional light and the shape of voxels. *Drawn* directions are those of the displayed scene: voxels
/// have their spacing, and heights are stretched.
struct ShadingView {
  // A white light near the viewer. Surfaces that face it are slightly brighter than without, others darker.
  static constexpr float kAmbient = 0.45F;
  static constexpr float kDiffuse = 0.75F;
  static constexpr float kSpecular = 0.3F;
  static constexpr float kShininess = 32;
  /// Gradient (parts of the transfer function's interval per voxel) at which fog is shaded by half.
  static constexpr float kFaintGradient = 0.02F;

  bool shades_fog = false;  ///< samples of DVR and MIDA are shaded; isosurfaces always are
  Vec3f voxel{1, 1, 1};     ///< edges of a voxel as drawn; their scale does not matter
  Vec3f to_light{0, 0, 1};  ///< drawn direction, of unit length

  /// Drawn unit vector to the viewer. @param direction  of the ray, in index space
  EMSCAPE_HD Vec3f toViewer(const Vec3f& direction) const {
    return normalized(Vec3f{-direction.x * voxel.x, -direction.y * voxel.y, -direction.z * voxel.z});
  }
  /// Drawn unit normal of a surface of constant value. @param gradient  in index space; isSlope()
  EMSCAPE_HD Vec3f normal(const Vec3f& gradient) const {
    return normalized(Vec3f{gradient.x / voxel.x, gradient.y / voxel.y, gradient.z / voxel.z});
  }

  /// True if a gradient has a direction: it is neither zero nor infinite.
  EMSCAPE_HD static bool isSlope(const Vec3f& gradient) {
    const float squared = dot(gradient, gradient);
    return squared > 0.0F && squared - squared == 0.0F;
  }

  /// A premultiplied colour with shading; its opacity is unchanged. Both sides of a surface are equal.
  EMSCAPE_HD Rgba lit(const Rgba& color, const Vec3f& surface_normal, const Vec3f& to_viewer) const {
    const Vec3f n = dot(surface_normal, to_viewer) < 0.0F ? -surface_normal : surface_normal;
    const float toward = dot(n, to_light);
    const float diffuse = kAmbient + kDiffuse * (toward > 0.0F ? toward : 0.0F);
    const float half = dot(n, normalized(to_light + to_viewer));
    const float specular = half > 0.0F ? kSpecular * std::pow(half, kShininess) * color.a : 0.0F;
    return {held(color.r * diffuse + specular, color.a), held(color.g * diffuse + specular, color.a),
            held(color.b * diffuse + specular, color.a), color.a};
  }

  /// A sample of fog with shading: where the value hardly changes there is no surface, and the colour is
  /// unchanged.
  /// @param gradient  of f, per voxel, in index space
  EMSCAPE_HD Rgba litFog(const Rgba& sample, const Vec3f& gradient, const Vec3f& to_viewer) const {
    if (!isSlope(gradient)) return sample;
    const float squared = dot(gradient, gradient);
    const float strength = squared / (squared + kFaintGradient * kFaintGradient);
    const Rgba shaded = lit(sample, normal(gradient), to_viewer);
    return {lerp(sample.r, shaded.r, strength), lerp(sample.g, shaded.g, strength),
            lerp(sample.b, shaded.b, strength), sample.a};
  }

 private:
  EMSCAPE_HD static float held(float value, float most) { return value < most ? value : most; }
};

/// Difference of values along one axis, per voxel: central, one voxel to either side; shorter at the border
/// of the volume; one-sided if a neighbour is masked or NaN; 0 if both are.
/// @param axis   unit vector; position and voxels are the position's component along it and the voxels there
/// @param value  at the centre
template <class Sampler>
EMSCAPE_HD float differenceAlong(const VolumeView& volume, const Vec3f& center, const Vec3f& axis,
                                 float position, int voxels, float value) {
  const float last = static_cast<float>(voxels - 1);
  const float held = position > 0.0F ? (position < last ? position : last) : 0.0F;
  float before = held > 1.0F ? 1.0F : held;
  float after = last - held > 1.0F ? 1.0F : last - held;
  const Vec3f middle = center + axis * (held - position);
  float low = 0, high = 0;
  if (!Sampler::sample(volume, middle - axis * before, low)) {
    low = value;
    before = 0;
  }
  if (!Sampler::sample(volume, middle + axis * after, high)) {
    high = value;
    after = 0;
  }
  const float apart = before + after;
  return apart > 0.0F ? (high - low) / apart : 0.0F;
}

/// Gradient of the sampled field in index space, per voxel. @param value  the sample at the position
template <class Sampler>
EMSCAPE_HD Vec3f gradientAt(const VolumeView& volume, const Vec3f& position, float value) {
  return {differenceAlong<Sampler>(volume, position, {1, 0, 0}, position.x, volume.dims.x, value),
          differenceAlong<Sampler>(volume, position, {0, 1, 0}, position.y, volume.dims.y, value),
          differenceAlong<Sampler>(volume, position, {0, 0, 1}, position.z, volume.dims.z, value)};
}

}  // namespace emscape::render
