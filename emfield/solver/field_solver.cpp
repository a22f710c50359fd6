#include "emscape/emfield/solver/field_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/memory.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/model_check.h"
#include "emfield/solver/field_solver_impl.h"
#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "emscape/scenario/model/poses.h"

namespace emscape::emfield {
namespace {

/// True if two regions have the same grid.
bool sameRegion(const scenario::Region& a, const scenario::Region& b) {
  const auto& [origin, size_m, dims] = a;
  const auto& [kind, latitude_deg, longitude_deg, height_msl_m] = origin;
  return kind == b.origin.kind && latitude_deg == b.origin.latitude_deg &&
         longitude_deg == b.origin.longitude_deg && height_msl_m == b.origin.height_msl_m &&
         size_m == b.size_m && dims == b.dims;
}

bool sameTerrainFiles(const scenario::Scenario& a, const scenario::Scenario& b) {
  if (!a.terrain || !b.terrain) return !a.terrain && !b.terrain;
  return *a.terrain == *b.terrain;
}

/// Its layers are the heights.
volume::Grid gridOf(const Surface& surface) {
  volume::Grid grid;
  grid.dims = {surface.width, surface.height, static_cast<int>(surface.heights_m.size())};
  grid.spacing_m = {1, 1, 1};
  return grid;
}

std::size_t columnsOf(Dims dims) {
  return static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y);
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
                        FieldOptions options_in, GridColumns columns_in)
    : options(std::move(options_in)) {
  setup.columns = std::move(columns_in);
  static_cast<FieldPlan&>(setup) = makePlan(std::move(scenario), options);
  setup.terrain = std::move(terrain);
  setup.grid = options.surface == nullptr ? gridOf(setup.scenario->region) : gridOf(*options.surface);
  emitters.resize(setup.scenario->emitters.size());
  masks.resize(setup.channels.size());
  volumes.resize(setup.channels.size());
  engine = withBackendFallback(
      options.backend,
      [&](const ResolvedBackend& resolved) {
        backend = resolved.backend;
        const std::vector<bool> cached = chooseCached(setup, &estimate.emitters);
        for (std::size_t e = 0; e < emitters.size(); ++e) emitters[e].is_cached = cached[e];
        requireFieldMemory();
        makeColumns();
        const int slots = static_cast<int>(emitters.size()) + 1;
        return backend == Backend::cpu ? makeCpuEngine(setup, slots)
                                       : makeCudaEngine(setup, slots, options.device_precision);
      },
      logInfo);
}

bool FieldSolver::Impl::hasDeviceColumns() const {
  return options.surface != nullptr && backend == Backend::cuda && !needsHostColumns(*setup.scenario);
}

/// Makes the columns where the backend needs them. Those of a region are the same for all backends.
void FieldSolver::Impl::makeColumns() {
  const WorkPart part("columns of the grid", 0, 0);
  if (options.surface == nullptr) {
    if (setup.columns.of_grid.empty()) setup.columns = makeGridColumns(setup.grid, setup.terrain.get());
  } else {
    setup.columns = {};
    setup.columns = hasDeviceColumns() ? makeDeviceColumns(*options.surface, setup.terrain.get())
                                       : makeGridColumns(*options.surface, setup.terrain.get());
  }
  checkHoles();
}

/// Chooses the emitters that are cached.
/// @param slot_bytes  receives the bytes of the slots; may be null
std::vector<bool> FieldSolver::Impl::chooseCached(const FieldPlan& plan, std::size_t* slot_bytes) const {
  std::vector<bool> cached;
  std::size_t cached_bytes = 0, largest_uncached = 0;
  for (std::size_t e = 0; e < plan.scenario->emitters.size(); ++e) {
    const std::size_t bytes =
        EmitterGeometry::bytesOf(*plan.scenario, plan.scenario->emitters[e], columnsOf(setup.grid.dims),
                                 setup.grid.dims.z, options.surface != nullptr, plan.needs[e]);
    cached.push_back(options.cache_bytes == 0 || cached_bytes + bytes <= options.cache_bytes);
    if (cached.back()) {
      cached_bytes += bytes;
    } else {
      largest_uncached = std::max(largest_uncached, bytes);
    }
  }
  if (slot_bytes != nullptr) *slot_bytes = cached_bytes + largest_uncached;
  return cached;
}

/// Estimates the memory of the field and checks it, before anything of it is made: the columns alone can take
/// gigabytes and seconds.
void FieldSolver::Impl::requireFieldMemory() {
  const Dims dims = setup.grid.dims;
  const bool on_host = backend == Backend::cpu;
  const std::size_t columns_bytes =
      columnsOf(dims) * (options.surface == nullptr ? sizeof(GridColumn) : sizeof(PositionColumn));
  const std::size_t needed =
      on_host ? cpuEngineBytes(setup, estimate.emitters)
              : columns_bytes + cudaEngineBytes(setup, estimate.emitters, options.device_precision);
  estimate.volumes = needed - estimate.emitters;
  const std::size_t channels = setup.channels.size();
  const std::string what =
      fmt::format("the field of {} x {} x {} voxels, {} emitter{} and {} channel{}", dims.x, dims.y, dims.z,
                  emitters.size(), emitters.size() == 1 ? "" : "s", channels, channels == 1 ? "" : "s");
  const bool is_grid = options.surface == nullptr;
  const std::string remedy = is_grid ? "fewer voxels (region.dims) or emitters take less"
                                     : "fewer places, heights or emitters take less";
  const bool has_columns = hasDeviceColumns() || !setup.columns.of_grid.empty();
  const std::size_t host_columns_bytes = has_columns ? 0 : columns_bytes;
  if (on_host) {
    requireMemory({what, host_columns_bytes + needed, remedy}, {setup.scenario->file});
    return;
  }
  requireMemory({"the columns of " + what, host_columns_bytes,
                 is_grid ? "fewer voxels (region.dims) take less" : "fewer places take less"},
                {setup.scenario->file});
  const bool has_half = options.device_precision != volume::VoxelPrecision::float16;
  const MemoryNeed need{what, needed, remedy + (has_half ? "; so do volumes of 16 bit" : "")};
  const std::size_t free = findDevice().free_bytes;
  if (needed > free)
    throw Error(ErrorCode::device, {setup.scenario->file}, memoryShortage(need, "GPU's", free));
}

std::string FieldSolver::Impl::placeOf(std::size_t column) const {
  GeodeticPosition position;
  if (options.surface != nullptr) {
    const Surface::Position& of_surface = options.surface->positions[column];
    position = {of_surface.latitude_deg, of_surface.longitude_deg, 0};
  } else {
    position = fromEcef(setup.columns.view()[column].base_ecef_m);
  }
  return fmt::format("latitude {:.5f}, longitude {:.5f} deg", position.latitude_deg, position.longitude_deg);
}

bool FieldSolver::Impl::mayLackTerrain() const {
  return options.allow_missing_terrain || scenario::mayLackTerrain(*setup.scenario, false);
}

void FieldSolver::Impl::checkHoles() const {
  const GridColumns& columns = setup.columns;
  if (columns.hole_columns == 0 || mayLackTerrain()) return;
  const scenario::GeoBox box = setup.terrain->coverage();
  throw Error(ErrorCode::bad_input, {setup.scenario->file},
              fmt::format("terrain is missing below {} of {} columns of the region, first at {}; the "
                          "elevation data that is loaded covers latitude "
                          "{:.5f}..{:.5f}, longitude {:.5f}..{:.5f} deg with {} void posts; {}",
                          columns.hole_columns, columns.count(), placeOf(columns.first_hole), box.south_deg,
                          box.north_deg, box.west_deg, box.east_deg, setup.terrain->voidPosts(),
                          static_cast<std::size_t>(columns.hole_columns) == columns.count()
                              ? setup.terrain->placeText()
                              : scenario::kMissingTerrainRemedy),
              Hint::allow_missing_terrain);
}

/// True if an edited scenario has the present grid over the present terrain.
bool FieldSolver::Impl::hasSameGrid(const FieldPlan& plan, const scenario::TerrainPtr& terrain) const {
  return terrain == setup.terrain &&
         (options.surface != nullptr || sameRegion(setup.scenario->region, plan.scenario->region));
}

/// True if an edited scenario can be computed with the present grid, slots and choice of cached emitters.
bool FieldSolver::Impl::canKeep(const FieldPlan& plan, const scenario::TerrainPtr& terrain) const {
  if (!hasSameGrid(plan, terrain) ||
      (setup.columns.on_device != nullptr && needsHostColumns(*plan.scenario)) ||
      setup.scenario->emitters.size() != plan.scenario->emitters.size()) {
    return false;
  }
  const std::vector<bool> cached = chooseCached(plan, nullptr);
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    if (cached[e] != emitters[e].is_cached) return false;
  }
  return true;
}

