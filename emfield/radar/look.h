/// Direction of a radar's beam towards a target, and the antenna's amplitude in another direction.
#pragma once

#include <cmath>

#include "base/math/fast_math.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/antenna/antenna.h"
#include "scenario/antenna/pattern.h"

namespace emscape::emfield {

/// Method by which a beam follows a target. Directions are (forward, right, up): for `turned` and `steered`
/// in the frame of the antenna's mount, for `held` in the frame of the beam.
enum class LookKind {
  held,    ///< it does not follow
  turned,  ///< the antenna turns to the target: azimuth about the mount's up axis, then elevation
  steered  ///< the array is steered to the target; the antenna does not turn
};

/// Directions that a turned beam may have: a run of azimuths of the look's frame, and elevations.
struct LookArc {
  float cos_middle = 1, sin_middle = 0;     ///< the azimuth of its middle
  float cos_azimuth = -1, sin_azimuth = 0;  ///< half its width; cosine -1: full circle
  /// Sines and cosines of the lowest and of the highest elevation.
  float sin_lowest = -1, cos_lowest = 0;
  float sin_highest = 1, cos_highest = 0;
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

/// A look as plain data; for LookKind::turned and steered, if there are arcs, each look is at the nearest
/// direction of any arc, whatever the limits of `plain`.
struct ArcLook {
  RadarLook plain;
  const LookArc* arcs = nullptr;
  int arc_count = 0;
};

/// Directions with more passes of a beam than others: azimuths of the look's frame, and elevations.
struct CountedArc {
  float cos_middle = 1, sin_middle = 0;    ///< the azimuth of its middle
  float cos_half = -2;                     ///< of half its width; below -1: all azimuths
  float sin_lowest = -2, sin_highest = 2;  ///< of the elevations; beyond -1..1: without limit
  float passes = 0;                        ///< number of additional passes
};

/// Number of passes of a beam over a direction in an interval, as plain data.
struct LookCount {
  float everywhere = 1;  ///< number of passes
  const CountedArc* arcs = nullptr;
  int arc_count = 0;
  /// Outside all arcs, where the beam is that of the nearest arc. 0: its passes there are counted otherwise.
  float least = 1;

  /// At least LookCount::least.
  EMSCAPE_HD float towards(const Vec3f& direction) const {
    const float level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    const float length = std::sqrt(dot(direction, direction) + 1e-12f);
    float times = everywhere;
    for (int n = 0; n < arc_count; ++n) {
      const CountedArc& arc = arcs[n];
      const float along = direction.x * arc.cos_middle + direction.y * arc.sin_middle;
      const bool is_inside = (along >= arc.cos_half * level) & (direction.z >= arc.sin_lowest * length) &
                             (direction.z < arc.sin_highest * length);
      times += is_inside ? arc.passes : 0.0f;
    }
    return times < least ? least : times;
  }
};

/// The pass of a beam over a run of azimuths of the look's frame.
struct PassedArc {
  float middle_rad = 0, half_width_rad = 0;
  float age_s = 0;      ///< time from the pass of its middle to the interval's end
  float age_s_rad = 0;  ///< increase of that time with azimuth
};

/// Time of the last pass of a beam over each azimuth of the look's frame in an interval, as plain data.
struct LastPasses {
  static constexpr float kNever_s = 1e30f;
  const PassedArc* arcs = nullptr;
  int arc_count = 0;

