#include "emfield/link/path_radar.h"

#include <cmath>
#include <vector>

#include "emfield/link/jammers.h"
#include "emfield/products.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::EmitterKind;
using scenario::Quantity;

class RadarPoint {
 public:
  RadarPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray, double boresight_dbwm2)
      : snapshot_(snapshot),
        scenario_(*snapshot.scenario),
        radar_(radar),
        ray_(ray * (1 / length(ray))),
        boresight_wm2_(dbToRatio(boresight_dbwm2)) {}

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
    const Vec3f direction =
        vecCast<float>(Vec3d{dot(ray_, vecCast<double>(share.forward)),
                             dot(ray_, vecCast<double>(share.right)), dot(ray_, vecCast<double>(share.up))});
    const Aim aim = aimAt(share.task.look, direction);
    const double pattern = amplitude(aim, direction);
    double jamming = 0;
    for (const JammerAtRadar& jammer : share.jammers) {
      const double toward_jammer = amplitude(aim, jammer.direction);
      jamming += static_cast<double>(jammer.boresight_to_noise) * toward_jammer * toward_jammer;
    }
    const double root = static_cast<double>(task.echo_root) * boresight_wm2_ * pattern * pattern;
    return static_cast<double>(
        withRadar(share.task, static_cast<float>(root), static_cast<float>(jamming), 0));
  }

 private:
  double amplitude(const Aim& aim, const Vec3f& direction) const {
    return scenario_.emitters[radar_].antenna->amplitudeTowards(vecCast<double>(turnedBy(aim, direction)),
                                                                static_cast<double>(aim.steer_u),
                                                                static_cast<double>(aim.steer_v));
  }

  const scenario::Snapshot& snapshot_;
  const scenario::Scenario& scenario_;
  int radar_;
  Vec3d ray_;
  double boresight_wm2_;
};

}  // namespace

RadarAtPoint radarAtPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray,
                          double boresight_dbwm2, const scenario::Terrain* terrain) {
  Channel channel;
  channel.emitters = {radar};
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    if (snapshot.scenario->emitters[e].kind == EmitterKind::jammer)
      channel.jammers.push_back(static_cast<int>(e));
  }
  const std::vector<JammerPath> jammers = jammerPaths(snapshot, radar, channel.jammers, terrain, nullptr);
  const RadarPoint point(snapshot, radar, ray, boresight_dbwm2);
  RadarAtPoint result;
  channel.quantity = Quantity::snr_db;
  result.snr_db = 2 * ratioToDb(point.accumulated(channel, {}));
  channel.quantity = Quantity::jammer_to_signal_db;
  const double signal_to_jammer = point.accumulated(channel, jammers);
  const bool is_jammed = signal_to_jammer > 0 && signal_to_jammer < static_cast<double>(RadarTask{}.ceiling);
  result.jammer_to_signal_db = is_jammed ? -ratioToDb(signal_to_jammer) : -HUGE_VAL;
  channel.quantity = Quantity::detection_probability;
  result.detection_probability = point.accumulated(channel, jammers);
  return result;
}

}  // namespace emscape::emfield
