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
#include "propagation/complex.h"
#include "scenario/model/blanked_jammers.h"

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
  float boresight_to_noise = 0;  ///< mean jamming over noise at the receiver if the beam pointed there
  float duty = 1;                ///< part (0..1] of the time in which it radiates: mean over peak power
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

/// Probability of at least one detection in independent looks.
EMSCAPE_HD inline float inAllLooks(float probability, float looks) {
  const float missed = 1 - probability;
  return missed > 0 ? 1 - fastExp2(looks * fastLog2(missed)) : 1.0f;
}

/// Independent jamming of one moment in both channels of a side-lobe blanker, as powers over the noise of the
/// main channel. The covariance c of the channels is the sum of the jammers' (J A)^1/2 exp(i phi), each with
/// its own phase phi.
struct JammingSum {
  float main = 0;
  float auxiliary = 0;  ///< over the threshold
  float unlike = 0;     ///< main times auxiliary less the mean of |c|^2, over main + auxiliary
  float spread = 0;     ///< standard deviation of |c|^2 over the phases, over main + auxiliary

  EMSCAPE_HD JammingSum with(float of_main, float of_auxiliary) const {
    const float before = main + auxiliary, over_all = 1 / (before + of_main + of_auxiliary + 1e-30f);
    const float part = before * over_all, spread_before = spread * part;
    const float alike = main * (auxiliary * over_all) - unlike * part;
    const float cross = 2 * (alike > 0 ? alike : 0.0f) * (of_main * (of_auxiliary * over_all));
    return {main + of_main, auxiliary + of_auxiliary,
            main * (of_auxiliary * over_all) + auxiliary * (of_main * over_all) + unlike * part,
            std::sqrt(spread_before * spread_before + cross)};
  }
};

/// Jammers of pulses at a radar with a side-lobe blanker whose overlaps are computed; weaker ones count as
/// continuous with their mean power.
constexpr int kMaxPulsedJammers = scenario::kMaxBlankedJammers;

/// The states of the jamming at a side-lobe blanker: that of the continuous jammers, and those of each
/// combination of the jammers of pulses, which are independent in time, with them.
struct BlankedSum {
  JammingSum states[1 << kMaxPulsedJammers];  ///< the first without pulses
  float parts[1 << kMaxPulsedJammers] = {1};  ///< of the time
  int count = 1;

  /// Adds a jammer: those without pauses first.
  EMSCAPE_HD void add(float duty, float of_main, float of_auxiliary) {
    const int known = count, first = duty < 1 ? known : 0;
    for (int n = 0; n < known; ++n) {
      states[first + n] = states[n].with(of_main, of_auxiliary);
      parts[first + n] = parts[n] * duty;
      if (first > 0) parts[n] *= 1 - duty;
    }
    count = first + known;
  }
};

/// What a side-lobe blanker leaves of a radar's pulses: means over all pulses, with 0 in blanked ones.
struct OpenPulses {
  float part = 0;    ///< of the pulses (0..1)
  float power = 0;   ///< of echo, noise and jamming, over noise
  float square = 0;  ///< of that power

  EMSCAPE_HD OpenPulses plus(const OpenPulses& others, float factor) const {
    return {part + factor * others.part, power + factor * others.power, square + factor * others.square};
  }
};

/// Echoes for which the detection behind a blanker is computed.
constexpr int kMaxBlankedEchoes = 8;

/// A side-lobe blanker, as plain data; by default none. Jamming and noise are independent complex Gaussian
/// variables, the noise of the auxiliary channel does not blank, and the phase between the two channels is
/// another for each jammer.
struct Blanker {
  using Complex = propagation::Complex<float>;
  /// An echo that varies as a complex Gaussian variable, of a complex power.
  struct GaussianEcho {
    Complex weight, power;
  };

  static constexpr float kShut = 1e-4f;  ///< part of the pulses

