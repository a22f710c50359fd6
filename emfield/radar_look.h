/// Where a radar's beam points when it looks at a target, and what its antenna then gives in a direction.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "base/vec.h"
#include "scenario/antenna.h"

namespace emscape::emfield {

/// How a beam follows a target. Directions are (forward, right, up) in a frame that `turned` and `steered`
/// take from the antenna's mount and `held` from the beam itself.
enum class LookKind {
  held,    ///< not at all
  turned,  ///< the antenna turns onto the target: azimuth about the mount's up, then elevation
  steered  ///< the array is steered onto it; the antenna stays
};

/// A look as plain data.
struct RadarLook {
  LookKind kind = LookKind::held;
  /// turned: how far, to either side of the mount's forward; cosine -1: all the way round.
  float cos_azimuth = -1, sin_azimuth = 0;
  /// turned: sines and cosines of the lowest and of the highest elevation.
  float sin_lowest = -1, cos_lowest = 0;
  float sin_highest = 1, cos_highest = 0;
  /// held: the direction cosines to which a phased array is steered.
  float steer_u = 0, steer_v = 0;
};

/// An antenna that looks at something.
struct Aim {
  float cos_azimuth = 1, sin_azimuth = 0, cos_elevation = 1, sin_elevation = 0;
  float steer_u = 0, steer_v = 0;
};

/// The aim at a target, or as near to it as the look lets the beam come.
/// @param target  direction in the look's frame, of any length above 0
EMSCAPE_HD inline Aim aimAt(const RadarLook& look, const Vec3f& target) {
  if (look.kind == LookKind::held) return {1, 0, 1, 0, look.steer_u, look.steer_v};
  const float level = std::sqrt(target.x * target.x + target.y * target.y);
  const float inverse_length = 1 / std::sqrt(dot(target, target));
  if (look.kind == LookKind::steered) {
    return {1, 0, 1, 0, target.y * inverse_length, target.z * inverse_length};
  }
  Aim aim;
  const float cos_azimuth = level > 0 ? target.x / level : 1;
  const float sin_azimuth = level > 0 ? target.y / level : 0;
  const bool is_within = cos_azimuth >= look.cos_azimuth;
  aim.cos_azimuth = is_within ? cos_azimuth : look.cos_azimuth;
  aim.sin_azimuth = is_within ? sin_azimuth : std::copysign(look.sin_azimuth, sin_azimuth);
  const float sin_elevation = target.z * inverse_length;
  const bool is_below = sin_elevation<look.sin_lowest, is_above = sin_elevation> look.sin_highest;
  aim.sin_elevation = is_below ? look.sin_lowest : is_above ? look.sin_highest : sin_elevation;
  aim.cos_elevation = is_below ? look.cos_lowest : is_above ? look.cos_highest : level * inverse_length;
  return aim;
}

/// Amplitude (relative voltage, 0..1) of an antenna so aimed.
/// @param direction  in the look's frame, a unit vector
template <scenario::PatternKind kind>
EMSCAPE_HD inline float amplitudeTowards(const scenario::PatternView& pattern, const Aim& aim,
                                         const Vec3f& direction) {
  const float ahead = direction.x * aim.cos_azimuth + direction.y * aim.sin_azimuth;
  const Vec3f turned{ahead * aim.cos_elevation + direction.z * aim.sin_elevation,
                     direction.y * aim.cos_azimuth - direction.x * aim.sin_azimuth,
                     direction.z * aim.cos_elevation - ahead * aim.sin_elevation};
  return scenario::amplitudeOf<kind>(pattern, turned, aim.steer_u, aim.steer_v);
}

}  // namespace emscape::emfield
