/// The direct and the reflected ray of a voxel, weighted by the antenna's amplitude along each.
///
/// The excess of a model with a reflected ray is for isotropic antennas, L = q I + (1 - q) L0, where I = -20
/// log |1 + rho| is the interference with the reflected ray's relative amplitude rho, and L0 the loss at and
/// beyond the horizon. With the antennas' amplitudes d along the direct and r along the reflected ray, I
/// becomes -20 log |1 + rho r / d|, so that the power is multiplied by
///     d^2 (|d + r rho|^2 / (d^2 |1 + rho|^2))^q
/// instead of d^2. rho, q and the reflected ray's direction depend only on positions: the combine stage reads
/// them from a code per voxel, and a turning beam does not change them.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/propagation/reflected_ray.h"

namespace emscape::emfield {

using propagation::ReflectedRay;

/// A reflected ray in 16 bytes, for storage between updates. Amplitude and direction keep all digits: near a
/// null the power is a small difference of the two rays.
/// @accuracy weight within 3.1e-5
struct alignas(16) ReflectedRayCode {
  float re = 0, im = 0;
  float depression_sine = 0;
  std::uint16_t weight = 0;  ///< the highest bit: is_envelope
};

namespace two_rays_detail {
constexpr float kWeightSteps = 16384;
constexpr unsigned kEnvelopeBit = 0x8000;
}  // namespace two_rays_detail

EMSCAPE_HD inline ReflectedRayCode reflectedRayCode(const ReflectedRay& ray) {
  using namespace two_rays_detail;
  const float weight = ray.weight < 0 ? 0.0f : ray.weight > 1 ? 1.0f : ray.weight;
  const auto steps = static_cast<unsigned>(weight * kWeightSteps + 0.5f);
  ReflectedRayCode code;
  code.re = ray.re;
  code.im = ray.im;
  code.depression_sine = ray.depression_sine;
  code.weight = static_cast<std::uint16_t>(steps | (ray.is_envelope ? kEnvelopeBit : 0u));
  return code;
}

EMSCAPE_HD inline ReflectedRay reflectedRay(const ReflectedRayCode& code) {
  using namespace two_rays_detail;
  ReflectedRay ray;
  ray.re = code.re;
  ray.im = code.im;
  ray.depression_sine = code.depression_sine;
  ray.weight = static_cast<float>(code.weight & (kEnvelopeBit - 1)) * (1 / kWeightSteps);
  ray.is_envelope = (code.weight & kEnvelopeBit) != 0;
  return ray;
}

/// Start of a reflected ray: a unit vector in the vertical plane of the direct ray.
/// @param direct           east-north-up, of any length
/// @param depression_sine  of the reflected ray, 0..1
EMSCAPE_HD inline Vec3f reflectedDirection(const Vec3f& direct, float depression_sine) {
  const float level2 = direct.x * direct.x + direct.y * direct.y;
  const float cosine2 = 1 - depression_sine * depression_sine;
  const float scale = std::sqrt((cosine2 > 0 ? cosine2 : 0.0f) / (level2 + 1e-12f));
  return {direct.x * scale, direct.y * scale, -depression_sine};
}

/// Factor of the antennas on the power for isotropic antennas whose excess includes the reflected ray;
/// without a reflected ray, the square of `direct`. Without branches, for SIMD.
/// @param direct, reflected  amplitude of the pattern along each ray with the field's sign; with antennas at
/// both ends the product of the two
/// @return power ratio; in a null 60 dB below `direct` alone, as in the model
EMSCAPE_HD inline float powerOfBothRays(const ReflectedRay& ray, float direct, float reflected) {
  constexpr float kMinPower =
      static_cast<float>(propagation::kMinInterference * propagation::kMinInterference);
  constexpr float kMinNormal = fast_math_detail::kMinNormal;
  const float d = ray.is_envelope ? std::fabs(direct) : direct;
  const float r = ray.is_envelope ? std::fabs(reflected) : reflected;
  const float direct2 = d * d, re = d + r * ray.re, im = r * ray.im;
  const float sum = re * re + im * im, smallest = kMinPower * direct2;
  const float isotropic_re = 1 + ray.re;
  const float isotropic = isotropic_re * isotropic_re + ray.im * ray.im;
  const float in_sight = (sum > smallest ? sum : smallest) / (isotropic > kMinPower ? isotropic : kMinPower);
  const float ratio = in_sight / (direct2 > kMinNormal ? direct2 : kMinNormal);
  const float near_horizon = direct2 * fastExp2(ray.weight * fastLog2(ratio));
  return ray.weight < 1 ? near_horizon : in_sight;
}

}  // namespace emscape::emfield
