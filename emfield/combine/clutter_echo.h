/// Clutter in the resolution cell of a voxel while a radar's beam is aimed at it.
///
/// Land and sea: the map at the beam's azimuth and the voxel's slant range, and at those of the other trips
/// whose echoes arrive with it, each weighted by the two-way pattern towards its surface. Rain: the beam's
/// cross section times the range cell, in the part of the two-way power between mean sea level and the top of
/// the rain. An array's beam widens with the steering, by the direction cosines of its plane (Mailloux,
/// Phased Array Antenna Handbook, ch. 1).
#pragma once

#include <cmath>

#include "base/math/fast_math.h"
#include "emfield/clutter/clutter_beam.h"
#include "emfield/combine/combine.h"
#include "emfield/geometry/clutter_map.h"
#include "emfield/radar/look.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

/// A radar's clutter in a channel, after its filter, as plain data; all 0: none.
struct ClutterTask {
  float surface = 0;             ///< clutter over noise on boresight, per value of a map's cell (m2 rad)
  float rain = 0;                ///< clutter over noise times range^2, with the whole beam in rain (m2)
  float rain_octaves_per_m = 0;  ///< two-way loss through gases and rain, log2
  float rain_top_m = 0;          ///< of the rain, above the radar
  float sea_level_m = 0;         ///< above the radar
  float curvature_per_m = 0;     ///< 1 / (2 effective earth radius)
  PowerBelow below;              ///< of the beam that is not steered

  EMSCAPE_HD bool isNone() const { return surface == 0 && rain == 0; }
};

/// The beam's axis in the look's frame, a unit vector.
EMSCAPE_HD inline Vec3f axisOf(const Aim& aim) {
  const float ahead2 = 1 - aim.steer_u * aim.steer_u - aim.steer_v * aim.steer_v;
  const float forward = std::sqrt(ahead2 > 0 ? ahead2 : 0.0f);
  const float level = forward * aim.cos_elevation - aim.steer_v * aim.sin_elevation;
  return {level * aim.cos_azimuth - aim.steer_u * aim.sin_azimuth,
          level * aim.sin_azimuth + aim.steer_u * aim.cos_azimuth,
          forward * aim.sin_elevation + aim.steer_v * aim.cos_elevation};
}

/// Direction of the beam's axis, east-north-up.
/// @param beam  with the look's frame as its forward, right and up
EMSCAPE_HD inline Vec3f axisOf(const EmitterBeam& beam, const Aim& aim) {
  const Vec3f axis = axisOf(aim);
  return beam.forward * axis.x + beam.right * axis.y + beam.up * axis.z;
}

/// The part of an array's boresight that remains in the direction of its steering, a cosine; 1 of others.
EMSCAPE_HD inline float cosineOfSteering(const Aim& aim) {
  constexpr float kLeast2 = 1e-4f;
  const float cosine2 = 1 - aim.steer_u * aim.steer_u - aim.steer_v * aim.steer_v;
  return std::sqrt(cosine2 > kLeast2 ? cosine2 : kLeast2);
}

/// Rain's clutter over noise at a slant range. Without branches, for SIMD.
EMSCAPE_HD inline float rainToNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim,
                                    float range_m) {
  const auto elevation = [](float sine) {
    const float bounded = sine < -1 ? -1.0f : sine > 1 ? 1.0f : sine;
    return fastAtan2(bounded, std::sqrt(1 - bounded * bounded));
  };
  const float sine = axisOf(beam, aim).z, axis_rad = elevation(sine);
  const float drop_m = range_m * range_m * (1 - sine * sine) * task.curvature_per_m;
  const float narrowing = std::sqrt(1 - aim.steer_v * aim.steer_v);
  const auto below = [&](float height_m) {
    return task.below.at((elevation((height_m - drop_m) / range_m) - axis_rad) * narrowing);
  };
  const float in_rain = below(task.rain_top_m) - below(task.sea_level_m);
  const float ahead = cosineOfSteering(aim);
  const float element2 = fastExp2(4 * beam.pattern.element_exponent * fastLog2(ahead));  // there and back
  return task.rain * element2 / ahead * (in_rain > 0 ? in_rain : 0.0f) *
         fastExp2(-task.rain_octaves_per_m * range_m) / (range_m * range_m);
}

