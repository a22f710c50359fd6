#include "emscape/emfield/field_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "emfield/excess/excess_model.h"
#include "emfield/field_solver_impl.h"
#include "emfield/model_check.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::EmitterState;

bool samePose(const scenario::BeamPose& a, const scenario::BeamPose& b) {
  return a.forward == b.forward && a.right == b.right && a.up == b.up && a.steer_u == b.steer_u &&
         a.steer_v == b.steer_v;
}

/// What decides whether an emitter's beam is the same as at the last update.
bool sameBeam(const EmitterState& a, const EmitterState& b) {
  if (a.active != b.active) return false;
  if (!a.active) return true;
  return samePose(a.beam, b.beam) && samePose(a.mount, b.mount);
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

FieldSolver::Impl::Impl(std::shared_ptr<const scenario::Scenario> scenario, scenario::TerrainPtr terrain,
                        FieldOptions options_in)
    : options(std::move(options_in)) {
  setup.scenario = std::move(scenario);
  setup.terrain = std::move(terrain);
  for (const std::string& warning : checkModels(*setup.scenario)) warn(warning);
  setup.grid = gridOf(setup.scenario->region);
  setup.channels = channelsOf(*setup.scenario, options.quantities);
  for (const Channel& channel : setup.channels) setup.recipes.push_back(recipeOf(channel, *setup.scenario));
  setup.columns = makeGridColumns(setup.grid, setup.terrain.get());
  checkHoles();
  setup.resolution = fanResolution(setup.grid, setup.terrain.get());
  for (const Emitter& emitter : setup.scenario->emitters) {
    const double wavelength = wavelength_m(emitter.frequency_hz);
    const double dimension_m = emitter.antenna->apertureDimension_m(wavelength);
    setup.far_field_m.push_back(2 * dimension_m * dimension_m / wavelength);
  }
  emitters.resize(setup.scenario->emitters.size());
  masks.resize(setup.channels.size());
  const std::size_t slot_bytes = chooseCached();
  engine = openOnBackend(
      options.backend,
      [&](const BackendChoice& choice) {
        backend = choice.backend;
        return makeEngine(slot_bytes);
      },
      logInfo);
}

/// Chooses the emitters that are cached.
/// @return what the slots take (bytes)
std::size_t FieldSolver::Impl::chooseCached() {
  std::size_t cached_bytes = 0, largest_uncached = 0;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const std::size_t bytes =
        EmitterGeometry::bytesOf(*setup.scenario, setup.scenario->emitters[e], setup.columns.columns.size(),
                                 static_cast<int>(setup.columns.t_m.size()));
    emitters[e].is_cached = options.cache_bytes == 0 || cached_bytes + bytes <= options.cache_bytes;
    if (emitters[e].is_cached) {
      cached_bytes += bytes;
    } else {
      largest_uncached = std::max(largest_uncached, bytes);
    }
  }
  return cached_bytes + largest_uncached;
}

std::unique_ptr<FieldEngine> FieldSolver::Impl::makeEngine(std::size_t slot_bytes) const {
  const int slots = static_cast<int>(emitters.size()) + 1;
  if (backend == Backend::cpu) return makeCpuEngine(setup, slots);
  const std::size_t needed = cudaEngineBytes(setup, slot_bytes, options.device_precision);
  const std::size_t free = findDevice().free_bytes;
  if (needed > free) {
    const bool half = options.device_precision == volume::VoxelPrecision::float16;
    constexpr double kMebibyte = 1 << 20;
    throw Error(
        ErrorCode::device, {setup.scenario->file},
        fmt::format(
            "the field of {} x {} x {} voxels, {} emitters and {} channels needs up to {:.0f} MiB of the "
            "GPU's memory, of which {:.0f} MiB are free; a bound on what emitters keep{} would take less",
            setup.grid.dims.x, setup.grid.dims.y, setup.grid.dims.z, emitters.size(), setup.channels.size(),
            static_cast<double>(needed) / kMebibyte, static_cast<double>(free) / kMebibyte,
            half ? "" : ", or volumes of 16 bit,"));
  }
  return makeCudaEngine(setup, slots, options.device_precision);
}