void FieldSolver::Impl::exchangeGeometry(int e, Impl& other, int other_e) {
  EmitterCache &cache = emitters[e], &others = other.emitters[other_e];
  std::swap(cache.geometry, others.geometry);
  std::swap(cache.geometry_result, others.geometry_result);
  std::swap(cache.warnings, others.warnings);
  std::swap(cache.steep, others.steep);
  engine->exchangeGeometry(e, *other.engine, other_e);
}

/// The first update of a solver whose former one had the same grid over the same terrain, but other emitters:
/// takes the geometry of emitters that are unchanged. If it fails, the former solver has it again.
FieldChanged FieldSolver::Impl::updateFrom(Impl& former, const scenario::Snapshot& snapshot) {
  std::map<std::string, int> by_name;
  for (std::size_t f = 0; f < former.emitters.size(); ++f)
    by_name[former.setup.scenario->emitters[f].name] = static_cast<int>(f);
  std::vector<std::pair<int, int>> taken;
  pace = former.pace;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    const auto found = by_name.find(setup.scenario->emitters[e].name);
    if (found != by_name.end()) emitters[e].every_column_ms = former.emitters[found->second].every_column_ms;
  }
  if (backend == former.backend) {
    for (int e = 0; e < static_cast<int>(emitters.size()); ++e) {
      const auto found = by_name.find(setup.scenario->emitters[e].name);
      if (found == by_name.end() || !emitters[e].is_cached) continue;
      const EmitterCache& known = former.emitters[found->second];
      if (!known.is_cached || !known.geometry ||
          !areSame(*known.geometry, geometryInputs(setup, e, snapshot.emitters[e])))
        continue;
      exchangeGeometry(e, former, found->second);
      taken.emplace_back(e, found->second);
    }
  }
  try {
    return update(snapshot, std::nullopt);
  } catch (...) {
    for (const auto& [e, former_e] : taken) exchangeGeometry(e, former, former_e);
    throw;
  }
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
  GridColumns& columns = impl_->setup.columns;
  if (columns.on_device != nullptr && columns.ground_msl_m.empty())
    columns.ground_msl_m = groundOf(*columns.on_device);
  return columns.ground_msl_m;
}
Backend FieldSolver::backend() const {
  return impl_->backend;
}
StageTimes FieldSolver::stageTimes() const {
  return impl_->engine->times();
}
const std::vector<volume::Volume>& FieldSolver::volumes() const {
  return impl_->volumes;
}
const std::vector<std::uint8_t>& FieldSolver::partlyUnknown(std::size_t channel) const {
  return impl_->masks[channel].partly_unknown;
}

