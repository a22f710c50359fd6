/// What a radar makes of a target at a voxel: signal-to-noise with and without jamming, detections,
/// burn-through.
///
/// With S the radar's one-way power density at the voxel, an echo's signal-to-noise is (root S)^2: all that
/// the path does to a wave is in S and counts twice with it. Jamming comes one way; what it is at the radar's
/// receiver on boresight, over the noise, does not depend on the voxel, but where the beam points does.
#pragma once

#include <vector>

#include "base/fast_math.h"
#include "base/host_device.h"
#include "base/vec.h"
#include "emfield/combine.h"
#include "emfield/detection.h"
#include "emfield/radar_look.h"

namespace emscape::emfield {

/// What a radar adds to a channel.
enum class RadarMeasure {
  root_of_signal_to_noise,
  signal_to_jamming,  ///< S / J, times a factor, at most a ceiling, which it is without jamming; 0 without
                      ///< echo
  detection,          ///< probability of detection from S / (N + J); 0 without echo
};

/// Jamming at a radar.
struct JammerAtRadar {
  Vec3f direction;               ///< unit vector along the ray's start, in the frame of the radar's look
  float boresight_to_noise = 0;  ///< jamming over noise at the receiver if the beam pointed there
};

/// A radar's part in a channel, as plain data.
struct RadarTask {
  RadarMeasure measure = RadarMeasure::root_of_signal_to_noise;
  Reduction reduction =
      Reduction::maximum;  ///< detections: sum stands for detections independent of each other
  RadarLook look;
  float echo_root = 0;  ///< (m2/W)
  float factor = 1;     ///< of signal_to_jamming
  float ceiling = 1e30f;
  DetectionCurveView curve;  ///< detection
  const JammerAtRadar* jammers = nullptr;
  int jammer_count = 0;
};

/// Root of an echo's signal-to-noise; 0 in shadow.
/// @param beam  with the look's frame as its forward, right and up
template <scenario::PatternKind kind>
EMSCAPE_HD inline float echoToNoiseRoot(const RadarTask& task, const EmitterBeam& beam, std::size_t column,
                                        std::size_t voxel, float t_m) {
  const VoxelRay ray = voxelRay(beam, column, t_m);
  const Aim aim = aimAt(task.look, ray.direction);
  const Vec3f unit = ray.direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f));
  const float amplitude = amplitudeTowards<kind>(beam.pattern, aim, unit);
  const ExcessCode* excess = beam.geometry.excess;
  const float path = excess == nullptr ? 1.0f : excessFactor(excess[voxel]);
  return task.echo_root * ray.isotropic_wm2 * path * amplitude * amplitude;
}

/// One jammer's power over the noise while the radar looks at the voxel.
template <scenario::PatternKind kind>
EMSCAPE_HD inline float jammingToNoise(const RadarTask& task, const EmitterBeam& beam,
                                       const JammerAtRadar& jammer, std::size_t column, float t_m) {
  const Aim aim = aimAt(task.look, voxelRay(beam, column, t_m).direction);
  const float amplitude = amplitudeTowards<kind>(beam.pattern, aim, jammer.direction);
  return jammer.boresight_to_noise * amplitude * amplitude;
}

/// Adds what a radar makes of its echo to a channel's accumulator.
EMSCAPE_HD inline float withRadar(const RadarTask& task, float echo_to_noise_root, float jamming_to_noise,
                                  float accumulated) {
  const float echo_to_noise = echo_to_noise_root * echo_to_noise_root;
  float value = echo_to_noise_root;
  if (task.measure == RadarMeasure::signal_to_jamming) {
    const float limit = task.ceiling * jamming_to_noise;
    const float ratio = task.factor * echo_to_noise;
    value = ratio < limit ? ratio / jamming_to_noise : (echo_to_noise > 0 ? task.ceiling : 0.0f);
  } else if (task.measure == RadarMeasure::detection) {
    value = echo_to_noise > 0 ? task.curve(fastRatioToDb(echo_to_noise / (1 + jamming_to_noise))) : 0.0f;
    if (task.reduction == Reduction::sum) return accumulated + value * (1 - accumulated);
  }
  return value > accumulated ? value : accumulated;
}

/// A pass of one radar over the voxels of a channel.
struct RadarPass {
  RadarTask task;
  EmitterBeam beam;  ///< with the look's frame as its forward, right and up
  Dims dims;
  const float* t_m = nullptr;        ///< z of each layer
  const int* first_row_k = nullptr;  ///< for each y the lowest layer with a voxel above ground; null: 0
  float* accumulator = nullptr;      ///< dense order
};

/// One voxel of a pass: what the loops of both backends do.
template <scenario::PatternKind kind>
EMSCAPE_HD inline void addEcho(const RadarPass& pass, std::size_t column, int k) {
  const std::size_t voxel = static_cast<std::size_t>(k) * pass.dims.x * pass.dims.y + column;
  const float root = echoToNoiseRoot<kind>(pass.task, pass.beam, column, voxel, pass.t_m[k]);
  float jamming = 0;
  for (int n = 0; n < pass.task.jammer_count; ++n) {
    jamming += jammingToNoise<kind>(pass.task, pass.beam, pass.task.jammers[n], column, pass.t_m[k]);
  }
  pass.accumulator[voxel] = withRadar(pass.task, root, jamming, pass.accumulator[voxel]);
}

/// Runs a pass on the CPU. Voxels below first_row_k are left as they are.
void radarCpu(const RadarPass& pass);

/// A radar's part in a channel with the data that it points to.
struct RadarShare {
  int channel = 0;
  RadarTask task;  ///< without jammers and curve
  /// The look's frame in the emitter's east-north-up axes.
  Vec3f forward, right, up;
  std::vector<JammerAtRadar> jammers;
};

/// @param beam  with views of its geometry and pattern
/// @param task  the pass over the ordinary shares
inline RadarPass radarPass(const RadarShare& share, const EmitterBeam& beam, const CombineTask& task,
                           float* accumulator) {
  RadarPass pass{share.task, beam, task.dims, task.t_m, task.first_row_k, accumulator};
  pass.beam.forward = share.forward;
  pass.beam.right = share.right;
  pass.beam.up = share.up;
  pass.task.jammers = share.jammers.data();
  pass.task.jammer_count = static_cast<int>(share.jammers.size());
  return pass;
}

}  // namespace emscape::emfield
