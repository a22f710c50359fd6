// The stages of an update: geometry, combine, volumes.

#include <fmt/format.h>

#include <algorithm>

#include "emfield/excess/excess_model.h"
#include "emfield/field_solver_impl.h"
#include "emfield/model_check.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"

namespace emscape::emfield {

using scenario::Emitter;
using scenario::EmitterState;

/// Computes the geometry of some emitters, into their own slots or into that of emitters that are not cached.
void FieldSolver::Impl::computeGeometry(const std::vector<int>& chosen, bool into_scratch) {
  if (chosen.empty()) return;
  std::vector<GeometryRequest> requests;
  for (int e : chosen) {
    requests.push_back({e, into_scratch ? static_cast<int>(emitters.size()) : e, emitters[e].state});
  }
  std::vector<GeometryFindings> findings = engine->computeGeometry(requests);
  for (std::size_t i = 0; i < chosen.size(); ++i) takeFindings(chosen[i], std::move(findings[i]));
}

void FieldSolver::Impl::takeFindings(int e, GeometryFindings found) {
  const Emitter& emitter = setup.scenario->emitters[e];
  EmitterCache& cache = emitters[e];
  cache.computed_at = cache.state.position;
  cache.has_geometry = true;
  cache.findings = std::move(found);
  const GeometryFindings& findings = cache.findings;
  if (findings.unknown_columns > 0) {
    if (!options.allow_missing_terrain) {
      const auto first = std::find(findings.unknown.begin(), findings.unknown.end(), true);
      throw Error(
          ErrorCode::bad_input, {setup.scenario->file},
          fmt::format("emitter '{}': the path to {} and to {} more columns crosses missing terrain "
                      "(--allow-missing-terrain draws holes)",
                      emitter.name, placeOf(static_cast<std::size_t>(first - findings.unknown.begin())),
                      findings.unknown_columns - 1));
    }
    warn(fmt::format("emitter '{}': columns seen across missing terrain hold no field", emitter.name));
  }
  const Station station =
      makeStation(cache.state.position, cache.state.height_msl_m, setup.scenario->atmosphere.k_factor);
  for (const std::string& warning :
       pathWarnings(*setup.scenario, emitter, cache.state, pathExtent(station, setup.columns),
                    setup.terrain.get(), findings.remarks)) {
    warn(warning);
  }
  if (findings.near_voxels > 0) {
    warn(
        fmt::format("emitter '{}': voxels nearer than its far field (2 D^2 / lambda = {:.0f} m) hold the far "
                    "field's formula",
                    emitter.name, setup.far_field_m[e]));
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
  std::vector<bool> has_resting;
  for (const Channel& channel : setup.channels) {
    has_resting.push_back(
        std::any_of(channel.emitters.begin(), channel.emitters.end(), [&](int e) { return resting[e]; }));
  }
  engine->setResting(has_resting);
  std::vector<int> chosen;
  for (int e = 0; e < count; ++e) {
    if (resting[e]) chosen.push_back(e);
  }
  if (!chosen.empty()) combine(chosen, has_resting, true);
}

CombineEmitter FieldSolver::Impl::combineEmitter(int e) const {
  const Emitter& emitter = setup.scenario->emitters[e];
  const EmitterState& state = emitters[e].state;
  CombineEmitter result;
  result.emitter_index = e;
  result.beam.forward = vecCast<float>(state.beam.forward);
  result.beam.right = vecCast<float>(state.beam.right);
  result.beam.up = vecCast<float>(state.beam.up);
  result.beam.steer_u = static_cast<float>(state.beam.steer_u);
  result.beam.steer_v = static_cast<float>(state.beam.steer_v);
  const double eirp_w = emitter.power_w * dbToRatio(emitter.antenna->gain_dbi - emitter.losses_db);
  result.beam.eirp_over_4pi_w = static_cast<float>(eirp_w / (4 * kPi));
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const auto& members = setup.channels[c].emitters;
    const auto place = std::find(members.begin(), members.end(), e);
    if (place == members.end() || !setup.recipes[c].radars.empty()) continue;
    result.shares.push_back({static_cast<int>(c), setup.recipes[c].weights[place - members.begin()]});
  }
  return result;
}

/// Combines the chosen emitters: those that are cached in one pass over the grid, each of the others in a
/// pass of its own.
void FieldSolver::Impl::combine(const std::vector<int>& chosen, const std::vector<bool>& channel_chosen,
                                bool into_resting) {
  CombinePass pass;
  pass.channels = channel_chosen;
  pass.into_resting = into_resting;
  std::vector<int> uncached;
  for (int e : chosen) {
    if (!emitters[e].state.active) continue;
    if (emitters[e].is_cached) {
      pass.members.push_back({e, combineEmitter(e), radarShares(e)});
    } else {
      uncached.push_back(e);
    }
  }
  engine->combine(pass);
  pass.keep = true;
  for (int e : uncached) {
    computeGeometry({e}, true);
    pass.members = {{static_cast<int>(emitters.size()), combineEmitter(e), radarShares(e)}};
    engine->combine(pass);
  }
}

/// First valid layers of a channel's columns: those above ground, but for columns that are unknown to one of
/// its emitters.
/// @param own  holds the result where it is not that of all channels
const std::vector<std::uint16_t>& FieldSolver::Impl::maskOf(const Channel& channel,
                                                            std::vector<std::uint16_t>& own) const {
  const std::vector<std::uint16_t>& above_ground = setup.columns.first_valid_k;
  own.clear();
  for (int e : channel.emitters) {
    const std::vector<bool>& unknown = emitters[e].findings.unknown;
    if (!emitters[e].state.active || unknown.empty()) continue;
    if (own.empty()) own = above_ground;
    own.resize(unknown.size(), 0);
    for (std::size_t c = 0; c < unknown.size(); ++c) {
      if (unknown[c]) own[c] = static_cast<std::uint16_t>(setup.grid.dims.z);
    }
  }
  return own.empty() ? above_ground : own;
}

VolumeRequest FieldSolver::Impl::volumeRequest(int c, const scenario::Snapshot& snapshot) {
  const Channel& channel = setup.channels[c];
  const QuantityInfo& quantity = info(channel.quantity);
  VolumeRequest request;
  request.channel = c;
  request.first_valid_k = &maskOf(channel, masks[c]);
  volume::VolumeInfo& out = request.info;
  out.quantity = channel.name;
  out.unit = quantity.unit;
  out.time_s = snapshot.time_s;
  out.time_utc = snapshot.time_utc;
  out.floor = setup.recipes[c].product.floor;
  out.categorical = quantity.categorical;
  if (quantity.scale != nullptr) out.extra[volume::kScaleKey] = quantity.scale;
  out.extra["scenario"] = setup.scenario->name;
  out.extra["scenario_hash"] = setup.scenario->hash;
  std::string names, near_field;
  for (int e : channel.emitters) {
    if (!emitters[e].state.active) continue;
    const long long near_voxels = emitters[e].findings.near_voxels;
    if (near_voxels > 0) {
      near_field += fmt::format("{}{}: {} voxels within {:.0f} m", near_field.empty() ? "" : "; ",
                                setup.scenario->emitters[e].name, near_voxels, setup.far_field_m[e]);
    }
  }
  if (!near_field.empty()) out.extra["near_field"] = near_field;
  if (quantity.categorical) {
    for (const Emitter& emitter : setup.scenario->emitters)
      names += (names.empty() ? "" : "\n") + emitter.name;
    out.extra["labels"] = names;
  }
  return request;
}

}  // namespace emscape::emfield
