#include "emfield/field_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/stopwatch.h"
#include "base/units.h"
#include "emfield/field_solver_impl.h"

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
