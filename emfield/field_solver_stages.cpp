// The stages of an update: geometry, combine, volumes.

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "emfield/combine.h"
#include "emfield/field_solver_impl.h"
#include "emfield/models/horizon.h"

namespace emscape::emfield {

using scenario::Emitter;
using scenario::EmitterState;
using scenario::PropagationModel;

void FieldSolver::Impl::computeGeometry(int e, const EmitterState& state, EmitterGeometry& geometry) {
  EmitterGeometry::Times spent;
  const Emitter& emitter = scenario->emitters[e];
  geometry.compute(state, emitter.propagation, scenario->atmosphere.k_factor, columns, terrain.get(),
                   resolution, spent);
  times.fan_ms += spent.fan_ms;
  times.plane_ms += spent.plane_ms;

  EmitterCache& cache = emitters[e];
  cache.computed_at = state.position;
  cache.has_geometry = true;
  cache.unknown_columns.clear();
  if (geometry.unknownColumns() > 0) {
    cache.unknown_columns.resize(columns.columns.size());
    for (std::size_t c = 0; c < cache.unknown_columns.size(); ++c)
      cache.unknown_columns[c] = geometry.isUnknown(c);
    if (!options.allow_missing_terrain) {
      const auto first = std::find(cache.unknown_columns.begin(), cache.unknown_columns.end(), true);
      throw Error(ErrorCode::bad_input, {scenario->file},
                  fmt::format("emitter '{}': the path to {} and to {} more columns crosses missing terrain "
                              "(--allow-missing-terrain draws holes)",
                              emitter.name, placeOf(first - cache.unknown_columns.begin()),
                              geometry.unknownColumns() - 1));
    }
    warn(fmt::format("emitter '{}': columns seen across missing terrain hold no field", emitter.name));
  }
  if (emitter.propagation == PropagationModel::horizon &&
      std::max<double>(state.height_msl_m, columns.t_m.back()) > kLinearRefractivityHeight_m) {
    warn(fmt::format(
        "emitter '{}': 'horizon' takes refractivity as linear in height, which does not hold above {:.0f} m",
        emitter.name, kLinearRefractivityHeight_m));
  }
  countNearField(e, geometry);
}

void FieldSolver::Impl::countNearField(int e, const EmitterGeometry& geometry) {
  EmitterCache& cache = emitters[e];
  const ColumnGeometryView view = geometry.view();
  const float limit2 = static_cast<float>(cache.far_field_m * cache.far_field_m);
  cache.near_voxels = 0;
  for (std::size_t c = 0; c < columns.columns.size(); ++c) {
    if (view.offset2_m2[c] >= limit2) continue;
    cache.near_voxels += std::count_if(columns.t_m.begin(), columns.t_m.end(), [&](float t_m) {
      const float along_m = t_m - view.nearest_t_m[c];
      return view.offset2_m2[c] + along_m * along_m < limit2;
    });
  }
  if (cache.near_voxels > 0) {
    warn(
        fmt::format("emitter '{}': voxels nearer than its far field (2 D^2 / lambda = {:.0f} m) hold the far "
                    "field's formula",
                    scenario->emitters[e].name, cache.far_field_m));
  }
}

/// Emitters that do not change are summed once. The set is chosen anew when one of them changed, or when the
/// emitters combined in vain since the last choice would have paid for a new one.
void FieldSolver::Impl::chooseResting(const std::vector<bool>& changed) {
  const int count = static_cast<int>(emitters.size());
  const int changed_count = static_cast<int>(std::count(changed.begin(), changed.end(), true));
  const int resting_count = static_cast<int>(std::count(resting.begin(), resting.end(), true));
  bool is_valid = !is_first;
  for (int e = 0; e < count && is_valid; ++e) is_valid = !(changed[e] && resting[e]);
  wasted += count - resting_count - changed_count;
  if (is_valid && wasted < count - changed_count) return;
  if (is_valid && resting_count == count - changed_count) return;

  wasted = 0;
  resting = changed;
  resting.flip();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    ChannelState& state = channel_states[c];
    const auto& members = channels[c].emitters;
    const bool has_resting = std::any_of(members.begin(), members.end(), [&](int e) { return resting[e]; });
    const std::size_t size = has_resting ? static_cast<std::size_t>(grid.dims.count()) : 0;
    state.resting_value.resize(size);
    state.resting_largest.resize(state.recipe.reduction == Reduction::dominant ? size : 0);
    if (!has_resting) {
      state.resting_value.shrink_to_fit();
      state.resting_largest.shrink_to_fit();
    }
  }
  std::vector<int> chosen;
  for (int e = 0; e < count; ++e) {
    if (resting[e]) chosen.push_back(e);
  }
  if (!chosen.empty()) combine(chosen, std::vector<bool>(channels.size(), true), true);
}

CombineEmitter FieldSolver::Impl::combineEmitter(int e, const EmitterGeometry& geometry) const {
  const Emitter& emitter = scenario->emitters[e];
  const EmitterState& state = emitters[e].state;
  CombineEmitter result;
  result.emitter_index = e;
  result.beam.geometry = geometry.view();
  result.beam.pattern = emitter.antenna->view();
  result.beam.forward = vecCast<float>(state.beam.forward);
  result.beam.right = vecCast<float>(state.beam.right);
  result.beam.up = vecCast<float>(state.beam.up);
  result.beam.steer_u = static_cast<float>(state.beam.steer_u);
  result.beam.steer_v = static_cast<float>(state.beam.steer_v);
  const double eirp_w = emitter.power_w * dbToRatio(emitter.antenna->gain_dbi - emitter.losses_db);
  result.beam.eirp_over_4pi_w = static_cast<float>(eirp_w / (4 * kPi));
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto& members = channels[c].emitters;
    const auto place = std::find(members.begin(), members.end(), e);
    if (place == members.end()) continue;
    result.shares.push_back({static_cast<int>(c), channel_states[c].recipe.weights[place - members.begin()]});
  }
  return result;
}