/// Clutter of land and sea over noise at a slant range. Without branches, for SIMD.
/// @param map   ClutterMapView, or a type with the same cellAt()
template <scenario::PatternKind kind, class Map>
EMSCAPE_HD inline float surfaceToNoise(const ClutterTask& task, const Map& map, const EmitterBeam& beam,
                                       const Aim& aim, float range_m) {
  const Vec3f direction = axisOf(beam, aim);
  const ClutterCell cell = map.cellAt(fastAtan2(direction.x, direction.y), range_m);
  const TwoSurfaces surfaces = twoSurfaces(cell);
  const float per_level2 = 1 / (direction.x * direction.x + direction.y * direction.y + 1e-12f);
  const auto echoOf = [&](float sine, float echo) {
    const float cosine2 = 1 - sine * sine;
    const float scale = std::sqrt((cosine2 > 0 ? cosine2 : 0.0f) * per_level2);
    const Vec3f to_surface = inAntennaFrame(beam, {direction.x * scale, direction.y * scale, sine});
    const float amplitude = amplitudeTowards<kind>(beam.pattern, aim, to_surface),
                power = amplitude * amplitude;
    return echo * power * power;
  };
  const float widening = std::sqrt(1 - aim.steer_v * aim.steer_v) / cosineOfSteering(aim);
  return task.surface * widening *
         (echoOf(surfaces.sine[0], surfaces.echo[0]) + echoOf(surfaces.sine[1], surfaces.echo[1]));
}

/// The same in one of the trips that arrive with a slant range.
template <scenario::PatternKind kind, class Map>
EMSCAPE_HD inline float surfaceOfTrip(const ClutterTask& task, const Map& map, const EchoTrips& trips,
                                      const EmitterBeam& beam, const Aim& aim, float range_m, int trip) {
  const float there_m = trips.range_m(range_m, trip);
  const float value = surfaceToNoise<kind>(task, map, beam, aim, there_m);
  return there_m < trips.end_m ? value : 0.0f;
}

/// The sum of rain and of all trips of the surface.
template <scenario::PatternKind kind, class Map>
EMSCAPE_HD inline float clutterToNoise(const ClutterTask& task, const Map& map, const EchoTrips& trips,
                                       const EmitterBeam& beam, const Aim& aim, float range_m) {
  float sum = task.rain > 0 ? rainToNoise(task, beam, aim, range_m) : 0.0f;
  for (int trip = 0; task.surface > 0 && trip < trips.count; ++trip)
    sum += surfaceOfTrip<kind>(task, map, trips, beam, aim, range_m, trip);
  return sum;
}

/// Slant range (m) of a voxel, at least kMinDistance_m.
template <class Geometry>
EMSCAPE_HD inline float slantRange_m(const Geometry& geometry, std::size_t column, float t_m) {
  const float along_m = t_m - geometry.nearest_t_m[column];
  const float distance2 = geometry.offset2_m2[column] + along_m * along_m;
  constexpr float kMin2 = kMinDistance_m * kMinDistance_m;
  return std::sqrt(distance2 > kMin2 ? distance2 : kMin2);
}

/// The aim of a radar at a voxel, and the voxel's slant range.
struct AimedVoxel {
  Aim aim;
  float range_m;
};
template <class Look>
EMSCAPE_HD inline AimedVoxel aimedVoxel(const Look& look, const EmitterBeam& beam, std::size_t column,
                                        float t_m) {
  const Vec3f target = inAntennaFrame(beam, directRay(beam.geometry, column, t_m));
  return {aimAt(look, target), slantRange_m(beam.geometry, column, t_m)};
}

}  // namespace emscape::emfield
