// The stages of an update: geometry, combine, volumes.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/text/count_text.h"
#include "emfield/channels/categories.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/model_check.h"
#include "emfield/solver/field_solver_impl.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "volume/labels.h"

namespace emscape::emfield {

using scenario::Emitter;
using scenario::EmitterState;

namespace {

/// Peak EIRP minus losses.
double eirpOf_w(const Emitter& emitter) {
  return emitter.power_w * dbToRatio(emitter.antenna->gain_dbi - emitter.losses_db);
}

}  // namespace

/// Emitters that are not measured yet count as the mean of the others.
void FieldSolver::Impl::chooseStep(const std::vector<int>& moved) {
  if (moved.empty()) return;
  double known_ms = 0;
  int known = 0;
  for (int e : moved) {
    known_ms += emitters[e].every_column_ms;
    known += emitters[e].every_column_ms > 0 ? 1 : 0;
  }
  pace.choose(known == 0 ? 0 : known_ms * static_cast<double>(moved.size()) / known);
}

/// Time of the columns of some emitters that were just computed.
double FieldSolver::Impl::columns_ms(const std::vector<int>& computed) const {
  double ms = 0;
  for (int e : computed) {
    const ColumnPart part{emitters[e].geometry_result.column_step, 0};
    ms += emitters[e].every_column_ms * part.fraction(setup.grid.dims);
  }
  return ms;
}

/// The columns of an emitter that are computed now.
ColumnPart FieldSolver::Impl::partOf(int e, bool into_scratch) const {
  const EmitterCache& cache = emitters[e];
  const bool continues = !into_scratch && pace.step == 1 && cache.geometry &&
                         cache.geometry_result.column_step > 1 &&
                         areSame(*cache.geometry, geometryInputs(setup, e, cache.state));
  return {pace.step, continues ? cache.geometry_result.column_step : 0};
}

/// Computes the geometry of some emitters, into their own slots or the slot of uncached emitters.
void FieldSolver::Impl::computeGeometry(const std::vector<int>& chosen, bool into_scratch) {
  if (chosen.empty()) return;
  const auto compute = [&](std::size_t begin, std::size_t end) {
    const auto count = static_cast<double>(chosen.size());
    const Emitter& emitter = setup.scenario->emitters[chosen[begin]];
    std::string model = toString(emitter.propagation.model);
    std::replace(model.begin(), model.end(), '_', ' ');
    const WorkPart part(fmt::format("'{}' by {}, {} of {}", emitter.name, model, begin + 1, chosen.size()),
                        static_cast<double>(begin) / count, static_cast<double>(end) / count);
    std::vector<GeometryRequest> requests;
    for (std::size_t i = begin; i < end; ++i) {
      const int e = chosen[i];
      const ColumnPart columns = partOf(e, into_scratch);
      if (!into_scratch) emitters[e].geometry.reset();  // the slot may be left unfinished
      requests.push_back(
          {e, into_scratch ? static_cast<int>(emitters.size()) : e, emitters[e].state, columns});
    }
    std::vector<GeometryResult> found = engine->computeGeometry(requests);
    for (std::size_t i = begin; i < end; ++i) takeGeometry(chosen[i], std::move(found[i - begin]));
  };
  if (backend == Backend::cuda) {
    compute(0, chosen.size());  // at the same time
  } else {
    for (std::size_t i = 0; i < chosen.size(); ++i) compute(i, i + 1);
  }
}

void FieldSolver::Impl::takeGeometry(int e, GeometryResult found) {
  const Emitter& emitter = setup.scenario->emitters[e];
  EmitterCache& cache = emitters[e];
  cache.geometry = geometryInputs(setup, e, cache.state);
  if (found.every_column_ms > 0) cache.every_column_ms = found.every_column_ms;
  cache.geometry_result = std::move(found);
  const GeometryResult& geometry_result = cache.geometry_result;
  if (geometry_result.unknown_columns > 0 && !mayLackTerrain()) {
    const auto first = std::find(geometry_result.unknown.begin(), geometry_result.unknown.end(), 1);
    throw Error(
        ErrorCode::bad_input, {setup.scenario->file},
        fmt::format("emitter '{}': the path to {} and to {} more columns crosses missing terrain; {}",
                    emitter.name, placeOf(static_cast<std::size_t>(first - geometry_result.unknown.begin())),
                    geometry_result.unknown_columns - 1, scenario::kMissingTerrainRemedy),
        Hint::allow_missing_terrain);
  }
  noteWarnings(e);
}

/// Adds the warnings of an emitter's geometry; they contain its name.
void FieldSolver::Impl::noteWarnings(int e) {
  const Emitter& emitter = setup.scenario->emitters[e];
  EmitterCache& cache = emitters[e];
  const GeometryResult& geometry_result = cache.geometry_result;
  if (geometry_result.unknown_columns > 0) {
    ++cache.warnings[fmt::format("emitter '{}': columns seen across missing terrain have no field",
                                 emitter.name)];
  }
  const Station station =
      makeStation(cache.geometry->position, cache.geometry->height_msl_m, setup.scenario->atmosphere);
  const scenario::BeamPose& beam = cache.state.beam;
  const propagation::PathInputs inputs = pathInputs(*setup.scenario, emitter, beam, station,
                                                    setup.terrain.get(), pathExtent(station, setup.columns));
  for (const std::string& warning : pathWarnings(emitter, inputs, geometry_result.warnings)) {
    ++cache.warnings[warning];
  }
  const auto& steep = geometry_result.steep;
  if (steep && (!cache.steep.ground || steep->lostPart() > cache.steep.ground->lostPart()))
    cache.steep = {steep, {}};
  if (geometry_result.near_voxels > 0) {
    ++cache.warnings[fmt::format(
        "emitter '{}': voxels closer than the far-field distance (2 D^2 / lambda = {:.0f} m) have the value "
        "of the far field's formula",
        emitter.name, setup.far_field_m[e])];
  }
}

/// The unchanged emitters before the first changed one are summed once. Every sum is therefore in the order
/// of the scenario and does not depend on earlier updates. The static sum is recomputed when the number of
/// unchanged emitters combined since it was last computed reaches its cost.
void FieldSolver::Impl::chooseResting(const std::vector<bool>& changed) {
  const auto first_changed =
      static_cast<int>(std::find(changed.begin(), changed.end(), true) - changed.begin());
  int chosen = static_count;
  if (static_count > first_changed) {
    chosen = 0;
  } else {
    recombined_since += first_changed - static_count;
    if (static_count < first_changed && recombined_since >= first_changed) chosen = first_changed;
  }
  if (chosen == static_count) return;

  recombined_since = 0;
  static_count = chosen;
  std::vector<bool> has_static_sums;
  for (const Channel& channel : setup.channels) {
    has_static_sums.push_back(std::any_of(channel.emitters.begin(), channel.emitters.end(),
                                          [&](int e) { return e < static_count; }));
  }
  engine->setStaticSums(has_static_sums);
  if (static_count > 0) combine(0, static_count, has_static_sums, true);
}

/// An emitter's contributions to the channels.
CombinePass::Member FieldSolver::Impl::combineMember(const scenario::Snapshot& snapshot, int e) {
  const Emitter& emitter = setup.scenario->emitters[e];
  const EmitterState& state = emitters[e].state;
  CombinePass::Member member;
  const std::optional<IntervalBeam>& interval = emitters[e].interval;
  const scenario::BeamPose& pose = interval ? interval->pose : state.beam;
  member.antenna = emitter.antenna;
  member.beam_antenna = interval ? interval->antenna : emitter.antenna;
  member.slot = e;
  member.radars = radarShares(snapshot, e);
  member.occupancies = occupancyShares(snapshot, e);
  CombineEmitter& part = member.emitter;
  part.emitter_index = e;
  part.beam.forward = vecCast<float>(pose.forward);
  part.beam.right = vecCast<float>(pose.right);
  part.beam.up = vecCast<float>(pose.up);
  part.beam.steer_u = static_cast<float>(pose.steer_u);
  part.beam.steer_v = static_cast<float>(pose.steer_v);
  const double eirp_w = eirpOf_w(emitter) * (interval ? interval->power_share : 1);
  part.beam.eirp_over_4pi_w = static_cast<float>(eirp_w / (4 * kPi));
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const auto& members = setup.channels[c].emitters;
    const auto found = std::find(members.begin(), members.end(), e);
    if (found == members.end() || !setup.channel_plans[c].reducesPower()) continue;
    part.shares.push_back({static_cast<int>(c), setup.channel_plans[c].weights[found - members.begin()]});
  }
  return member;
}