FieldChanged FieldSolver::update(const scenario::Snapshot& snapshot) {
  const scenario::Scenario& old = *impl_->setup.scenario;
  if (!sameTerrainFiles(old, *snapshot.scenario)) {
    throw Error(
        ErrorCode::bad_input, {snapshot.scenario->file},
        "the edited scenario names other elevation files: they must be loaded and given to the update");
  }
  return update(snapshot, impl_->setup.terrain);
}

FieldChanged FieldSolver::update(const scenario::Snapshot& snapshot, scenario::TerrainPtr terrain) {
  const bool is_same_plan = snapshot.scenario == impl_->setup.scenario && !impl_->has_other_quantities;
  if (is_same_plan && terrain == impl_->setup.terrain) {
    return impl_->update(snapshot, std::nullopt);
  }
  FieldPlan plan = makePlan(snapshot.scenario, impl_->options);
  if (impl_->canKeep(plan, terrain)) return impl_->update(snapshot, std::move(plan));
  const bool has_same_grid = impl_->hasSameGrid(plan, terrain);
  const bool knows_columns = has_same_grid && impl_->options.surface == nullptr;
  auto fresh = std::make_unique<Impl>(snapshot.scenario, std::move(terrain), impl_->options,
                                      knows_columns ? impl_->setup.columns : GridColumns());
  fresh->pace.goal_ms = impl_->pace.goal_ms;
  const FieldChanged changed =
      has_same_grid ? fresh->updateFrom(*impl_, snapshot) : fresh->update(snapshot, std::nullopt);
  impl_ = std::move(fresh);
  return changed;
}

void FieldSolver::setQuantities(std::vector<std::string> quantities,
                                std::shared_ptr<const scenario::Scenario> next) {
  FieldOptions options = impl_->options;
  options.quantities = std::move(quantities);
  makePlan(std::move(next), options);  // throws
  impl_->options.quantities = std::move(options.quantities);
  impl_->has_other_quantities = true;
}

