#include "emfield/field_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "emfield/combine.h"
#include "emfield/emitter_geometry.h"
#include "emfield/grid_columns.h"
#include "emfield/models/horizon.h"
#include "emfield/products.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::EmitterState;
using scenario::PropagationModel;

/// What decides whether an emitter's beam is the same as at the last update.
bool sameBeam(const EmitterState& a, const EmitterState& b) {
  if (a.active != b.active) return false;
  if (!a.active) return true;
  return a.beam.forward == b.beam.forward && a.beam.right == b.beam.right && a.beam.up == b.beam.up &&
         a.beam.steer_u == b.beam.steer_u && a.beam.steer_v == b.beam.steer_v;
}

double distance_m(const GeodeticPosition& a, const GeodeticPosition& b) {
  return length(toEcef(a) - toEcef(b));
}

/// An emitter between updates.
struct EmitterCache {
  EmitterGeometry geometry;
  EmitterState state;            ///< at the last update
  GeodeticPosition computed_at;  ///< where the geometry was computed
  bool has_geometry =
      false;              ///< computed_at and unknown_columns hold; the arrays too if the emitter is cached
  bool is_cached = true;  ///< false: the arrays are given up after each use
  std::vector<bool> unknown_columns;  ///< empty: none
  double far_field_m = 0;
  long long near_voxels = 0;
};

/// Buffers of one channel.
struct ChannelState {
  ChannelRecipe recipe;
  std::vector<float> value, largest;                  ///< accumulator over all emitters
  std::vector<float> resting_value, resting_largest;  ///< accumulator over the resting emitters alone
  std::vector<std::shared_ptr<volume::DenseVolume>> pool;

  bool hasResting() const { return !resting_value.empty(); }
};

}  // namespace

volume::Grid gridOf(const scenario::Region& region) {
  volume::Grid grid;
  grid.dims = region.dims;
  grid.spacing_m = {region.size_m.x / region.dims.x, region.size_m.y / region.dims.y,
                    region.size_m.z / region.dims.z};
  const double lowest_m = region.origin.kind == FrameKind::altitude ? region.origin.height_msl_m : 0;
  grid.first_center_m = Vec3d{-region.size_m.x / 2, -region.size_m.y / 2, lowest_m} + grid.spacing_m * 0.5;
  grid.frame = region.origin;
  grid.georeferenced = true;
  return grid;
}

struct FieldSolver::Impl {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
  FieldOptions options;
  volume::Grid grid;
  GridColumns columns;
  FanResolution resolution;
  std::vector<int> first_row_k;
  std::vector<Channel> channels;
  std::vector<ChannelState> channel_states;
  std::vector<EmitterCache> emitters;
  std::vector<std::shared_ptr<const volume::DenseVolume>> volumes;
  std::map<std::string, long long> warning_counts;
  StageTimes times;
  EmitterGeometry scratch;  ///< of an emitter that is not cached

  /// Emitters whose sum lies in the channels' resting accumulators; they have not changed since.
  std::vector<bool> resting;
  /// Emitters combined again though they had not changed, since the resting set was last chosen.
  int wasted = 0;
  bool is_first = true;

  Impl(std::shared_ptr<const scenario::Scenario> scenario_in, scenario::TerrainPtr terrain_in,
       FieldOptions options_in);

  void checkModels() const;
  void checkHoles() const;
  std::string placeOf(std::size_t column) const;
  void warn(const std::string& warning) { ++warning_counts[warning]; }

  FieldChanged findChanges(const scenario::Snapshot& snapshot);
  void computeGeometry(int e, const EmitterState& state, EmitterGeometry& geometry);
  void countNearField(int e, const EmitterGeometry& geometry);
  void chooseResting(const std::vector<bool>& changed);
  void combine(const std::vector<int>& chosen, const std::vector<bool>& channel_chosen, bool into_resting);
  CombineEmitter combineEmitter(int e, const EmitterGeometry& geometry) const;
  void makeVolume(std::size_t channel, const scenario::Snapshot& snapshot);
  void maskUnknown(const Channel& channel, std::vector<std::uint16_t>& first_valid_k) const;
  std::shared_ptr<volume::DenseVolume> freeVolume(ChannelState& state) const;
};