/// An emitter's contributions to channels of occupancy.
std::vector<OccupancyShare> FieldSolver::Impl::occupancyShares(const scenario::Snapshot& snapshot, int e) {
  std::vector<OccupancyShare> shares;
  const Emitter& emitter = setup.scenario->emitters[e];
  for (std::size_t c = 0; c < setup.channels.size(); ++c) {
    const std::vector<int>& members = setup.channels[c].emitters;
    const float threshold_wm2 = setup.channel_plans[c].occupancy_threshold_wm2;
    if (threshold_wm2 == 0 || std::find(members.begin(), members.end(), e) == members.end()) continue;
    OccupancyShare share;
    share.channel = static_cast<int>(c);
    share.threshold_wm2 = threshold_wm2;
    share.eirp_over_4pi_w = static_cast<float>(eirpOf_w(emitter) / (4 * kPi));
    setPositions(*setup.scenario, whilePresent(snapshot, emitter), emitters[e].state, snapshot.time_s,
                 reaches, share);
    shares.push_back(std::move(share));
  }
  return shares;
}

/// Combines the active emitters begin..end - 1: consecutive cached emitters in one pass over the grid, each
/// of the others in a separate pass.
void FieldSolver::Impl::combine(int begin, int end, const std::vector<bool>& channel_chosen,
                                bool into_static_sums) {
  CombinePass pass;
  pass.channels = channel_chosen;
  pass.into_static_sums = into_static_sums;
  const auto isChosen = [&](const auto& share) { return channel_chosen[share.channel]; };
  const auto enters = [&](const CombinePass::Member& member) {
    return std::any_of(member.emitter.shares.begin(), member.emitter.shares.end(), isChosen) ||
           std::any_of(member.radars.begin(), member.radars.end(), isChosen) ||
           std::any_of(member.occupancies.begin(), member.occupancies.end(), isChosen);
  };
  const auto run = [&] {
    engine->combine(pass);
    pass.keep = true;
    pass.members.clear();
  };
  for (int e = begin; e < end; ++e) {
    const EmitterCache& cache = emitters[e];
    if (!cache.combined || !enters(*cache.combined)) continue;
    if (!cache.is_cached) {
      if (!pass.members.empty()) run();
      computeGeometry({e}, true);
    }
    pass.members.push_back(*cache.combined);
    if (!cache.is_cached) {
      pass.members.back().slot = static_cast<int>(emitters.size());
      run();
    }
  }
  if (!pass.keep || !pass.members.empty()) run();
}

