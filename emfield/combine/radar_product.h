/// Radar quantities of a target at a voxel: signal-to-noise with and without jamming, detection,
/// burn-through.
///
/// With S the radar's one-way power density at the voxel, an echo's signal-to-noise ratio is (root S)^2: S
/// contains all effects of the path, which therefore enter twice. Jamming is one-way; its power over the
/// noise on boresight does not depend on the voxel, but the beam's direction does. Clutter adds to the
/// jamming (clutter_echo.h).
#pragma once

#include <vector>

#include "base/math/fast_math.h"
#include "emfield/combine/clutter_echo.h"
#include "emfield/combine/combine.h"
#include "emfield/combine/look_weights.h"
#include "emfield/radar/detection.h"
#include "emfield/radar/look.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"

namespace emscape::emfield {

/// The value that a radar adds to a channel.
enum class RadarMeasure {
  root_of_signal_to_noise,
  signal_to_jamming,  ///< S / J, times a factor, within RadarTask::lowest..ceiling: RadarTask::unjammed
                      ///< without jamming, the lowest without echo; 0 (nothing) without both
  detection,          ///< probability of detection from S / (C + N + J); 0 without echo
  root_of_signal_to_clutter_and_noise,
  detection_age,  ///< RadarTask::ceiling minus the age (s) of the last pass, if its probability is at least
                  ///< RadarTask::lowest; else 0 (nothing)
};

/// Jamming at a radar.
struct JammerAtRadar {
  Vec3f direction;               ///< unit vector along the ray's start, in the frame of the radar's look
  float boresight_to_noise = 0;  ///< jamming over noise at the receiver if the beam pointed there
  /// True if the jammer's model has a reflected ray. Then boresight_to_noise has the jammer's larger gain of
  /// the two rays, and the following are its pattern's amplitudes along them.
  bool has_reflected_ray = false;
  ReflectedRay reflected = {};
  Vec3f reflected_direction = {};  ///< as `direction`
  float direct_amplitude = 1, reflected_amplitude = 1;
};

/// Slant ranges from which a radar's echoes arrive while it listens, as plain data; by default all.
struct HeardRanges {
  float farthest_m = 1e30f;
  float repeat_m = 1e30f;  ///< c / (2 PRF)
  float pulse_m = 1e-30f;  ///< c tau / 2

  EMSCAPE_HD bool isLimited() const { return farthest_m < 1e30f || repeat_m < 1e30f; }
  /// Amplitude (0..1) of an echo after the filter matched to the whole pulse, by the part of the pulse that
  /// arrives between transmissions.
  EMSCAPE_HD float amplitudeOf(float range_m) const {
    const float from_pulse_m = std::fabs(range_m - repeat_m * std::floor(range_m / repeat_m + 0.5f));
    const float part = from_pulse_m < pulse_m ? from_pulse_m / pulse_m : 1.0f;
    return range_m <= farthest_m ? part : 0.0f;
  }
  /// The same of clutter, which is eclipsed as the echo that it arrives with.
  EMSCAPE_HD float powerOf(float range_m) const {
    const float amplitude = amplitudeOf(range_m);
    return amplitude * amplitude;
  }
};

/// A radar's contribution to a channel, as plain data.
struct RadarTask {
  RadarMeasure measure = RadarMeasure::root_of_signal_to_noise;
  Reduction reduction = Reduction::maximum;  ///< for detections, sum means independent detections
  RadarLook look;
  const LookArc* look_arcs = nullptr;  ///< of ArcLook
  int look_arc_count = 0;
  bool is_cumulative = false;  ///< detection: at least one in all looks
  LookCount looks;             ///< of is_cumulative
  LastPasses last_passes;      ///< of detection_age
  float echo_root = 0;         ///< (m2/W)
  float factor = 1;            ///< of signal_to_jamming
  float lowest = 0, ceiling = 1e30f;
  float unjammed = 0;        ///< of signal_to_jamming, with an echo; 0: the radar does not count
  DetectionCurveView curve;  ///< detection and its age
  ClutterTask clutter;
  HeardRanges heard;  ///< of detection and its age
  const JammerAtRadar* jammers = nullptr;
  int jammer_count = 0;
};

/// Root of an echo's signal-to-noise over RadarTask::echo_root, without the excess loss of the path; 0 in
/// shadow.
/// @param look  RadarLook or ArcLook
/// @param beam  with the look's frame as its forward, right and up
template <scenario::PatternKind kind, class Look>
EMSCAPE_HD inline float echoWeight(const Look& look, const EmitterBeam& beam, std::size_t column, float t_m) {
  const VoxelRay ray = voxelRay(beam, column, t_m);
  const Aim aim = aimAt(look, ray.direction);
  const Vec3f unit = ray.direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f));
  const float amplitude = amplitudeTowards<kind>(beam.pattern, aim, unit);
  return ray.isotropic_wm2 * (amplitude * amplitude);
}