  float auxiliary = 0;  ///< gain of the auxiliary antenna over the main one's maximum and over the threshold
  BlankedCurveView curve;
  int echo_count = 0;                     ///< of a target that fluctuates from scan to scan a quadrature
  float echoes[kMaxBlankedEchoes] = {};   ///< over the mean echo
  float weights[kMaxBlankedEchoes] = {};  ///< their probabilities
  float fluctuation = 0;  ///< from pulse to pulse: variance over square of the mean; 0, 1/2 or 1
  GaussianEcho parts[2];  ///< their sum varies so

  EMSCAPE_HD bool isNone() const { return auxiliary == 0; }

  /// A jammer's power over noise in its pulses, in the auxiliary channel, which has a gain of 1 for all rays.
  EMSCAPE_HD float inAuxiliary(const JammerAtRadar& jammer) const {
    const float rays = jammer.has_reflected_ray ? powerOfBothRays(jammer.reflected, jammer.direct_amplitude,
                                                                  jammer.reflected_amplitude)
                                                : 1.0f;
    return jammer.boresight_to_noise / jammer.duty * (auxiliary * rays);
  }
  /// Adds a jammer: those without pauses first.
  /// @param weight  of the jammer in the main channel, over that on boresight
  EMSCAPE_HD void add(const JammerAtRadar& jammer, float weight, BlankedSum& blanked) const {
    blanked.add(jammer.duty, jammer.boresight_to_noise / jammer.duty * weight, inAuxiliary(jammer));
  }

  /// Pulses without an echo, without their square.
  /// @param clutter  over noise, in the main channel alone
  EMSCAPE_HD OpenPulses leftOf(const JammingSum& sum, float clutter) const {
    const Channels in = channelsOf(sum, clutter, 0);
    const OpenPulses low = quietOf(in, in.lower(1.2247449f)), middle = quietOf(in, in.lower(0)),
                     high = quietOf(in, in.lower(-1.2247449f));  // (3/2)^1/2
    constexpr float kThird = 1.0f / 3;
    return {kThird * (low.part + middle.part + high.part),
            kThird * in.all * (low.power + middle.power + high.power), 0};
  }
  /// Pulses with an echo: all but those that are blanked; none if fewer than kShut are open.
  EMSCAPE_HD OpenPulses leftOf(const JammingSum& sum, float clutter, float echo_to_noise) const {
    const Channels in = channelsOf(sum, clutter, echo_to_noise);
    // Without a loop, for SIMD.
    const OpenPulses blanked = blankedOf(in, in.lower(1), parts[0])
                                   .plus(blankedOf(in, in.lower(-1), parts[0]), 1)
                                   .plus(blankedOf(in, in.lower(1), parts[1]), 1)
                                   .plus(blankedOf(in, in.lower(-1), parts[1]), 1);
    const float mean = in.main + in.echo, blanks = sum.auxiliary > 0 ? -0.5f : 0.0f;
    const OpenPulses all{1, mean, 2 * mean * mean - (1 - fluctuation) * in.echo * in.echo};
    const OpenPulses left = all.plus(blanked, blanks);
    // A difference of nearly equal numbers: what is left of it in so few pulses is no more than their
    // rounding.
    const bool is_shut = left.part < kShut;
    return {is_shut         ? 0.0f
            : left.part < 1 ? left.part
                            : 1.0f,
            is_shut || left.power < 0 ? 0.0f : in.all * left.power,
            is_shut || left.square < 0 ? 0.0f : in.all * left.square * in.all};
  }

  /// The powers of the open pulses of several states. The states are told apart at the middle, unless they
  /// differ by their rounding alone.
  struct Powers {
    float least = 1e30f, most = 0;
    EMSCAPE_HD void add(const OpenPulses& of_state) {
      const float power = of_state.part > 1e-6f ? of_state.power / of_state.part : 0.0f;
      least = power > 0 && power < least ? power : least;
      most = power > most ? power : most;
    }
    EMSCAPE_HD bool isHigh(const OpenPulses& of_state) const {
      constexpr float kRounding = 1e-4f;
      return of_state.power * of_state.power > (1 + kRounding) * least * most * of_state.part * of_state.part;
    }
  };

