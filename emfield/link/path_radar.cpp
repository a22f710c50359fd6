#include "emfield/link/path_radar.h"

#include <cmath>
#include <optional>
#include <vector>

#include "emfield/channels/products.h"
#include "emfield/channels/radar_clutter.h"
#include "emfield/columns/two_rays.h"
#include "emfield/link/jammers.h"
#include "emfield/link/path_clutter.h"
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
        range_m_(path.geometry.slant_range_m) {}

  /// Accumulated value of a quantity's channel for this radar alone.
  double accumulated(const Channel& channel, const std::vector<JammerPath>& jammers) const {
    RadarTask task;
    const ChannelPlan plan = channelPlan(channel, scenario_);
    if (plan.radars.empty()) {
      task.echo_root = static_cast<float>(echoRoot_m2_w(scenario_.emitters[radar_]));
    } else {
      task = plan.radars.front();
    }
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
    double jamming = 0;
    for (const JammerAtRadar& jammer : share.jammers) {
      const double toward_jammer = amplitude(aim, jammer.direction);
      const double received =
          jammer.has_reflected_ray
              ? ofBothRays(jammer.reflected, static_cast<double>(jammer.direct_amplitude) * toward_jammer,
                           static_cast<double>(jammer.reflected_amplitude) *
                               amplitude(aim, jammer.reflected_direction))
              : toward_jammer * toward_jammer;
      jamming += static_cast<double>(jammer.boresight_to_noise) * received;
    }
    if (!share.task.clutter.isNone()) {
      jamming += static_cast<double>(task.heard.powerOf(static_cast<float>(range_m_)) *
                                     clutter_.toNoise(share.task.clutter, beamOf(share), aim));
    }
    const double root = static_cast<double>(task.echo_root) * boresight_wm2_ * pattern_power *
                        static_cast<double>(task.heard.amplitudeOf(static_cast<float>(range_m_)));
    return static_cast<double>(
        withRadar(share.task, static_cast<float>(root), static_cast<float>(jamming), 1, 0));
  }

  /// Gain of a beam that follows the target towards it, relative to its maximum (dB).
  std::optional<double> lookPattern_db() const {
    RadarTask task;
    task.look = lookOf(scenario_.emitters[radar_], scenario_.output.radar_look);
    if (task.look.kind == LookKind::held) return std::nullopt;
    const RadarShare share = radarShare(scenario_, radar_, snapshot_.emitters[radar_], task, {});
    const Vec3f direction = inAntennaFrame(beamOf(share), vecCast<float>(ray_));
    return 2 * ratioToDb(std::abs(amplitude(aimAt(share.task.look, direction), direction)));
  }

  /// Clutter over noise of a task's kind with the beam as in snr_db and detection.
  double clutterToNoise(const ClutterTask& clutter) const {
    RadarTask task;
    task.look = lookOf(scenario_.emitters[radar_], scenario_.output.radar_look);
    task.clutter = clutter;
    const RadarShare share = radarShare(scenario_, radar_, snapshot_.emitters[radar_], task, {});
    const EmitterBeam beam = beamOf(share);
    return static_cast<double>(clutter_.toNoise(
        share.task.clutter, beam, aimAt(share.task.look, inAntennaFrame(beam, vecCast<float>(ray_)))));
  }

 private:
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

}  // namespace

RadarAtPoint radarAtPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray,
                          const PathBudget& path, const scenario::Terrain* terrain) {
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
  result.snr_db = 2 * ratioToDb(point.accumulated(channel, {}));
  result.look_pattern_db = point.lookPattern_db();
  if (const scenario::Emitter& emitter = snapshot.scenario->emitters[static_cast<std::size_t>(radar)];
      emitter.clutter) {
    result.clutter = clutterAt(point, *snapshot.scenario, emitter);
    channel.quantity = Quantity::sclnr_db;
    result.clutter->sclnr_db = 2 * ratioToDb(point.accumulated(channel, {}));
  }
  channel.quantity = Quantity::jammer_to_signal_db;
  const auto jammerToSignal_db = [&](const std::vector<JammerPath>& by) {
    const double signal_to_jammer = point.accumulated(channel, by);
    const bool is_jammed =
        signal_to_jammer > 0 && signal_to_jammer < static_cast<double>(RadarTask{}.ceiling);
    return is_jammed ? -ratioToDb(signal_to_jammer) : -HUGE_VAL;
  };
  result.jammer_to_signal_db = jammerToSignal_db(jammers);
  double largest_db = -HUGE_VAL;
  for (const JammerPath& jammer : jammers) {
    const double alone_db = jammerToSignal_db({jammer});
    if (std::isinf(alone_db)) continue;
    if (!result.jamming.strongest.empty()) ++result.jamming.others;
    if (alone_db <= largest_db) continue;
    largest_db = alone_db;
    result.jamming.strongest = snapshot.scenario->emitters[static_cast<std::size_t>(jammer.jammer)].name;
  }
  channel.quantity = Quantity::detection_probability;
  result.detection_probability = point.accumulated(channel, jammers);
  result.jamming.unjammed_probability =
      jammers.empty() ? result.detection_probability : point.accumulated(channel, {});
  return result;
}

}  // namespace emscape::emfield