/// The same with the reflected ray: the amplitude F of both rays applies in both directions.
template <scenario::PatternKind kind, class Look>
EMSCAPE_HD inline float echoWeight(const Look& look, const EmitterBeam& beam, const ReflectedRayCode& code,
                                   std::size_t column, float t_m) {
  const VoxelRay ray = voxelRay(beam, column, t_m);
  const ReflectedRay reflected = reflectedRay(code);
  const Aim aim = aimAt(look, ray.direction);
  const Vec3f unit = ray.direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f));
  const Vec3f below = reflectedDirection(beam, reflected, column, t_m);
  const float power = powerOfBothRays(reflected, amplitudeTowards<kind, true>(beam.pattern, aim, unit),
                                      amplitudeTowards<kind, true>(beam.pattern, aim, below));
  return ray.isotropic_wm2 * power;
}

/// One jammer's power over the noise while the radar looks at the voxel, over
/// JammerAtRadar::boresight_to_noise.
template <scenario::PatternKind kind, class Look>
EMSCAPE_HD inline float jammingWeight(const Look& look, const EmitterBeam& beam, const JammerAtRadar& jammer,
                                      std::size_t column, float t_m) {
  const Aim aim = aimAt(look, voxelRay(beam, column, t_m).direction);
  const float amplitude = amplitudeTowards<kind>(beam.pattern, aim, jammer.direction);
  return amplitude * amplitude;
}

/// The same for a jammer with a reflected ray.
template <scenario::PatternKind kind, class Look>
EMSCAPE_HD inline float jammingWeightOfBothRays(const Look& look, const EmitterBeam& beam,
                                                const JammerAtRadar& jammer, std::size_t column, float t_m) {
  const Aim aim = aimAt(look, voxelRay(beam, column, t_m).direction);
  const float direct = amplitudeTowards<kind, true>(beam.pattern, aim, jammer.direction);
  const float reflected = amplitudeTowards<kind, true>(beam.pattern, aim, jammer.reflected_direction);
  return powerOfBothRays(jammer.reflected, jammer.direct_amplitude * direct,
                         jammer.reflected_amplitude * reflected);
}

/// Number of looks at a voxel.
EMSCAPE_HD inline float looksAt(const RadarTask& task, const EmitterBeam& beam, std::size_t column,
                                float t_m) {
  return task.looks.towards(voxelRay(beam, column, t_m).direction);
}

/// Age (s) of the last pass of a voxel.
EMSCAPE_HD inline float ageAt(const RadarTask& task, const EmitterBeam& beam, std::size_t column, float t_m) {
  return task.last_passes.ageTowards(voxelRay(beam, column, t_m).direction);
}

/// Probability of at least one detection in independent looks.
EMSCAPE_HD inline float inAllLooks(float probability, float looks) {
  const float missed = 1 - probability;
  return missed > 0 ? 1 - fastExp2(looks * fastLog2(missed)) : 1.0f;
}

