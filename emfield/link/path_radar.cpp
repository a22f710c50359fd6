#include "emfield/link/path_radar.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "emfield/channels/products.h"
#include "emfield/channels/radar_clutter.h"
#include "emfield/columns/two_rays.h"
#include "emfield/link/jammers.h"
#include "emfield/link/path_clutter.h"
#include "emfield/link/path_decision.h"
#include "emfield/link/path_verdict.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::EmitterKind;
using scenario::Quantity;

class RadarPoint {
 public:
  RadarPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray, const PathBudget& path,
             const scenario::Terrain* terrain)
      : clutter_(snapshot, radar, path.geometry.slant_range_m, terrain),
        snapshot_(snapshot),
        scenario_(*snapshot.scenario),
        radar_(radar),
        ray_(ray * (1 / length(ray))),
        reflection_(path.excess.reflection),
        boresight_wm2_(dbToRatio(path.boresight_dbwm2)),
        range_m_(path.geometry.slant_range_m),
        curve_(detectionCurveOf(scenario_.emitters[radar])) {}

  /// What is taken away from a path.
  struct Without {
    double loss_db = 0;  ///< of the echo, there and back
    bool clutter = false, range_limits = false;
  };

  /// Accumulated value of a quantity's channel for this radar alone.
  /// @param open  null, or receives the part of the radar's pulses that are not blanked
  double accumulated(const Channel& channel, const std::vector<JammerPath>& jammers, const Without& without,
                     double* open = nullptr) const {
    RadarTask task;
    const ChannelPlan plan = channelPlan(channel, scenario_);
    if (plan.radars.empty()) {
      task.echo_root = static_cast<float>(echoRoot_m2_w(scenario_.emitters[radar_]));
    } else {
      task = plan.radars.front();
    }
    if (without.range_limits) task.heard = {};
    if (without.clutter) task.clutter = {};
    const RadarShare share = radarShare(scenario_, radar_, snapshot_.emitters[radar_], task, jammers);
    const auto inFrame = [&share](const Vec3d& ray) {
      return vecCast<float>(Vec3d{dot(ray, vecCast<double>(share.forward)),
                                  dot(ray, vecCast<double>(share.right)),
                                  dot(ray, vecCast<double>(share.up))});
    };
    const Vec3f direction = inFrame(ray_);
    const Aim aim = aimAt(share.task.look, direction);
    const double pattern = amplitude(aim, direction);
    double pattern_power = pattern * pattern;
    if (reflection_) {
      const Vec3f below = reflectedDirection(vecCast<float>(ray_), reflection_->depression_sine);
      pattern_power = ofBothRays(*reflection_, pattern, amplitude(aim, inFrame(vecCast<double>(below))));
    }
    const double root = static_cast<double>(task.echo_root) * boresight_wm2_ * pattern_power *
                        static_cast<double>(task.heard.amplitudeOf(static_cast<float>(range_m_))) *
                        std::sqrt(dbToRatio(without.loss_db));
    double jamming = 0;
    const bool blanks = !task.blanker.isNone();
    BlankedSum blanked;
    for (const JammerAtRadar& jammer : share.jammers) {
      const double toward_jammer = amplitude(aim, jammer.direction);
      const double received =
          jammer.has_reflected_ray
              ? ofBothRays(jammer.reflected, static_cast<double>(jammer.direct_amplitude) * toward_jammer,
                           static_cast<double>(jammer.reflected_amplitude) *
                               amplitude(aim, jammer.reflected_direction))
              : toward_jammer * toward_jammer;
      if (blanks) {
        task.blanker.add(jammer, static_cast<float>(received), blanked);
      } else {
        jamming += static_cast<double>(jammer.boresight_to_noise) * received;
      }
    }
    if (!share.task.clutter.isNone()) {
      jamming += static_cast<double>(task.heard.powerOf(static_cast<float>(range_m_)) *
                                     clutter_.toNoise(share.task.clutter, beamOf(share), aim));
    }
    const auto echo = static_cast<float>(root), noise = static_cast<float>(jamming);
    // Of a blanker's radar the noise is the clutter alone.
    if (open != nullptr && blanks)
      *open = static_cast<double>(task.blanker.openPart(blanked, noise, echo * echo));
    return static_cast<double>(blanks ? withBlanked(share.task, blanked, echo, noise, 1, 0)
                                      : withRadar(share.task, echo, noise, 1, 0));
  }

  /// Gain of a beam that follows the target towards it, relative to its maximum (dB). So does that of a scan
  /// over an interval, at its best moment.
  std::optional<double> lookPattern_db() const {
    RadarTask task;
    task.look = look();
    if (task.look.kind == LookKind::held) return std::nullopt;
    const RadarShare share = radarShare(scenario_, radar_, snapshot_.emitters[radar_], task, {});
    const Vec3f direction = inAntennaFrame(beamOf(share), vecCast<float>(ray_));
    return 2 * ratioToDb(std::abs(amplitude(aimAt(share.task.look, direction), direction)));
  }

  /// Clutter over noise of a task's kind with the beam as in snr_db and detection.
  double clutterToNoise(const ClutterTask& clutter) const {
    RadarTask task;
    task.look = look();
    task.clutter = clutter;
    const RadarShare share = radarShare(scenario_, radar_, snapshot_.emitters[radar_], task, {});
    const EmitterBeam beam = beamOf(share);
    return static_cast<double>(clutter_.toNoise(
        share.task.clutter, beam, aimAt(share.task.look, inAntennaFrame(beam, vecCast<float>(ray_)))));
  }

 private:
  /// That of snr_db and detection.
  RadarLook look() const {
    const auto& output = scenario_.output;
    const bool is_instant = output.interval.kind == scenario::IntervalKind::instant;
    return lookOf(scenario_.emitters[radar_], is_instant ? output.radar_look : scenario::RadarAim::target);
  }
  EmitterBeam beamOf(const RadarShare& share) const {
    EmitterBeam beam;
    beam.pattern = scenario_.emitters[radar_].antenna->view();
    beam.forward = share.forward;
    beam.right = share.right;
    beam.up = share.up;
    return beam;
  }

  double amplitude(const Aim& aim, const Vec3f& direction) const {
    return scenario_.emitters[radar_].antenna->signedAmplitudeTowards(
        vecCast<double>(turnedBy(aim, direction)), static_cast<double>(aim.steer_u),
        static_cast<double>(aim.steer_v));
  }
  static double ofBothRays(const ReflectedRay& ray, double direct, double reflected) {
    return static_cast<double>(
        powerOfBothRays(ray, static_cast<float>(direct), static_cast<float>(reflected)));
  }

  PathClutter clutter_;
  const scenario::Snapshot& snapshot_;
  const scenario::Scenario& scenario_;
  int radar_;
  Vec3d ray_;
  std::optional<propagation::PathReflection> reflection_;
  double boresight_wm2_;
  double range_m_;
  std::shared_ptr<const DetectionCurve> curve_;  ///< held, so that accumulated() does not compute it again
};

