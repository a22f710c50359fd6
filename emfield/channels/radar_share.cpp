#include "emfield/channels/radar_share.h"

#include <algorithm>

#include "emfield/channels/radar_clutter.h"
#include "emfield/radar/receiver.h"

namespace emscape::emfield {

using scenario::EmitterState;

RadarShare radarShare(const scenario::Scenario& scenario, int radar, const EmitterState& state,
                      const RadarTask& task, const std::vector<JammerPath>& jammers) {
  RadarShare share;
  share.task = task;
  const scenario::BeamPose& frame = task.look.kind == LookKind::held ? state.beam : state.mount;
  if (task.look.kind != LookKind::steered) {  // an array is steered to the target
    share.task.look.steer_u = static_cast<float>(state.beam.steer_u);
    share.task.look.steer_v = static_cast<float>(state.beam.steer_v);
  }
  share.forward = vecCast<float>(frame.forward);
  share.right = vecCast<float>(frame.right);
  share.up = vecCast<float>(frame.up);
  share.task.clutter = placedAt(state, scenario, task.clutter);
  const auto inFrame = [&frame](const Vec3d& ray) {
    return vecCast<float>(Vec3d{dot(ray, frame.forward), dot(ray, frame.right), dot(ray, frame.up)});
  };
  for (const JammerPath& jammer : jammers) {
    const double to_noise = jammer.power_density_wm2 *
                            jammingToNoise_m2_w(scenario.emitters[radar], scenario.emitters[jammer.jammer]);
    if (!(to_noise > 0)) continue;
    JammerAtRadar received;
    received.direction = inFrame(jammer.direction);
    received.boresight_to_noise = static_cast<float>(to_noise);
    received.duty = static_cast<float>(scenario.emitters[jammer.jammer].dutyCycle());
    if (const auto& reflected = jammer.reflected) {
      received.has_reflected_ray = true;
      received.reflected = reflected->ray;
      received.reflected_direction = inFrame(reflected->direction);
      received.direct_amplitude = static_cast<float>(reflected->direct_amplitude);
      received.reflected_amplitude = static_cast<float>(reflected->reflected_amplitude);
    }
    share.jammers.push_back(received);
  }
  const auto pulsed = std::stable_partition(share.jammers.begin(), share.jammers.end(),
                                            [](const JammerAtRadar& jammer) { return jammer.duty >= 1; });
  if (!task.blanker.isNone() && share.jammers.end() - pulsed > kMaxPulsedJammers) {
    std::stable_sort(pulsed, share.jammers.end(), [](const JammerAtRadar& a, const JammerAtRadar& b) {
      return a.boresight_to_noise < b.boresight_to_noise;
    });
    std::for_each(pulsed, share.jammers.end() - kMaxPulsedJammers,
                  [](JammerAtRadar& jammer) { jammer.duty = 1; });
  }
  return share;
}

}  // namespace emscape::emfield