FieldSolver::Impl::Impl(std::shared_ptr<const scenario::Scenario> scenario_in,
                        scenario::TerrainPtr terrain_in, FieldOptions options_in)
    : scenario(std::move(scenario_in)), terrain(std::move(terrain_in)), options(std::move(options_in)) {
  checkModels();
  grid = gridOf(scenario->region);
  channels = channelsOf(*scenario, options.quantities);
  for (const Channel& channel : channels)
    channel_states.push_back({recipeOf(channel, *scenario), {}, {}, {}, {}, {}});
  columns = makeGridColumns(grid, terrain.get());
  checkHoles();
  resolution = fanResolution(grid, terrain.get());
  if (!columns.first_valid_k.empty()) {
    for (int j = 0; j < grid.dims.y; ++j) {
      const auto row = columns.first_valid_k.begin() + static_cast<std::ptrdiff_t>(j) * grid.dims.x;
      first_row_k.push_back(*std::min_element(row, row + grid.dims.x));
    }
  }
  emitters.resize(scenario->emitters.size());
  const std::size_t bytes_each = columns.columns.size() * EmitterGeometry::kBytesPerColumn;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    emitters[e].is_cached = options.cache_bytes == 0 || (e + 1) * bytes_each <= options.cache_bytes;
    const Emitter& emitter = scenario->emitters[e];
    const double wavelength = wavelength_m(emitter.frequency_hz);
    const double dimension_m = emitter.antenna->apertureDimension_m(wavelength);
    emitters[e].far_field_m = 2 * dimension_m * dimension_m / wavelength;
  }
  volumes.resize(channels.size());
}

void FieldSolver::Impl::checkModels() const {
  for (const Emitter& emitter : scenario->emitters) {
    if (emitter.propagation != PropagationModel::free_space &&
        emitter.propagation != PropagationModel::horizon) {
      throw Error(
          ErrorCode::bad_input, {scenario->file},
          fmt::format(
              "emitter '{}': propagation '{}' cannot be computed by this version; one of free_space, horizon",
              emitter.name, scenario::toString(emitter.propagation)));
    }
  }
}

std::string FieldSolver::Impl::placeOf(std::size_t column) const {
  const GeodeticPosition place = fromEcef(columns.columns[column].base_ecef_m);
  return fmt::format("latitude {:.5f}, longitude {:.5f} deg", place.latitude_deg, place.longitude_deg);
}

void FieldSolver::Impl::checkHoles() const {
  if (columns.hole_columns == 0 || options.allow_missing_terrain) return;
  const scenario::GeoBox box = terrain->coverage();
  throw Error(
      ErrorCode::bad_input, {scenario->file},
      fmt::format(
          "terrain is missing below {} of {} columns of the region, first at {}; the files cover latitude "
          "{:.5f}..{:.5f}, longitude {:.5f}..{:.5f} deg with {} void posts (--allow-missing-terrain draws "
          "holes)",
          columns.hole_columns, columns.columns.size(), placeOf(columns.first_hole), box.south_deg,
          box.north_deg, box.west_deg, box.east_deg, terrain->voidPosts()));
}

FieldChanged FieldSolver::Impl::findChanges(const scenario::Snapshot& snapshot) {
  FieldChanged changed;
  changed.grid = is_first;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const EmitterState& now = snapshot.emitters[e];
    EmitterCache& cache = emitters[e];
    const bool has_moved = now.active && (!cache.has_geometry || distance_m(now.position, cache.computed_at) >
                                                                     options.move_tolerance_m);
    if (has_moved) {
      changed.moved.push_back(static_cast<int>(e));
    } else if (is_first || !sameBeam(now, cache.state)) {
      changed.turned.push_back(static_cast<int>(e));
    }
    cache.state = now;
  }
  changed.any = is_first || !changed.moved.empty() || !changed.turned.empty();
  return changed;
}

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