  /// Mean over noise of open pulses without an echo, which the threshold follows.
  EMSCAPE_HD static float noiseOf(const OpenPulses& quiet) { return quiet.power / (quiet.part + 1e-30f); }

  /// Probability of detection of one echo: the looks none of whose open pulses is of a state of high power,
  /// and the others.
  /// @param quiet, jammed  pulses with the echo, of the states of low and of high power
  /// @param threshold      noiseOf()
  EMSCAPE_HD float detected(const OpenPulses& quiet, const OpenPulses& jammed, float threshold) const {
    const float other = 1 - jammed.part, over_other = other > 1e-6f ? 1 / other : 0.0f;
    const float no_pulse = fastExp2(curve.pulses * fastLog2(other + 1e-30f)), any = 1 - no_pulse;
    const float over_any = any > 1e-4f ? 1 / any : 1 / (curve.pulses * jammed.part + 1e-30f);
    const OpenPulses none, alone = none.plus(quiet, over_other);
    const float of_quiet = 1 - jammed.part * over_any;
    return no_pulse * ofOpen(alone, threshold) +
           any * ofOpen(none.plus(jammed, over_any).plus(alone, of_quiet), threshold);
  }
  /// The same if no pulse were blanked.
  EMSCAPE_HD float unblanked(float echo_to_threshold) const {
    const float mean = 1 + echo_to_threshold, steady = echo_to_threshold / mean;
    return curve.unblanked(fastRatioToDb(mean), 1 - (1 - fluctuation) * steady * steady);
  }
  /// Corrects the sum over the echoes by its error without blanking.
  /// @param of_open  the sum if no pulse were blanked
  /// @param exact    the latter without error
  /// @param most     without jamming, which helps no detection: false alarms do not count
  EMSCAPE_HD static float corrected(float sum, float of_open, float exact, float most) {
    const float result = sum < of_open ? exact * sum / of_open : exact + sum - of_open;
    return result < most ? result : most;
  }

  /// Part of the pulses that are not blanked, the mean over the echoes.
  EMSCAPE_HD float openPart(const BlankedSum& blanked, float clutter, float echo_to_noise) const {
    float open = 0;
    for (int n = 0; n < echo_count; ++n) {
      for (int state = 0; state < blanked.count; ++state) {
        open += weights[n] * blanked.parts[state] *
                leftOf(blanked.states[state], clutter, echoes[n] * echo_to_noise).part;
      }
    }
    return open;
  }
  /// Probability of detection.
  EMSCAPE_HD float probability(const BlankedSum& blanked, const DetectionCurveView& unblanked_curve,
                               float clutter, float echo_to_noise) const {
    OpenPulses without;
    for (int n = 0; n < blanked.count; ++n)
      without = without.plus(leftOf(blanked.states[n], clutter), blanked.parts[n]);
    const float threshold = noiseOf(without);
    float sum = 0, of_open = 0;
    for (int n = 0; n < echo_count; ++n) {
      OpenPulses of_states[1 << kMaxPulsedJammers], quiet, jammed;
      Powers powers;
      for (int state = 0; state < blanked.count; ++state) {
        of_states[state] = leftOf(blanked.states[state], clutter, echoes[n] * echo_to_noise);
        powers.add(of_states[state]);
      }
      for (int state = 0; state < blanked.count; ++state) {
        OpenPulses& of = powers.isHigh(of_states[state]) ? jammed : quiet;
        of = of.plus(of_states[state], blanked.parts[state]);
      }
      sum += weights[n] * detected(quiet, jammed, threshold);
      of_open += weights[n] * unblanked(echoes[n] * echo_to_noise / threshold);
    }
    return corrected(sum, of_open, unblanked_curve(fastRatioToDb(echo_to_noise / threshold)),
                     unblanked_curve(fastRatioToDb(echo_to_noise / (1 + clutter))));
  }

