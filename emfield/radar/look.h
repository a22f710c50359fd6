/// Direction of a radar's beam towards a target, and the antenna's amplitude in another direction.
#pragma once

#include <cmath>

#include "base/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/antenna.h"
#include "scenario/antenna/pattern.h"

namespace emscape::emfield {

/// Method by which a beam follows a target. Directions are (forward, right, up): for `turned` and `steered`
/// in the frame of the antenna's mount, for `held` in the frame of the beam.
enum class LookKind {
  held,    ///< it does not follow
  turned,  ///< the antenna turns to the target: azimuth about the mount's up axis, then elevation
  steered  ///< the array is steered to the target; the antenna does not turn
};

/// A look as plain data.
struct RadarLook {
  LookKind kind = LookKind::held;
  /// turned: largest azimuth to either side of the mount's forward; cosine -1: full circle.
  float cos_azimuth = -1, sin_azimuth = 0;
  /// turned: sines and cosines of the lowest and of the highest elevation.
  float sin_lowest = -1, cos_lowest = 0;
  float sin_highest = 1, cos_highest = 0;
  /// held: the direction cosines to which a phased array is steered; turned: 0.
  float steer_u = 0, steer_v = 0;
};

/// Number of passes of a beam over a direction in an interval, as plain data.
struct LookCount {
  static constexpr int kMaxArcs = 4;
  float everywhere = 1;  ///< number of passes
  int arc_count = 0;     ///< azimuths with one more pass
  /// Of each arc: the azimuth of its middle in the look's frame, and the cosine of half its width.
  float cos_middle[kMaxArcs] = {}, sin_middle[kMaxArcs] = {}, cos_half[kMaxArcs] = {};

  /// At least 1: outside all arcs the beam is that of the nearest arc.
  EMSCAPE_HD float towards(const Vec3f& direction) const {
    const float level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    float times = everywhere;
    for (int n = 0; n < arc_count; ++n) {
      const float along = direction.x * cos_middle[n] + direction.y * sin_middle[n];
      times += along >= cos_half[n] * level ? 1.0f : 0.0f;
    }
    return times < 1 ? 1.0f : times;
  }
};

/// Time of the last pass of a beam over each azimuth of the look's frame in an interval, as plain data.
struct LastPasses {
  static constexpr int kMaxArcs = 8;
  static constexpr float kNever_s = 1e30f;
  int arc_count = 0;
  /// Of each arc: the azimuth of its middle and half its width (rad), the time (s) from the pass of its
  /// middle to the interval's end, and its increase with azimuth (s/rad).
  float middle_rad[kMaxArcs] = {}, half_width_rad[kMaxArcs] = {}, age_s[kMaxArcs] = {},
        age_s_rad[kMaxArcs] = {};

  /// Time (s) from the last pass of a direction to the interval's end; kNever_s: none.
  EMSCAPE_HD float ageTowards(const Vec3f& direction) const {
    constexpr float kTurn_rad = 6.28318531f, kRounding_rad = 1e-6f;
    const float azimuth_rad = fastAtan2(direction.y, direction.x);
    float age = kNever_s;
    for (int n = 0; n < arc_count; ++n) {
      const float off_rad = azimuth_rad - middle_rad[n];
      const float nearest_rad = off_rad - kTurn_rad * std::floor(off_rad / kTurn_rad + 0.5f);
      const float of_arc = age_s[n] + nearest_rad * age_s_rad[n];
      age = std::abs(nearest_rad) <= half_width_rad[n] + kRounding_rad && of_arc < age ? of_arc : age;
    }
    return age < 0 ? 0.0f : age;
  }
};

/// The attitude of an antenna that points at a target.
struct Aim {
  float cos_azimuth = 1, sin_azimuth = 0, cos_elevation = 1, sin_elevation = 0;
  float steer_u = 0, steer_v = 0;
};

/// The aim at a target, or the nearest aim that the look permits. Without branches, for SIMD.
/// @param target  direction in the look's frame, of any length; 0: the aim is forward
EMSCAPE_HD inline Aim aimAt(const RadarLook& look, const Vec3f& target) {
  const bool turns = look.kind == LookKind::turned, steers = look.kind == LookKind::steered;
  const float level = std::sqrt(target.x * target.x + target.y * target.y);
  const float inverse_length = 1 / std::sqrt(dot(target, target) + 1e-12f);
  const float cos_azimuth = level > 0 ? target.x / level : 1.0f;
  const float sin_azimuth = level > 0 ? target.y / level : 0.0f;
  const float sin_elevation = target.z * inverse_length, cos_elevation = level * inverse_length;
  const bool is_beside = cos_azimuth < look.cos_azimuth;
  const bool is_below = sin_elevation<look.sin_lowest, is_above = sin_elevation> look.sin_highest;
  const float nearest_cos_azimuth = is_beside ? look.cos_azimuth : cos_azimuth;
  const float nearest_sin_azimuth = is_beside ? std::copysign(look.sin_azimuth, sin_azimuth) : sin_azimuth;
  const float not_above_cos = is_above ? look.cos_highest : cos_elevation;
  const float not_above_sin = is_above ? look.sin_highest : sin_elevation;
  const float nearest_cos_elevation = is_below ? look.cos_lowest : not_above_cos;
  const float nearest_sin_elevation = is_below ? look.sin_lowest : not_above_sin;
  Aim aim;
  aim.cos_azimuth = turns ? nearest_cos_azimuth : 1.0f;
  aim.sin_azimuth = turns ? nearest_sin_azimuth : 0.0f;
  aim.cos_elevation = turns ? nearest_cos_elevation : 1.0f;
  aim.sin_elevation = turns ? nearest_sin_elevation : 0.0f;
  aim.steer_u = steers ? target.y * inverse_length : look.steer_u;
  aim.steer_v = steers ? sin_elevation : look.steer_v;
  return aim;
}

/// A direction of the look's frame in the frame of the aimed antenna.
EMSCAPE_HD inline Vec3f turnedBy(const Aim& aim, const Vec3f& direction) {
  const float ahead = direction.x * aim.cos_azimuth + direction.y * aim.sin_azimuth;
  return {ahead * aim.cos_elevation + direction.z * aim.sin_elevation,
          direction.y * aim.cos_azimuth - direction.x * aim.sin_azimuth,
          direction.z * aim.cos_elevation - ahead * aim.sin_elevation};
}

/// Amplitude (relative voltage, 0..1) of the aimed antenna.
/// @param direction  in the look's frame, a unit vector
/// @tparam kSigned   true: with the field's sign, -1..1
template <scenario::PatternKind kind, bool kSigned = false>
EMSCAPE_HD inline float amplitudeTowards(const scenario::PatternView& pattern, const Aim& aim,
                                         const Vec3f& direction) {
  return scenario::amplitudeOf<kind, kSigned>(pattern, turnedBy(aim, direction), aim.steer_u, aim.steer_v);
}

}  // namespace emscape::emfield