FieldChanged FieldSolver::update(double time_s, const std::vector<scenario::PlatformPose>& poses) {
  const FieldSetup& setup = impl_->setup;
  const scenario::Snapshot snapshot =
      scenario::snapshotAt(setup.scenario, setup.terrain.get(), time_s, poses);
  const double tolerance_m = std::exchange(impl_->options.move_tolerance_m, 0);
  try {
    const FieldChanged changed = impl_->update(snapshot, std::nullopt);
    impl_->options.move_tolerance_m = tolerance_m;
    return changed;
  } catch (...) {
    impl_->options.move_tolerance_m = tolerance_m;
    throw;
  }
}

void FieldSolver::setTimeGoal(double goal_ms) {
  impl_->pace.goal_ms = goal_ms;
}

int FieldSolver::columnStep() const {
  int step = 1;
  for (std::size_t e = 0; e < impl_->emitters.size(); ++e) {
    const EmitterCache& cache = impl_->emitters[e];
    if (cache.state.active && impl_->setup.needs[e].any)
      step = std::max(step, cache.geometry_result.column_step);
  }
  return step;
}

MemoryUse FieldSolver::memoryUse() const {
  const Impl& impl = *impl_;
  MemoryUse use;
  use.bytes_per_column_and_emitter = EmitterGeometry::kBytesPerColumn;
  for (std::size_t e = 0; e < impl.emitters.size(); ++e) {
    use.uncached_emitters += impl.emitters[e].is_cached ? 0 : 1;
    const scenario::Scenario& scenario = *impl.setup.scenario;
    use.bytes_per_voxel_and_emitter +=
        static_cast<double>(EmitterGeometry::bytesPerVoxel(
            scenario, scenario.emitters[e], impl.setup.columns.every_height, impl.setup.needs[e])) /
        static_cast<double>(impl.emitters.size());
  }
  impl.engine->addMemory(use);
  if (impl.setup.columns.on_device == nullptr) use.total_bytes += impl.setup.columns.bytes();
  return use;
}

MemoryEstimate FieldSolver::memoryEstimate() const {
  return impl_->estimate;
}

/// Makes the texts of steep ground that are missing, each of several plans.
void FieldSolver::Impl::tellSteepGround() {
  parallelFor(static_cast<int>(emitters.size()), 1, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      SteepCache& steep = emitters[static_cast<std::size_t>(e)].steep;
      if (steep.ground && !steep.text) steep.text = propagation::steepGroundWarning({*steep.ground});
    }
  });
}

std::vector<std::string> FieldSolver::warnings(SteepGrounds* steep) const {
  WarningCounts all;
  for (const std::string& warning : impl_->setup.warnings) ++all[warning];
  const scenario::Terrain* const ground = impl_->setup.terrain.get();
  for (const scenario::Emitter& emitter : impl_->setup.scenario->emitters) {
    for (const std::vector<std::string>& warnings :
         {laterTripWarnings(*impl_->setup.scenario, emitter, ground),
          ductedClutterWarnings(*impl_->setup.scenario, emitter, ground),
          farthestScatterWarnings(*impl_->setup.scenario, emitter, ground, impl_->setup.columns)}) {
      for (const std::string& warning : warnings) ++all[warning];
    }
  }
  if (impl_->setup.terrain) {
    for (const std::string& warning : impl_->setup.terrain->warnings()) ++all[warning];
    const double at_sea_level = partAtSeaLevel(*impl_->setup.scenario, *impl_->setup.terrain);
    for (const scenario::Emitter& emitter : impl_->setup.scenario->emitters) {
      for (const std::string& warning :
           seaWarnings(*impl_->setup.scenario, emitter, impl_->setup.terrain->lowest_m(), at_sea_level))
        ++all[warning];
      for (const std::string& warning :
           smoothSurfaceWarnings(*impl_->setup.scenario, emitter, *impl_->setup.terrain))
        ++all[warning];
    }
  }
  if (steep == nullptr) impl_->tellSteepGround();
  for (std::size_t e = 0; e < impl_->emitters.size(); ++e) {
    const EmitterCache& cache = impl_->emitters[e];
    for (const WarningCounts* counts : {&cache.warnings, &cache.jamming_warnings}) {
      for (const auto& [warning, count] : *counts) all[warning] += count;
    }
    const std::string& name = impl_->setup.scenario->emitters[e].name;
    if (steep != nullptr && cache.steep.ground) (*steep)[name].push_back(*cache.steep.ground);
    if (steep == nullptr && cache.steep.text && !cache.steep.text->empty())
      ++all[steepGroundText(name, *cache.steep.text)];
  }
  std::vector<std::string> lines;
  for (const auto& [warning, count] : all) {
    lines.push_back(count > 1 ? fmt::format("{} ({} times)", warning, count) : warning);
  }
  return lines;
}

}  // namespace emscape::emfield