/// Adds a radar's echo to a channel's accumulator. Without branches, for SIMD.
/// @param jamming_to_noise  clutter included
/// @param looks  of RadarTask::is_cumulative; of detection_age: the age
template <RadarMeasure measure>
EMSCAPE_HD inline float withEcho(const RadarTask& task, float echo_to_noise_root, float jamming_to_noise,
                                 float looks, float accumulated) {
  const float echo_to_noise = echo_to_noise_root * echo_to_noise_root;
  float value = echo_to_noise_root;
  if constexpr (measure == RadarMeasure::signal_to_jamming) {
    const float ratio = task.factor * echo_to_noise;
    const bool is_jammed = ratio < task.ceiling * jamming_to_noise;
    const bool is_bounded = ratio < task.lowest * jamming_to_noise;
    const float unjammed = echo_to_noise > 0 ? task.unjammed : 0.0f;
    value = is_jammed ? (is_bounded ? task.lowest : ratio / jamming_to_noise) : unjammed;
  } else if constexpr (measure == RadarMeasure::detection) {
    const float probability = task.curve(fastRatioToDb(echo_to_noise / (1 + jamming_to_noise)));
    value = echo_to_noise > 0 ? probability : 0.0f;
    value = task.is_cumulative ? inAllLooks(value, looks) : value;
    const float either = accumulated + value * (1 - accumulated);
    value = task.reduction == Reduction::sum ? either : value;
  } else if constexpr (measure == RadarMeasure::detection_age) {
    const float probability = task.curve(fastRatioToDb(echo_to_noise / (1 + jamming_to_noise)));
    const bool is_detected = (echo_to_noise > 0) & (probability >= task.lowest);
    value = is_detected ? task.ceiling - looks : 0.0f;
  } else if constexpr (measure == RadarMeasure::root_of_signal_to_clutter_and_noise) {
    value = echo_to_noise_root / std::sqrt(1 + jamming_to_noise);
  }
  return value > accumulated ? value : accumulated;
}

/// The same for a measure that is not a template parameter.
EMSCAPE_HD inline float withRadar(const RadarTask& task, float echo_to_noise_root, float jamming_to_noise,
                                  float looks, float accumulated) {
  switch (task.measure) {
    case RadarMeasure::signal_to_jamming:
      return withEcho<RadarMeasure::signal_to_jamming>(task, echo_to_noise_root, jamming_to_noise, looks,
                                                       accumulated);
    case RadarMeasure::detection:
      return withEcho<RadarMeasure::detection>(task, echo_to_noise_root, jamming_to_noise, looks,
                                               accumulated);
    case RadarMeasure::root_of_signal_to_clutter_and_noise:
      return withEcho<RadarMeasure::root_of_signal_to_clutter_and_noise>(
          task, echo_to_noise_root, jamming_to_noise, looks, accumulated);
    case RadarMeasure::detection_age:
      return withEcho<RadarMeasure::detection_age>(task, echo_to_noise_root, jamming_to_noise, looks,
                                                   accumulated);
    case RadarMeasure::root_of_signal_to_noise:
      break;
  }
  return withEcho<RadarMeasure::root_of_signal_to_noise>(task, echo_to_noise_root, jamming_to_noise, looks,
                                                         accumulated);
}

/// A pass of one radar over the voxels of a channel.
struct RadarPass {
  RadarTask task;
  /// With the look's frame as its forward, right and up. Its EIRP may be in the task's echo_root instead,
  /// and is then 4 pi W here, so that weights do not contain it.
  EmitterBeam beam;
  Dims dims;
  const float* t_m = nullptr;        ///< z of each layer
  const int* first_row_k = nullptr;  ///< for each y the lowest layer with a voxel above ground; null: 0
  float* accumulator = nullptr;      ///< dense order
  bool has_reflected_rays = false;   ///< the radar or a jammer has weighted reflected rays
  ClutterMapView clutter_map;        ///< without cells: no surface clutter
};

/// True if a pass has no reflected rays, no clutter, no limits of range and no ages.
inline bool isPlain(const RadarPass& pass) {
  return !pass.has_reflected_rays && pass.task.clutter.isNone() && !pass.task.heard.isLimited() &&
         pass.task.measure != RadarMeasure::detection_age;
}