 private:
  /// Both channels, over the sum of their powers.
  struct Channels {
    float all;  ///< the sum over noise
    float main, auxiliary, echo;
    float unlike, spread;  ///< main times auxiliary less the mean of |c|^2, without the echo; its deviation
    float least;           ///< of unlike
    /// Main times auxiliary less |c|^2, that a number of deviations above its mean.
    EMSCAPE_HD float lower(float deviations) const {
      const float d = unlike - deviations * spread, most = main * auxiliary;
      return d < least ? least : d < most ? d : most;
    }
  };
  EMSCAPE_HD static Channels channelsOf(const JammingSum& sum, float clutter, float echo_to_noise) {
    const float noise = 1 + clutter;
    const float all = sum.main + sum.auxiliary + noise + echo_to_noise, over_all = 1 / all;
    const float main = (sum.main + noise) * over_all, auxiliary = sum.auxiliary * over_all;
    const float jamming = over_all * (sum.main * over_all + auxiliary),
                least = auxiliary * (noise * over_all);
    return {
        all,  main, auxiliary, echo_to_noise * over_all, least + sum.unlike * jamming, sum.spread * jamming,
        least};
  }
  /// Of complex Gaussian fields of the powers M and A, with D = A M - |c|^2, e = A - M and w^2 = e^2 + 4 D,
  /// the auxiliary one is the stronger in the part (1 + e / w) / 2; the power is the derivative of the part
  /// by a factor of the density (models.md). The smaller part without a cancellation.
  EMSCAPE_HD static OpenPulses quietOf(const Channels& in, float d) {
    const float e = in.auxiliary - in.main, size = e > 0 ? e : -e;
    const float w = std::sqrt(e * e + 4 * d) + 1e-30f, both = w + size, over_w = 1 / w;
    const float part = 2 * d * over_w / both, ratio = d * over_w;
    const float power =
        2 * ratio * ratio * over_w * (2 * in.main * (w + both) / (both * both) + (e > 0 ? 1.0f : -1.0f));
    return e > 0 ? OpenPulses{part, power, 0} : OpenPulses{1 - part, in.main - power, 0};
  }
  /// Blanked pulses with a Gaussian echo of a complex power: the part as quietOf(), and its first and second
  /// derivative.
  EMSCAPE_HD static OpenPulses blankedOf(const Channels& in, float d, const GaussianEcho& of) {
    const Complex echo = of.power * in.echo, one{1, 0};
    const Complex main = Complex{in.main, 0} + echo, e = Complex{in.auxiliary, 0} - main;
    const Complex all = Complex{in.auxiliary, 0} + main, over_all = one / all;
    const float e0 = in.auxiliary - in.main;
    const Complex square =
        Complex{e0 * e0 + 4 * d, 0} + echo * (2 * (in.auxiliary + in.main)) + echo * echo;  // w^2
    // w / all, whose real part is positive.
    const Complex squared = square * over_all * over_all;
    const float re = std::sqrt(0.5f * (std::sqrt(norm(squared)) + squared.re) + 1e-30f);
    const Complex root{re, squared.im / (2 * re)};
    const Complex all_w = one / root, over_w = over_all * all_w;
    const Complex e_w = e * over_w, d_w = (Complex{d, 0} + echo * in.auxiliary) * over_w;
    const Complex part = (one + e_w) * 0.5f;
    const Complex first = d_w * (e_w * all_w - one);
    const Complex second = d_w * d_w * (e_w * (all_w * all_w * 3.0f - one) - all_w * 2.0f);
    const Complex power = main * part + first * 0.5f;
    const Complex of_square = main * (main * part * 2.0f + first) + second * 0.5f;
    return {(of.weight * part).re, (of.weight * power).re, (of.weight * of_square).re};
  }
  /// Probability that the sum of a look's open pulses exceeds the threshold.
  EMSCAPE_HD float ofOpen(const OpenPulses& pulses, float threshold) const {
    const float over_part = 1 / (pulses.part + 1e-30f), mean = pulses.power * over_part + 1e-30f;
    const float square = pulses.square * over_part;
    return curve(pulses.part, fastRatioToDb(mean / threshold), square / mean / mean - 1);
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
  HeardRanges heard;                       ///< of detection and its age
  Blanker blanker;                         ///< of detection and its age
  const JammerAtRadar* jammers = nullptr;  ///< those without pauses first
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

/// Adds a radar's detection to a channel's accumulator. Without branches, for SIMD.
/// @param looks  of RadarTask::is_cumulative; of detection_age: the age
template <RadarMeasure measure>
EMSCAPE_HD inline float withDetection(const RadarTask& task, bool has_echo, float probability, float looks,
                                      float accumulated) {
  float value;
  if constexpr (measure == RadarMeasure::detection) {
    value = has_echo ? probability : 0.0f;
    value = task.is_cumulative ? inAllLooks(value, looks) : value;
    const float either = accumulated + value * (1 - accumulated);
    value = task.reduction == Reduction::sum ? either : value;
  } else {
    value = has_echo & (probability >= task.lowest) ? task.ceiling - looks : 0.0f;
  }
  return value > accumulated ? value : accumulated;
}

/// Adds a radar's echo to a channel's accumulator. Without branches, for SIMD.
/// @param jamming_to_noise  clutter included
/// @param looks  as withDetection()
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
  } else if constexpr (measure == RadarMeasure::detection || measure == RadarMeasure::detection_age) {
    const float probability = task.curve(fastRatioToDb(echo_to_noise / (1 + jamming_to_noise)));
    return withDetection<measure>(task, echo_to_noise > 0, probability, looks, accumulated);
  } else if constexpr (measure == RadarMeasure::root_of_signal_to_clutter_and_noise) {
    value = echo_to_noise_root / std::sqrt(1 + jamming_to_noise);
  }
  return value > accumulated ? value : accumulated;
}

