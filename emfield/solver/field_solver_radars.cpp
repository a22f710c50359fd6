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
  const scenario::IntervalSpec& interval = setup.scenario->output.interval;
  std::vector<bool> done(emitters.size());
  for (const Channel& channel : setup.channels) {
    const bool needs_rejamming =
        interval.turns ||  // of the radar's scan: a jammer may begin to radiate in them
        std::any_of(channel.jammers.begin(), channel.jammers.end(), [&](int j) { return jammer_changed[j]; });
    for (int e : channel.emitters) {
      EmitterCache& cache = emitters[e];
      if (channel.jammers.empty() || done[e] || !cache.state.active) continue;
      if (!needs_rejamming && !cache.mount_changed) continue;
      std::string warning;
      cache.jammers = jammerPaths(
          snapshot, e, channel.jammers, setup.terrain.get(), mayLackTerrain() ? &warning : nullptr,
          scenario::intervalDuration_s(interval, setup.scenario->emitters[e].scan, setup.scenario->clock));
      if (!warning.empty()) ++cache.jamming_warnings[warning];
      done[e] = true;
    }
  }
}

/// An emitter's contributions to channels of radar echoes: in an interval, one for each set of jammers that
/// radiate at the same time.
std::vector<RadarShare> FieldSolver::Impl::radarShares(const scenario::Snapshot& snapshot, int e) const {
  const EmitterCache& cache = emitters[e];
  std::vector<RadarShare> shares;
  std::vector<JammedLooks> by_jammers;
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const Channel& channel = setup.channels[c];
    const auto found = std::find(channel.emitters.begin(), channel.emitters.end(), e);
    if (found == channel.emitters.end() || setup.channel_plans[c].radars.empty()) continue;
    const RadarTask& planned = setup.channel_plans[c].radars[found - channel.emitters.begin()];
    const auto add = [&](const IntervalBeam* interval, const std::vector<JammerPath>& jammers) {
      scenario::EmitterState state = cache.state;
      RadarTask task = planned;
      if (interval != nullptr) lookInInterval(*interval, task, state);
      shares.push_back(radarShare(*setup.scenario, e, state, task, jammers));
      shares.back().channel = static_cast<int>(c);
      if (interval != nullptr) shares.back().arcs = interval->looks.arcs;
    };
    const IntervalBeam* const whole = cache.interval ? &*cache.interval : nullptr;
    const bool is_jammed = !channel.jammers.empty() && !cache.jammers.empty();
    // The largest of several sums is not the sum of the largest.
    const bool adds_largest = whole != nullptr && !planned.is_cumulative &&
                              planned.reduction == Reduction::sum && channel.emitters.size() > 1;
    if (!is_jammed || whole == nullptr || adds_largest) {
      add(whole, is_jammed ? cache.jammers : std::vector<JammerPath>{});
      continue;
    }
    if (by_jammers.empty()) by_jammers = looksByJammers(snapshot, e, cache.state, *whole, cache.jammers);
    for (const JammedLooks& looks : by_jammers) {
      add(&looks.beam, looks.jammers);
      if (!planned.is_cumulative && channel.emitters.size() == 1)
        shares.back().task.reduction = Reduction::maximum;  // of the looks of one radar
    }
  }
  return shares;
}

}  // namespace emscape::emfield