RadarAtPoint::Clutter clutterAt(const RadarPoint& point, const scenario::Scenario& scenario,
                                const scenario::Emitter& radar) {
  RadarAtPoint::Clutter clutter;
  scenario::Emitter unfiltered = radar;
  unfiltered.clutter->mti.reset();
  ClutterTask surface = clutterTask(scenario, unfiltered), rain = surface;
  surface.rain = rain.surface = 0;
  clutter.surface_to_noise_db = ratioToDb(point.clutterToNoise(surface));
  clutter.rain_to_noise_db = ratioToDb(point.clutterToNoise(rain));
  clutter.surface_improvement_db = ratioToDb(surfaceImprovement(radar));
  clutter.rain_improvement_db = ratioToDb(rainImprovement(radar));
  clutter.response_db = ratioToDb(filterResponse(radar));
  return clutter;
}

/// The gain (dB) with which a probability that rises with it is kDetected; empty: none up to 200 dB.
template <class Probability>
std::optional<double> missing_db(const Probability& probabilityWith) {
  constexpr double kPrecision_db = 0.01;
  double low = 0, high = 200;
  if (probabilityWith(high) < kDetected) return std::nullopt;
  while (high - low > kPrecision_db) {
    const double middle = (low + high) / 2;
    (probabilityWith(middle) < kDetected ? low : high) = middle;
  }
  return high;
}

}  // namespace