/// Combines the chosen emitters: those that are cached in one pass over the grid, each of the others in a
/// pass of its own.
void FieldSolver::Impl::combine(const std::vector<int>& chosen, const std::vector<bool>& channel_chosen,
                                bool into_resting) {
  CombineTask task;
  task.dims = grid.dims;
  task.t_m = columns.t_m.data();
  task.first_row_k = first_row_k.empty() ? nullptr : first_row_k.data();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    ChannelState& state = channel_states[c];
    auto& value = into_resting ? state.resting_value : state.value;
    auto& largest = into_resting ? state.resting_largest : state.largest;
    task.reductions.push_back(state.recipe.reduction);
    const bool is_used = channel_chosen[c] && !value.empty();
    task.accumulators.push_back(
        is_used ? Accumulator{value.data(), largest.empty() ? nullptr : largest.data()} : Accumulator{});
    task.initial.push_back(
        into_resting || !state.hasResting()
            ? ConstAccumulator{}
            : ConstAccumulator{state.resting_value.data(),
                               state.resting_largest.empty() ? nullptr : state.resting_largest.data()});
  }

  std::vector<int> uncached;
  for (int e : chosen) {
    if (!emitters[e].state.active) continue;
    if (emitters[e].is_cached) {
      task.emitters.push_back(combineEmitter(e, emitters[e].geometry));
    } else {
      uncached.push_back(e);
    }
  }
  Stopwatch watch;
  combineCpu(task);
  times.combine_ms += watch.lap_ms();
  task.keep = true;
  for (int e : uncached) {
    computeGeometry(e, emitters[e].state, scratch);
    watch.lap_ms();
    task.emitters = {combineEmitter(e, scratch)};
    combineCpu(task);
    times.combine_ms += watch.lap_ms();
  }
}

std::shared_ptr<volume::DenseVolume> FieldSolver::Impl::freeVolume(ChannelState& state) const {
  for (const auto& candidate : state.pool) {
    if (candidate.use_count() == 1) return candidate;
  }
  state.pool.push_back(std::make_shared<volume::DenseVolume>());
  state.pool.back()->grid = grid;
  state.pool.back()->values.resize(static_cast<std::size_t>(grid.dims.count()));
  return state.pool.back();
}

void FieldSolver::Impl::maskUnknown(const Channel& channel, std::vector<std::uint16_t>& first_valid_k) const {
  first_valid_k = columns.first_valid_k;
  for (int e : channel.emitters) {
    const std::vector<bool>& unknown = emitters[e].unknown_columns;
    if (!emitters[e].state.active || unknown.empty()) continue;
    first_valid_k.resize(columns.columns.size(), 0);
    for (std::size_t c = 0; c < unknown.size(); ++c) {
      if (unknown[c]) first_valid_k[c] = static_cast<std::uint16_t>(grid.dims.z);
    }
  }
}

void FieldSolver::Impl::makeVolume(std::size_t c, const scenario::Snapshot& snapshot) {
  ChannelState& state = channel_states[c];
  const Channel& channel = channels[c];
  const QuantityInfo& quantity = info(channel.quantity);
  volumes[c].reset();
  std::shared_ptr<volume::DenseVolume> volume = freeVolume(state);
  maskUnknown(channel, volume->first_valid_k);

  ProductTask task;
  task.dims = grid.dims;
  task.product = state.recipe.product;
  task.accumulator = state.value.data();
  task.first_valid_k = volume->first_valid_k.empty() ? nullptr : volume->first_valid_k.data();
  task.values = volume->values.data();
  const ValueRange range = productCpu(task);

  volume::VolumeInfo& out = volume->info;
  out = {};
  out.quantity = channel.name;
  out.unit = quantity.unit;
  out.time_s = snapshot.time_s;
  out.time_utc = snapshot.time_utc;
  out.floor = state.recipe.product.floor;
  out.range_min = range.lowest <= range.highest ? range.lowest : out.floor;
  out.range_max = range.lowest <= range.highest ? range.highest : out.floor;
  out.categorical = quantity.categorical;
  out.extra["scenario"] = scenario->name;
  out.extra["scenario_hash"] = scenario->hash;
  std::string names, near_field;
  for (int e : channel.emitters) {
    const EmitterCache& cache = emitters[e];
    if (cache.state.active && cache.near_voxels > 0) {
      near_field += fmt::format("{}{}: {} voxels within {:.0f} m", near_field.empty() ? "" : "; ",
                                scenario->emitters[e].name, cache.near_voxels, cache.far_field_m);
    }
  }
  if (!near_field.empty()) out.extra["near_field"] = near_field;
  if (quantity.categorical) {
    for (const Emitter& emitter : scenario->emitters) names += (names.empty() ? "" : "\n") + emitter.name;
    out.extra["labels"] = names;
  }
  volumes[c] = volume;
}

}  // namespace emscape::emfield
