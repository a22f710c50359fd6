// An update: finds and computes the changes by the time or an edited scenario.

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "base/stopwatch.h"
#include "emfield/solver/field_solver_impl.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

using scenario::EmitterState;

bool samePose(const scenario::BeamPose& a, const scenario::BeamPose& b) {
  return a.forward == b.forward && a.right == b.right && a.up == b.up && a.steer_u == b.steer_u &&
         a.steer_v == b.steer_v;
}

/// True if an emitter's beam is the same as at the last update.
bool sameBeam(const EmitterState& a, const EmitterState& b) {
  if (a.active != b.active) return false;
  if (!a.active) return true;
  return samePose(a.beam, b.beam) && samePose(a.mount, b.mount);
}

double distance_m(const GeodeticPosition& a, const GeodeticPosition& b) {
  return length(toEcef(a) - toEcef(b));
}

bool isAny(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

}  // namespace

/// @param edited  plan of an edited scenario that the engine can use; null: only the time changed
FieldChanged FieldSolver::Impl::update(const scenario::Snapshot& snapshot, std::optional<FieldPlan> edited) {
  engine->resetTimes();
  Stopwatch watch;
  Changes changes;
  changes.is_edited = edited.has_value();
  changes.all = is_first || is_stale;
  changes.report.grid = is_first;
  changes.all_sums = changes.report.channels = changes.all;
  FieldPlan before;
  try {
    if (edited) {
      changes.all_sums = changes.all || !haveSameSums(setup, *edited);
      changes.report.channels = changes.all_sums || !haveSameNames(setup, *edited);
      before = std::exchange(static_cast<FieldPlan&>(setup), std::move(*edited));
      changes.before = &before;
    }
    if (changes.is_edited || is_stale) setEnginePlan(changes.all_sums);
    compute(snapshot, changes);
  } catch (const Stopped&) {
    if (changes.before != nullptr) static_cast<FieldPlan&>(setup) = std::move(before);
    discardResults(true);
    throw;
  } catch (...) {
    if (changes.before != nullptr) static_cast<FieldPlan&>(setup) = std::move(before);
    discardResults(false);
    throw;
  }
  for (volume::Volume& volume : volumes) {
    volume::VolumeInfo info = volume.info();
    info.time_s = snapshot.time_s;
    info.time_utc = snapshot.time_utc;
    volume.setInfo(std::move(info));
  }
  is_first = is_stale = has_other_quantities = false;
  if (!changes.report.moved.empty()) pace.rest_ms = watch.lap_ms() - columns_ms(changes.report.moved);
  return changes.report;
}

void FieldSolver::Impl::setEnginePlan(bool channels_changed) {
  if (channels_changed) static_count = recombined_since = 0;
  engine->planChanged(channels_changed);
}

/// After a failure: the results may belong to either scenario.
/// @param keeps_geometry  the slots of emitters with a geometry are valid; the next update compares the
/// inputs
void FieldSolver::Impl::discardResults(bool keeps_geometry) {
  is_stale = true;
  static_count = recombined_since = 0;
  for (EmitterCache& cache : emitters) {
    EmitterCache kept;
    kept.is_cached = cache.is_cached;
    kept.every_column_ms = cache.every_column_ms;
    if (keeps_geometry && cache.is_cached && cache.geometry) {
      kept.geometry = std::move(cache.geometry);
      kept.geometry_result = std::move(cache.geometry_result);
      kept.warnings = std::move(cache.warnings);
      kept.steep = std::move(cache.steep);
    }
    cache = std::move(kept);
  }
  volumes.resize(setup.channels.size());
  masks.resize(setup.channels.size());
}

void FieldSolver::Impl::compute(const scenario::Snapshot& snapshot, Changes& changes) {
  findMoved(snapshot, changes);
  const bool is_instant = setup.scenario->output.interval.kind == scenario::IntervalKind::instant;
  const double intervals_to = is_instant ? 0 : 0.5;
  {
    const WorkPart part("", 0, intervals_to);
    findIntervals(snapshot);
  }
  findJamming(snapshot, changes);
  findCombined(snapshot, changes);
  findProducts(changes);
  FieldChanged& report = changes.report;
  report.any = changes.all || report.channels || !report.moved.empty() || !report.turned.empty() ||
               !report.volumes.empty();
  if (!report.any && !changes.is_edited) return;

  chooseStep(report.moved);
  std::vector<int> recomputed;
  for (int e : report.moved) {
    if (emitters[e].is_cached) recomputed.push_back(e);
  }
  constexpr double kGeometryTo = 0.95;
  const double combine_from = recomputed.empty() ? intervals_to : kGeometryTo;
  {
    const WorkPart part("", intervals_to, combine_from);
    computeGeometry(recomputed, false);
  }
  const WorkPart part("sums of the emitters", combine_from, 1);
  if (isAny(changes.sums)) {
    chooseResting(changes.emitters);
    combine(static_count, static_cast<int>(emitters.size()), changes.sums, false);
  }
  checkpoint();
  makeVolumes(snapshot, changes);
}