bool isFixed(const scenario::Emitter& radar) {
  return lookOf(radar, scenario::RadarAim::target).kind == LookKind::held;
}

RadarAtPoint radarAtPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray,
                          const PathBudget& path, const scenario::Terrain* terrain) {
  using Without = RadarPoint::Without;
  Channel channel;
  channel.emitters = {radar};
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    if (snapshot.scenario->emitters[e].kind == EmitterKind::jammer)
      channel.jammers.push_back(static_cast<int>(e));
  }
  const std::vector<JammerPath> jammers = jammerPaths(snapshot, radar, channel.jammers, terrain, nullptr);
  const RadarPoint point(snapshot, radar, ray, path, terrain);
  RadarAtPoint result;
  channel.quantity = Quantity::snr_db;
  result.snr_db = 2 * ratioToDb(point.accumulated(channel, {}, {}));
  const scenario::Emitter& emitter = snapshot.scenario->emitters[static_cast<std::size_t>(radar)];
  result.look_pattern_db = point.lookPattern_db();
  if (emitter.clutter) {
    result.clutter = clutterAt(point, *snapshot.scenario, emitter);
    channel.quantity = Quantity::sclnr_db;
    result.clutter->sclnr_db = 2 * ratioToDb(point.accumulated(channel, {}, {}));
  }
  channel.quantity = Quantity::jammer_to_signal_db;
  const auto jammerToSignal_db = [&](const std::vector<JammerPath>& by) {
    const double signal_to_jammer = point.accumulated(channel, by, {});
    const bool is_jammed =
        signal_to_jammer > 0 && signal_to_jammer < static_cast<double>(RadarTask{}.ceiling);
    return is_jammed ? -ratioToDb(signal_to_jammer) : -HUGE_VAL;
  };
  result.jammer_to_signal_db = jammerToSignal_db(jammers);
  std::vector<PathJammer>& each = result.jamming.jammers;
  const auto detection = [&](const std::vector<JammerPath>& by, const Without& without,
                             double* open = nullptr) {
    channel.quantity = Quantity::detection_probability;
    return point.accumulated(channel, by, without, open);
  };
  for (const JammerPath& jammer : jammers) {
    channel.quantity = Quantity::jammer_to_signal_db;
    const double alone_db = jammerToSignal_db({jammer});
    if (std::isinf(alone_db)) continue;
    const scenario::Emitter& of = snapshot.scenario->emitters[static_cast<std::size_t>(jammer.jammer)];
    each.push_back({of.name, alone_db});
    if (emitter.receiver.side_lobe_blanking) {
      double open = 1;
      detection({jammer}, {}, &open);
      constexpr double kRounding = 1e-6;
      each.back().blanked_part = 1 - open < kRounding ? 0 : (1 - open) / of.dutyCycle();
    }
    std::vector<JammerPath> others = jammers;
    others.erase(others.begin() + (&jammer - jammers.data()));
    each.back().probability_without = detection(others, {});
  }
  std::stable_sort(each.begin(), each.end(),
                   [](const PathJammer& a, const PathJammer& b) { return a.to_signal_db > b.to_signal_db; });
  result.detection_probability = detection(jammers, {});
  const bool is_limited = emitter.waveform && emitter.waveform->limits_detection;
  const auto inAnyRange = [&](const std::vector<JammerPath>& by) { return detection(by, {0, false, true}); };
  result.probability_in_any_range = is_limited ? inAnyRange(jammers) : result.detection_probability;
  result.jamming.unjammed_probability = jammers.empty() ? result.detection_probability : detection({}, {});
  result.jamming.unjammed_in_any_range = is_limited ? inAnyRange({}) : result.jamming.unjammed_probability;
  if (each.empty() || result.detection_probability >= kDetected) return result;
  const auto losses = lossesOf(path.excess, result.look_pattern_db.value_or(path.pointing.pattern_db), 2);
  const auto without = [&](double loss_db) { return detection(jammers, {loss_db, true, true}); };
  result.jamming.without_clutter = {without(0), without(losses[0].gain_db), without(losses[1].gain_db),
                                    without(losses[2].gain_db)};
  result.jamming.missing_db = missing_db(without);
  return result;
}

}  // namespace emscape::emfield
