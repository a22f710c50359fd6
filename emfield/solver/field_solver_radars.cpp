// Radars that look at targets, and their jammers.

#include <algorithm>

#include "emfield/solver/field_solver_impl.h"

namespace emscape::emfield {

/// Updates the jamming at the radars of channels that depend on it: for radars that changed or whose jammers
/// changed; after an edit for all radars, because paths depend on many values of a scenario.
void FieldSolver::Impl::findJamming(const scenario::Snapshot& snapshot, const Changes& changes) {
  std::vector<bool> jammer_changed(emitters.size(), changes.all || changes.is_edited);
  for (const std::vector<int>* list : {&changes.report.moved, &changes.report.turned}) {
    for (int e : *list) jammer_changed[e] = true;
  }
  if (changes.is_edited) {
    for (EmitterCache& cache : emitters) cache.jamming_warnings.clear();
  }
  std::vector<bool> done(emitters.size());
  for (const Channel& channel : setup.channels) {
    const bool needs_rejamming =
        std::any_of(channel.jammers.begin(), channel.jammers.end(), [&](int j) { return jammer_changed[j]; });
    for (int e : channel.emitters) {
      EmitterCache& cache = emitters[e];
      if (channel.jammers.empty() || done[e] || !cache.state.active) continue;
      if (!needs_rejamming && !cache.mount_changed) continue;
      std::string warning;
      cache.jammers = jammerPaths(snapshot, e, channel.jammers, setup.terrain.get(),
                                  mayLackTerrain() ? &warning : nullptr);
      if (!warning.empty()) ++cache.jamming_warnings[warning];
      done[e] = true;
    }
  }
}

/// An emitter's contributions to channels of radar echoes.
std::vector<RadarShare> FieldSolver::Impl::radarShares(int e) const {
  std::vector<RadarShare> shares;
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const Channel& channel = setup.channels[c];
    const auto found = std::find(channel.emitters.begin(), channel.emitters.end(), e);
    if (found == channel.emitters.end() || setup.channel_plans[c].radars.empty()) continue;
    scenario::EmitterState state = emitters[e].state;
    RadarTask task = setup.channel_plans[c].radars[found - channel.emitters.begin()];
    if (emitters[e].interval) lookInInterval(*emitters[e].interval, task, state);
    const std::vector<JammerPath> none;
    shares.push_back(
        radarShare(*setup.scenario, e, state, task, channel.jammers.empty() ? none : emitters[e].jammers));
    shares.back().channel = static_cast<int>(c);
    if (emitters[e].interval) shares.back().arcs = emitters[e].interval->looks.arcs;
  }
  return shares;
}

}  // namespace emscape::emfield