  /// Time (s) from the last pass of a direction to the interval's end; kNever_s: none.
  EMSCAPE_HD float ageTowards(const Vec3f& direction) const {
    constexpr float kTurn_rad = 6.28318531f, kRounding_rad = 1e-6f;
    const float azimuth_rad = fastAtan2(direction.y, direction.x);
    float age = kNever_s;
    for (int n = 0; n < arc_count; ++n) {
      const PassedArc& arc = arcs[n];
      const float off_rad = azimuth_rad - arc.middle_rad;
      const float nearest_rad = off_rad - kTurn_rad * std::floor(off_rad / kTurn_rad + 0.5f);
      const float of_arc = arc.age_s + nearest_rad * arc.age_s_rad;
      age = std::abs(nearest_rad) <= arc.half_width_rad + kRounding_rad && of_arc < age ? of_arc : age;
    }
    return age < 0 ? 0.0f : age;
  }
};

/// The attitude of an antenna that points at a target.
struct Aim {
  float cos_azimuth = 1, sin_azimuth = 0, cos_elevation = 1, sin_elevation = 0;
  float steer_u = 0, steer_v = 0;
};

/// Azimuth and elevation of a direction.
struct AimAngles {
  float cos_azimuth, sin_azimuth, cos_elevation, sin_elevation;
};

/// The nearest angles within limits.
/// @param limits  RadarLook, or LookArc with angles relative to its middle
template <class Limits>
EMSCAPE_HD inline AimAngles nearestWithin(const Limits& limits, const AimAngles& target) {
  const bool is_beside = target.cos_azimuth < limits.cos_azimuth;
  const bool is_below = target.sin_elevation < limits.sin_lowest;
  const bool is_above = target.sin_elevation > limits.sin_highest;
  const float not_above_cos = is_above ? limits.cos_highest : target.cos_elevation;
  const float not_above_sin = is_above ? limits.sin_highest : target.sin_elevation;
  AimAngles nearest;
  nearest.cos_azimuth = is_beside ? limits.cos_azimuth : target.cos_azimuth;
  nearest.sin_azimuth =
      is_beside ? std::copysign(limits.sin_azimuth, target.sin_azimuth) : target.sin_azimuth;
  nearest.cos_elevation = is_below ? limits.cos_lowest : not_above_cos;
  nearest.sin_elevation = is_below ? limits.sin_lowest : not_above_sin;
  return nearest;
}

/// The nearest angles of any arc.
EMSCAPE_HD inline AimAngles nearestOf(const LookArc* arcs, int arc_count, const AimAngles& target) {
  AimAngles nearest = target;
  float nearest2 = 5;  // above any distance^2 of unit vectors
  for (int n = 0; n < arc_count; ++n) {
    const LookArc& arc = arcs[n];
    AimAngles turned = target;
    turned.cos_azimuth = target.cos_azimuth * arc.cos_middle + target.sin_azimuth * arc.sin_middle;
    turned.sin_azimuth = target.sin_azimuth * arc.cos_middle - target.cos_azimuth * arc.sin_middle;
    const AimAngles within = nearestWithin(arc, turned);
    const float x = within.cos_azimuth * within.cos_elevation - turned.cos_azimuth * turned.cos_elevation;
    const float y = within.sin_azimuth * within.cos_elevation - turned.sin_azimuth * turned.cos_elevation;
    const float z = within.sin_elevation - turned.sin_elevation;
    const float distance2 = x * x + y * y + z * z;
    if (distance2 >= nearest2) continue;
    nearest2 = distance2;
    nearest.cos_azimuth = within.cos_azimuth * arc.cos_middle - within.sin_azimuth * arc.sin_middle;
    nearest.sin_azimuth = within.sin_azimuth * arc.cos_middle + within.cos_azimuth * arc.sin_middle;
    nearest.cos_elevation = within.cos_elevation;
    nearest.sin_elevation = within.sin_elevation;
  }
  return nearest;
}

/// Azimuth and elevation of a direction.
/// @param direction  of any length; for 0 the azimuth is forward, and sine and cosine of the elevation are 0
EMSCAPE_HD inline AimAngles anglesOf(const Vec3f& direction) {
  const float level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const float inverse_length = 1 / std::sqrt(dot(direction, direction) + 1e-12f);
  return {level > 0 ? direction.x / level : 1.0f, level > 0 ? direction.y / level : 0.0f,
          level * inverse_length, direction.z * inverse_length};
}

/// The aim at a target, or the nearest aim that the look permits. Without branches, for SIMD.
/// @param target  direction in the look's frame, of any length; 0: as for anglesOf() and the look's limits
EMSCAPE_HD inline Aim aimAt(const RadarLook& look, const Vec3f& target) {
  const bool turns = look.kind == LookKind::turned, steers = look.kind == LookKind::steered;
  const float inverse_length = 1 / std::sqrt(dot(target, target) + 1e-12f);
  const AimAngles nearest = nearestWithin(look, anglesOf(target));
  Aim aim;
  aim.cos_azimuth = turns ? nearest.cos_azimuth : 1.0f;
  aim.sin_azimuth = turns ? nearest.sin_azimuth : 0.0f;
  aim.cos_elevation = turns ? nearest.cos_elevation : 1.0f;
  aim.sin_elevation = turns ? nearest.sin_elevation : 0.0f;
  aim.steer_u = steers ? target.y * inverse_length : look.steer_u;
  aim.steer_v = steers ? target.z * inverse_length : look.steer_v;
  return aim;
}

/// The same for a look that may have arcs.
EMSCAPE_HD inline Aim aimAt(const ArcLook& look, const Vec3f& target) {
  Aim aim = aimAt(look.plain, target);
  if (look.arc_count == 0 || look.plain.kind == LookKind::held) return aim;
  const AimAngles nearest = nearestOf(look.arcs, look.arc_count, anglesOf(target));
  if (look.plain.kind == LookKind::steered) {
    aim.steer_u = nearest.sin_azimuth * nearest.cos_elevation;
    aim.steer_v = nearest.sin_elevation;
    return aim;
  }
  aim.cos_azimuth = nearest.cos_azimuth;
  aim.sin_azimuth = nearest.sin_azimuth;
  aim.cos_elevation = nearest.cos_elevation;
  aim.sin_elevation = nearest.sin_elevation;
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