/// First valid layers of a channel's columns: those above ground; none in columns that are unknown to one of
/// its emitters, or, if the others' value is kept, to all.
/// @param mask  receives what is the channel's own
const std::vector<std::uint16_t>& FieldSolver::Impl::maskOf(const Channel& channel, ChannelMask& mask) const {
  const std::vector<std::uint16_t>& above_ground = setup.columns.first_valid_k;
  mask = {};
  std::vector<const std::vector<std::uint8_t>*> unknown;
  std::size_t active = 0;
  for (int e : channel.emitters) {
    if (!emitters[e].state.active) continue;
    ++active;
    if (!emitters[e].geometry_result.unknown.empty()) unknown.push_back(&emitters[e].geometry_result.unknown);
  }
  const bool keeps_partly = options.keep_partly_unknown && emittersOnlyRaise(channel.quantity);
  const std::size_t masking = keeps_partly ? active : 1;
  const auto none_k = static_cast<std::uint16_t>(setup.grid.dims.z);
  for (std::size_t c = 0; !unknown.empty() && c < unknown.front()->size(); ++c) {
    const auto count = static_cast<std::size_t>(std::count_if(
        unknown.begin(), unknown.end(), [&](const auto* of_emitter) { return (*of_emitter)[c] != 0; }));
    if (count == 0 || (!above_ground.empty() && above_ground[c] == none_k)) continue;
    if (count < masking) {
      mask.partly_unknown.resize(unknown.front()->size(), 0);
      mask.partly_unknown[c] = 1;
      continue;
    }
    if (mask.first_valid_k.empty()) mask.first_valid_k = above_ground;
    mask.first_valid_k.resize(unknown.front()->size(), 0);
    mask.first_valid_k[c] = none_k;
  }
  return mask.first_valid_k.empty() ? above_ground : mask.first_valid_k;
}