/// The same behind a blanker, which has a task of detection or its age.
/// @param clutter_to_noise  that does not blank
EMSCAPE_HD inline float withBlanked(const RadarTask& task, const BlankedSum& blanked,
                                    float echo_to_noise_root, float clutter_to_noise, float looks,
                                    float accumulated) {
  const float echo_to_noise = echo_to_noise_root * echo_to_noise_root;
  const float probability = task.blanker.probability(blanked, task.curve, clutter_to_noise, echo_to_noise);
  return task.measure == RadarMeasure::detection
             ? withDetection<RadarMeasure::detection>(task, echo_to_noise > 0, probability, looks,
                                                      accumulated)
             : withDetection<RadarMeasure::detection_age>(task, echo_to_noise > 0, probability, looks,
                                                          accumulated);
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

/// True if a pass has no reflected rays, no clutter, no limits of range, no blanker and no ages.
inline bool isPlain(const RadarPass& pass) {
  return !pass.has_reflected_rays && pass.task.clutter.isNone() && !pass.task.heard.isLimited() &&
         pass.task.blanker.isNone() && pass.task.measure != RadarMeasure::detection_age;
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
  const bool blanks = kAny && !task.blanker.isNone();
  BlankedSum blanked;
  for (int n = 0; n < task.jammer_count; ++n) {
    const JammerAtRadar& jammer = task.jammers[n];
    const float received = kAny && jammer.has_reflected_ray
                               ? jammingWeightOfBothRays<kind>(look, pass.beam, jammer, column, t_m)
                               : jammingWeight<kind>(look, pass.beam, jammer, column, t_m);
    if (blanks) {
      task.blanker.add(jammer, received, blanked);
    } else {
      jamming += jammer.boresight_to_noise * received;
    }
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
  pass.accumulator[voxel] = blanks ? withBlanked(task, blanked, root, jamming, looks, pass.accumulator[voxel])
                                   : withRadar(task, root, jamming, looks, pass.accumulator[voxel]);
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
  std::vector<JammerAtRadar> jammers;  ///< those without pauses first
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
