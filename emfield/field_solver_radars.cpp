// Radars that look at targets, and what jams them.

#include <algorithm>

#include "emfield/field_solver_impl.h"
#include "emfield/radar_receiver.h"
#include "emscape/base/units.h"

namespace emscape::emfield {

/// Jamming at the radars of channels where it counts. A radar whose jammers changed has changed.
void FieldSolver::Impl::findJamming(const scenario::Snapshot& snapshot, std::vector<bool>& emitter_changed) {
  std::vector<bool> done(emitters.size());
  for (const Channel& channel : setup.channels) {
    const bool jammed_anew = std::any_of(channel.jammers.begin(), channel.jammers.end(),
                                         [&](int j) { return emitter_changed[j]; });
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
    const RadarTask& task = setup.recipes[c].radars[place - channel.emitters.begin()];
    const std::vector<JammerInSight> none;
    shares.push_back(
        radarShare(*setup.scenario, e, state, task, channel.jammers.empty() ? none : emitters[e].jammers));
    shares.back().channel = static_cast<int>(c);
  }
  return shares;
}

}  // namespace emscape::emfield