FieldSolver::FieldSolver(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
                         FieldOptions options)
    : impl_(std::make_unique<Impl>(std::move(scenario), std::move(terrain), std::move(options))) {}

FieldSolver::~FieldSolver() = default;

const volume::Grid& FieldSolver::grid() const {
  return impl_->grid;
}
const std::vector<Channel>& FieldSolver::channels() const {
  return impl_->channels;
}
const std::vector<float>& FieldSolver::groundHeights_m() const {
  return impl_->columns.ground_msl_m;
}
StageTimes FieldSolver::stageTimes() const {
  return impl_->times;
}
const std::vector<std::shared_ptr<const volume::DenseVolume>>& FieldSolver::volumes() const {
  return impl_->volumes;
}

FieldChanged FieldSolver::update(const scenario::Snapshot& snapshot) {
  Impl& impl = *impl_;
  impl.times = {};
  const FieldChanged changed = impl.findChanges(snapshot);
  if (!changed.any) return changed;

  std::vector<bool> emitter_changed(impl.emitters.size(), impl.is_first);
  for (const std::vector<int>* list : {&changed.moved, &changed.turned}) {
    for (int e : *list) emitter_changed[e] = true;
  }
  for (int e : changed.moved) {
    EmitterCache& cache = impl.emitters[e];
    if (cache.is_cached) impl.computeGeometry(e, cache.state, cache.geometry);
  }

  std::vector<bool> channel_changed(impl.channels.size(), impl.is_first);
  for (std::size_t c = 0; c < impl.channels.size(); ++c) {
    for (int e : impl.channels[c].emitters) channel_changed[c] = channel_changed[c] || emitter_changed[e];
    ChannelState& state = impl.channel_states[c];
    state.value.resize(static_cast<std::size_t>(impl.grid.dims.count()));
    if (state.recipe.reduction == Reduction::dominant) state.largest.resize(state.value.size());
  }
  impl.chooseResting(emitter_changed);
  std::vector<int> chosen;
  for (std::size_t e = 0; e < impl.emitters.size(); ++e) {
    if (!impl.resting[e]) chosen.push_back(static_cast<int>(e));
  }
  impl.combine(chosen, channel_changed, false);

  Stopwatch watch;
  for (std::size_t c = 0; c < impl.channels.size(); ++c) {
    if (channel_changed[c]) impl.makeVolume(c, snapshot);
  }
  impl.times.product_ms = watch.lap_ms();
  impl.is_first = false;
  return changed;
}

MemoryUse FieldSolver::memoryUse() const {
  const Impl& impl = *impl_;
  MemoryUse use;
  const double voxels = static_cast<double>(impl.grid.dims.count());
  use.bytes_per_column_and_emitter = EmitterGeometry::kBytesPerColumn;
  for (const EmitterCache& emitter : impl.emitters) {
    use.total_bytes += emitter.is_cached ? emitter.geometry.bytes() : 0;
    use.uncached_emitters += emitter.is_cached ? 0 : 1;
  }
  std::size_t channel_bytes = 0;
  for (const ChannelState& state : impl.channel_states) {
    for (const auto* buffer : {&state.value, &state.largest, &state.resting_value, &state.resting_largest}) {
      channel_bytes += buffer->capacity() * sizeof(float);
    }
    for (const auto& volume : state.pool) channel_bytes += volume->values.capacity() * sizeof(float);
  }
  use.bytes_per_voxel_and_channel =
      static_cast<double>(channel_bytes) / voxels / std::max<std::size_t>(1, impl.channels.size());
  use.total_bytes += channel_bytes + impl.columns.columns.size() * sizeof(GridColumn);
  return use;
}

std::vector<std::string> FieldSolver::warnings() const {
  std::vector<std::string> lines;
  for (const auto& [warning, count] : impl_->warning_counts) {
    lines.push_back(count > 1 ? fmt::format("{} ({} times)", warning, count) : warning);
  }
  return lines;
}

}  // namespace emscape::emfield