/// Finds the emitters whose geometry must be computed, and those whose beam or activity changed.
void FieldSolver::Impl::findMoved(const scenario::Snapshot& snapshot, Changes& changes) {
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const EmitterState& now = snapshot.emitters[e];
    EmitterCache& cache = emitters[e];
    if ((changes.is_edited || changes.all) && cache.geometry &&
        !areSame(*cache.geometry, geometryInputs(setup, static_cast<int>(e), now))) {
      cache.geometry.reset();
      cache.geometry_result = {};
      cache.warnings.clear();
      cache.steep = {};
    }
    const bool is_renamed = changes.before != nullptr &&
                            changes.before->scenario->emitters[e].name != setup.scenario->emitters[e].name;
    if (is_renamed && cache.geometry) {
      cache.warnings.clear();
      noteWarnings(static_cast<int>(e));
    }
    const bool has_geometry = setup.needs[e].any;
    const bool is_completed = pace.goal_ms == 0 && cache.geometry_result.column_step > 1;
    const bool has_moved = now.active && has_geometry &&
                           (!cache.geometry || is_completed ||
                            distance_m(now.position, cache.geometry->position) > options.move_tolerance_m);
    const bool is_elsewhere =
        now.active && !has_geometry && distance_m(now.position, cache.state.position) > 0;
    if (has_moved) {
      changes.report.moved.push_back(static_cast<int>(e));
    } else if (changes.all || is_elsewhere || !sameBeam(now, cache.state)) {
      changes.report.turned.push_back(static_cast<int>(e));
    }
    cache.mount_changed = changes.all || has_moved || now.active != cache.state.active ||
                          !samePose(now.mount, cache.state.mount);
    cache.state = now;
  }
}

/// Finds the beams over the interval of the output.
void FieldSolver::Impl::findIntervals(const scenario::Snapshot& snapshot) {
  const bool is_instant = setup.scenario->output.interval.kind == scenario::IntervalKind::instant;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    EmitterCache& cache = emitters[e];
    const std::optional<IntervalBeam> before = std::exchange(cache.interval, std::nullopt);
    if (is_instant || !cache.state.active) continue;
    bool needs_pattern = false;
    for (std::size_t c = 0; c < setup.channels.size(); ++c) {
      const std::vector<int>& members = setup.channels[c].emitters;
      needs_pattern = needs_pattern || (setup.channel_plans[c].reducesPower() &&
                                        std::count(members.begin(), members.end(), static_cast<int>(e)) > 0);
    }
    const scenario::Emitter emitter = whilePresent(snapshot, setup.scenario->emitters[e]);
    const auto count = static_cast<double>(emitters.size()), number = static_cast<double>(e);
    const WorkPart part(fmt::format("'{}' over the interval, {} of {}", emitter.name, e + 1, emitters.size()),
                        number / count, (number + 1) / count);
    cache.interval = intervalBeam(*setup.scenario, emitter, cache.state, snapshot.time_s, needs_pattern,
                                  before ? &*before : nullptr);
  }
}

/// Finds the emitters whose contribution to some channel changed, and those channels.
void FieldSolver::Impl::findCombined(const scenario::Snapshot& snapshot, Changes& changes) {
  FieldChanged& report = changes.report;
  changes.emitters.assign(emitters.size(), changes.all_sums);
  changes.sums.assign(setup.channels.size(), changes.all_sums);
  std::vector<bool> reported(emitters.size());
  for (const std::vector<int>* list : {&report.moved, &report.turned}) {
    for (int e : *list) reported[e] = true;
  }
  std::vector<bool> moved(emitters.size());
  for (int e : report.moved) moved[e] = true;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    std::optional<CombinePass::Member> before = std::exchange(emitters[e].combined, std::nullopt);
    if (emitters[e].state.active) emitters[e].combined = combineMember(snapshot, static_cast<int>(e));
    const auto orNull = [](const std::optional<CombinePass::Member>& member) {
      return member ? &*member : nullptr;
    };
    const bool has_changed =
        markChangedChannels(moved[e] ? nullptr : orNull(before), orNull(emitters[e].combined), changes.sums);
    if (!has_changed) continue;
    changes.emitters[e] = true;
    if (changes.is_edited && !reported[e]) report.turned.push_back(static_cast<int>(e));
  }
  std::sort(report.turned.begin(), report.turned.end());
}

/// Finds the channels whose volume must be made.
void FieldSolver::Impl::findProducts(Changes& changes) {
  changes.products = changes.sums;
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    if (changes.is_edited && !changes.products[c]) {
      changes.products[c] =
          !areSame(changes.before->channel_plans[c].product, setup.channel_plans[c].product);
    }
    if (changes.products[c]) changes.report.volumes.push_back(static_cast<int>(c));
  }
}

}  // namespace emscape::emfield