std::string FieldSolver::Impl::placeOf(std::size_t column) const {
  const GeodeticPosition place = fromEcef(setup.columns.columns[column].base_ecef_m);
  return fmt::format("latitude {:.5f}, longitude {:.5f} deg", place.latitude_deg, place.longitude_deg);
}

void FieldSolver::Impl::checkHoles() const {
  const GridColumns& columns = setup.columns;
  if (columns.hole_columns == 0 || options.allow_missing_terrain) return;
  const scenario::GeoBox box = setup.terrain->coverage();
  throw Error(
      ErrorCode::bad_input, {setup.scenario->file},
      fmt::format(
          "terrain is missing below {} of {} columns of the region, first at {}; the files cover latitude "
          "{:.5f}..{:.5f}, longitude {:.5f}..{:.5f} deg with {} void posts (--allow-missing-terrain draws "
          "holes)",
          columns.hole_columns, columns.columns.size(), placeOf(columns.first_hole), box.south_deg,
          box.north_deg, box.west_deg, box.east_deg, setup.terrain->voidPosts()));
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
    cache.mount_changed =
        is_first || has_moved || now.active != cache.state.active || !samePose(now.mount, cache.state.mount);
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
  return impl_->setup.grid;
}
const std::vector<Channel>& FieldSolver::channels() const {
  return impl_->setup.channels;
}
const std::vector<float>& FieldSolver::groundHeights_m() const {
  return impl_->setup.columns.ground_msl_m;
}
const std::vector<std::shared_ptr<const volume::DeviceVolume>>& FieldSolver::deviceVolumes() const {
  return impl_->engine->deviceVolumes();
}
Backend FieldSolver::backend() const {
  return impl_->backend;
}
StageTimes FieldSolver::stageTimes() const {
  return impl_->engine->times();
}
const std::vector<std::shared_ptr<const volume::DenseVolume>>& FieldSolver::volumes() const {
  return impl_->engine->volumes();
}

FieldChanged FieldSolver::update(const scenario::Snapshot& snapshot) {
  Impl& impl = *impl_;
  impl.engine->resetTimes();
  const FieldChanged changed = impl.findChanges(snapshot);
  if (!changed.any) return changed;

  std::vector<bool> emitter_changed(impl.emitters.size(), impl.is_first);
  for (const std::vector<int>* list : {&changed.moved, &changed.turned}) {
    for (int e : *list) emitter_changed[e] = true;
  }
  impl.findJamming(snapshot, emitter_changed);
  std::vector<int> recomputed, chosen;
  for (int e : changed.moved) {
    if (impl.emitters[e].is_cached) recomputed.push_back(e);
  }
  impl.computeGeometry(recomputed, false);

  const std::vector<Channel>& channels = impl.setup.channels;
  std::vector<bool> channel_changed(channels.size(), impl.is_first);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    channel_changed[c] =
        channel_changed[c] || impl.isAffected(channels[c], impl.setup.recipes[c], emitter_changed);
  }
  impl.chooseResting(emitter_changed);
  for (std::size_t e = 0; e < impl.emitters.size(); ++e) {
    if (!impl.resting[e]) chosen.push_back(static_cast<int>(e));
  }
  impl.combine(chosen, channel_changed, false);

  std::vector<VolumeRequest> requests;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channel_changed[c]) requests.push_back(impl.volumeRequest(static_cast<int>(c), snapshot));
  }
  impl.engine->makeVolumes(requests);
  impl.is_first = false;
  return changed;
}

MemoryUse FieldSolver::memoryUse() const {
  const Impl& impl = *impl_;
  MemoryUse use;
  use.bytes_per_column_and_emitter = EmitterGeometry::kBytesPerColumn;
  for (std::size_t e = 0; e < impl.emitters.size(); ++e) {
    use.uncached_emitters += impl.emitters[e].is_cached ? 0 : 1;
    if (!hasExcess(*impl.setup.scenario, impl.setup.scenario->emitters[e])) continue;
    use.bytes_per_voxel_and_emitter +=
        static_cast<double>(sizeof(ExcessCode)) / static_cast<double>(impl.emitters.size());
  }
  impl.engine->addMemory(use);
  use.total_bytes += impl.setup.columns.columns.size() * sizeof(GridColumn);
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