/// One voxel of a pass. The CPU does the same row by row if the look has no arcs.
/// @tparam kAny  false: for passes that are plain (isPlain())
template <scenario::PatternKind kind, bool kAny = true>
EMSCAPE_HD inline void addEcho(const RadarPass& pass, std::size_t column, int k) {
  const RadarTask& task = pass.task;
  const ArcLook look{task.look, task.look_arcs, task.look_arc_count};
  const std::size_t voxel = static_cast<std::size_t>(k) * pass.dims.x * pass.dims.y + column;
  const float t_m = pass.t_m[k];
  float weight;
  if (kAny && weighsReflectedRays(pass.beam)) {
    weight = echoWeight<kind>(look, pass.beam, pass.beam.geometry.reflected[voxel], column, t_m);
  } else {
    weight = echoWeight<kind>(look, pass.beam, column, t_m);
  }
  if (!pass.beam.geometry.excess.isEmpty()) weight *= pass.beam.geometry.excess.factor(voxel);
  if (kAny && task.heard.isLimited())
    weight *= task.heard.amplitudeOf(slantRange_m(pass.beam.geometry, column, t_m));
  const float root = task.echo_root * weight;
  float jamming = 0;
  for (int n = 0; n < task.jammer_count; ++n) {
    const JammerAtRadar& jammer = task.jammers[n];
    jamming +=
        jammer.boresight_to_noise * (kAny && jammer.has_reflected_ray
                                         ? jammingWeightOfBothRays<kind>(look, pass.beam, jammer, column, t_m)
                                         : jammingWeight<kind>(look, pass.beam, jammer, column, t_m));
  }
  if constexpr (kAny) {
    if (!task.clutter.isNone()) {
      const AimedVoxel aimed = aimedVoxel(look, pass.beam, column, t_m);
      jamming += task.heard.powerOf(aimed.range_m) * clutterToNoise<kind>(task.clutter, pass.clutter_map,
                                                                          pass.clutter_map.trips, pass.beam,
                                                                          aimed.aim, aimed.range_m);
    }
  }
  const bool is_age = kAny && task.measure == RadarMeasure::detection_age;
  const float looks = is_age               ? ageAt(task, pass.beam, column, t_m)
                      : task.is_cumulative ? looksAt(task, pass.beam, column, t_m)
                                           : 1.0f;
  pass.accumulator[voxel] = withRadar(task, root, jamming, looks, pass.accumulator[voxel]);
}

/// Runs a pass on the CPU. Voxels below first_row_k are not changed.
/// @param weights  none for a look with arcs
void radarCpu(const RadarPass& pass, const LookWeights& weights = {});

/// The arcs to which a radar's ArcLook, LookCount and LastPasses point.
struct IntervalArcs {
  std::vector<LookArc> directions;
  std::vector<CountedArc> counts;
  std::vector<PassedArc> passes;
};

/// A radar's contribution to a channel, with the data to which it points.
struct RadarShare {
  int channel = 0;
  RadarTask task;  ///< without jammers, arcs and curve
  /// The look's frame in the emitter's east-north-up axes.
  Vec3f forward, right, up;
  std::vector<JammerAtRadar> jammers;
  IntervalArcs arcs;
};

/// @param beam         with views of its geometry and pattern
/// @param clutter_map  of the radar
/// @param task         the pass over the other emitters
inline RadarPass radarPass(const RadarShare& share, const EmitterBeam& beam,
                           const ClutterMapView& clutter_map, const CombineTask& task, float* accumulator) {
  RadarPass pass{
      share.task, beam, task.dims, task.t_m, task.first_row_k, accumulator, weighsReflectedRays(beam),
      clutter_map};
  for (const JammerAtRadar& jammer : share.jammers) pass.has_reflected_rays |= jammer.has_reflected_ray;
  pass.task.echo_root *= beam.eirp_over_4pi_w;
  pass.beam.eirp_over_4pi_w = 1;
  pass.beam.forward = share.forward;
  pass.beam.right = share.right;
  pass.beam.up = share.up;
  pass.task.jammers = share.jammers.data();
  pass.task.jammer_count = static_cast<int>(share.jammers.size());
  pass.task.look_arcs = share.arcs.directions.data();
  pass.task.look_arc_count = static_cast<int>(share.arcs.directions.size());
  pass.task.looks.arcs = share.arcs.counts.data();
  pass.task.looks.arc_count = static_cast<int>(share.arcs.counts.size());
  pass.task.last_passes.arcs = share.arcs.passes.data();
  pass.task.last_passes.arc_count = static_cast<int>(share.arcs.passes.size());
  return pass;
}

}  // namespace emscape::emfield