/// Makes the volumes of changed channels. After an edit the other volumes get the name and metadata of the
/// edited scenario.
void FieldSolver::Impl::makeVolumes(const scenario::Snapshot& snapshot, const Changes& changes) {
  if (changes.all_sums) {
    volumes.assign(setup.channels.size(), {});
    masks.assign(setup.channels.size(), {});
  }
  std::vector<VolumeRequest> requests;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    if (!changes.products[c] && !changes.is_edited) continue;
    VolumeRequest request = volumeRequest(static_cast<int>(c), snapshot);
    if (changes.products[c]) {
      volumes[c] = {};  // so that its memory can be reused
      requests.push_back(std::move(request));
    } else {
      request.info.range_min = volumes[c].info().range_min;
      request.info.range_max = volumes[c].info().range_max;
      volumes[c].setInfo(std::move(request.info));
    }
  }
  std::vector<volume::Volume> made = engine->makeVolumes(requests);
  for (std::size_t r = 0; r < requests.size(); ++r) volumes[requests[r].channel] = std::move(made[r]);
}

VolumeRequest FieldSolver::Impl::volumeRequest(int c, const scenario::Snapshot& snapshot) {
  const Channel& channel = setup.channels[c];
  const scenario::QuantityInfo& quantity = scenario::info(channel.quantity);
  VolumeRequest request;
  request.channel = c;
  request.first_valid_k = &maskOf(channel, masks[c]);
  volume::VolumeInfo& out = request.info;
  out.quantity = channel.name;
  out.unit = quantity.unit;
  out.time_s = snapshot.time_s;
  out.time_utc = snapshot.time_utc;
  out.floor = setup.channel_plans[c].product.floor;
  out.categorical = quantity.categorical;
  if (const char* const scale = scaleOf(channel.quantity)) out.extra[volume::kScaleKey] = scale;
  const std::string own_note = legendNoteOf(channel.quantity, *setup.scenario);
  if (!own_note.empty()) out.extra[volume::kLegendNoteKey] = own_note;
  const std::string interval = scenario::describe(setup.scenario->output.interval, setup.scenario->clock);
  if (!interval.empty()) {
    out.extra["interval"] = interval;
    std::string& note = out.extra[volume::kLegendNoteKey];
    note += (note.empty() ? "" : "; ") + interval;
  }
  out.extra["scenario"] = setup.scenario->name;
  out.extra["scenario_hash"] = setup.scenario->hash;
  out.extra["program"] = "emscape " EMSCAPE_VERSION;
  std::set<std::string> models;
  for (int e : channel.emitters) models.insert(toString(setup.scenario->emitters[e].propagation.model));
  out.extra["models"] = fmt::format("{}", fmt::join(models, ", "));
  std::string near_field;
  for (int e : channel.emitters) {
    if (!emitters[e].state.active) continue;
    const long long near_voxels = emitters[e].geometry_result.near_voxels;
    if (near_voxels > 0) {
      near_field += fmt::format("{}{}: {} within {:.0f} m", near_field.empty() ? "" : "; ",
                                setup.scenario->emitters[e].name, countText(near_voxels, "voxel", "voxels"),
                                setup.far_field_m[e]);
    }
  }
  if (!near_field.empty()) out.extra["near_field"] = near_field;
  if (quantity.categorical) {
    const std::vector<std::string> names = categoryNames(*setup.scenario, channel.quantity);
    out.extra[volume::kLabelsKey] = fmt::format("{}", fmt::join(names, "\n"));
  }
  return request;
}

}  // namespace emscape::emfield
