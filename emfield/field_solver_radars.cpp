// Radars that look at targets, and what jams them.

#include <algorithm>

#include "base/units.h"
#include "emfield/field_solver_impl.h"
#include "emfield/radar_receiver.h"

namespace emscape::emfield {

/// Jamming at the radars of channels where it counts. A radar whose jammers changed has changed.
void FieldSolver::Impl::findJamming(const scenario::Snapshot& snapshot, std::vector<bool>& emitter_changed) {
  const std::vector<bool> own = emitter_changed;
  std::vector<bool> done(emitters.size());
  for (const Channel& channel : setup.channels) {
    const bool jammed_anew =
        std::any_of(channel.jammers.begin(), channel.jammers.end(), [&](int j) { return own[j]; });
    for (int e : channel.emitters) {
      EmitterCache& cache = emitters[e];
      if (channel.jammers.empty() || done[e] || !cache.state.active) continue;
      if (!jammed_anew && !cache.mount_changed) continue;
      std::string warning;
      cache.jammers = jammersInSight(snapshot, e, channel.jammers, setup.terrain.get(), setup.resolution,
                                     options.allow_missing_terrain ? &warning : nullptr);
      if (!warning.empty()) warn(warning);
      cache.mount_changed = emitter_changed[e] = done[e] = true;
    }
  }
}

/// Whether a channel holds other values now. Where radars look at targets, it does not matter where their
/// scans have the beams.
bool FieldSolver::Impl::isAffected(const Channel& channel, const ChannelRecipe& recipe,
                                   const std::vector<bool>& emitter_changed) const {
  for (std::size_t i = 0; i < channel.emitters.size(); ++i) {
    const int e = channel.emitters[i];
    const bool looks_at_targets = !recipe.radars.empty() && recipe.radars[i].look.kind != LookKind::held;
    if (looks_at_targets ? emitters[e].mount_changed : emitter_changed[e]) return true;
  }
  return false;
}

/// An emitter's parts in channels that take radars' echoes.
std::vector<RadarShare> FieldSolver::Impl::radarShares(int e) const {
  const scenario::EmitterState& state = emitters[e].state;
  std::vector<RadarShare> shares;
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const Channel& channel = setup.channels[c];
    const auto place = std::find(channel.emitters.begin(), channel.emitters.end(), e);
    if (place == channel.emitters.end() || setup.recipes[c].radars.empty()) continue;
    RadarShare share;
    share.channel = static_cast<int>(c);
    share.task = setup.recipes[c].radars[place - channel.emitters.begin()];
    const bool is_held = share.task.look.kind == LookKind::held;
    const scenario::BeamPose& frame = is_held ? state.beam : state.mount;
    share.task.look.steer_u = static_cast<float>(state.beam.steer_u);
    share.task.look.steer_v = static_cast<float>(state.beam.steer_v);
    share.forward = vecCast<float>(frame.forward);
    share.right = vecCast<float>(frame.right);
    share.up = vecCast<float>(frame.up);
    for (const JammerInSight& jammer : emitters[e].jammers) {
      if (channel.jammers.empty()) break;
      const Vec3d& ray = jammer.direction;
      const double to_noise =
          jammer.power_density_wm2 *
          jammingToNoise_m2_w(setup.scenario->emitters[e], setup.scenario->emitters[jammer.jammer]);
      if (!(to_noise > 0)) continue;
      share.jammers.push_back(
          {vecCast<float>(Vec3d{dot(ray, frame.forward), dot(ray, frame.right), dot(ray, frame.up)}),
           static_cast<float>(to_noise)});
    }
    shares.push_back(std::move(share));
  }
  return shares;
}

}  // namespace emscape::emfield
