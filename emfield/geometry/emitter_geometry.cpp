#include "emfield/geometry/emitter_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/large_array.h"
#include "base/stopwatch.h"
#include "emfield/columns/column_geometry.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/fill_excess.h"
#include "emfield/excess/interpolate_columns.h"
#include "emfield/excess/shadow.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/field_march.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

bool isSameColumn(const ColumnsView& columns, int a, int b) {
  if (columns.of_surface == nullptr) return false;
  const PositionColumn &first = columns.of_surface[a], &second = columns.of_surface[b];
  return first.foot_ecef_m == second.foot_ecef_m && first.base_ellipsoid_m == second.base_ellipsoid_m;
}

}  // namespace

void EmitterGeometry::compute(const scenario::EmitterState& state, const scenario::Scenario& scenario,
                              const scenario::Emitter& emitter, const GridColumns& columns,
                              const scenario::Terrain* terrain, Times& times, const TerrainBounds* bounds,
                              const GeometryNeeds& needs, ColumnPart part) {
  Stopwatch watch;
  if (!interpolates(scenario, emitter, columns, needs)) part = {};
  const bool continues = part.known > 0;
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere);
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  const bool needs_paths = !columns.tilted && (model.casts_shadow || hasExcess(scenario, emitter));
  UnsetVector<FastInverse> paths(needs_paths ? columns.count() : 0);
  locateColumns(station, columns, needs_paths ? paths.data() : nullptr);
  constexpr float kNoShadow_m = -std::numeric_limits<float>::infinity();
  if (continues) {
    for (std::size_t c = 0; c < column_count_; ++c) {
      if (part.contains(columns.dims, c)) shadow_edge_m_[c] = kNoShadow_m;
    }
  } else {
    shadow_edge_m_.assign(column_count_, kNoShadow_m);
    excess_.clear();
    excess_db_.clear();
    reflected_.clear();
    mechanisms_.clear();
    clutter_.clear();
    warnings_ = 0;
    steep_.reset();
  }
  column_step_ = part.step;
  times.columns_ms += watch.lap_ms();

  ExcessGrid grid = excessGrid(columns, terrain);
  grid.part = part;
  if (needs_paths) grid.paths = paths.data();
  const propagation::PathExtent extent = pathExtent(station, columns);
  const std::vector<double> ranges_m = postRanges(extent.farthest_m, postSpacing_m(terrain));
  const GroundPosts ground = groundPosts(terrain, ranges_m);
  times.excess_ms += watch.lap_ms();
  const auto endPart = [&] {
    const double ms = watch.lap_ms();
    times.excess_ms += ms;
    times.of_part_ms += ms;
  };
  if (model.casts_shadow) findShadowEdgesCpu(station, ground, grid, bounds, shadow_edge_m_.data());
  endPart();
  ExcessStore store;
  if (hasExcess(scenario, emitter)) {
    EmitterExcess excess = planExcess(scenario, emitter, state.beam, station, terrain, columns);
    times.excess_ms += watch.lap_ms();
    steep_ = excess.steep;
    if (excess.march != nullptr) times.marched_heights += excess.march->heights();
    marchTables(emitter, excess);
    times.march_ms += watch.lap_ms();
    const std::size_t voxels = column_count_ * columns.t_m.size();
    resizeInParts(excess_, columns.every_height ? 0 : voxels);
    excess_db_.resize(columns.every_height ? voxels : 0);
    if (model.has_reflected_ray) resizeInParts(reflected_, voxels);
    if (needs.mechanisms && hasMechanisms(model)) resizeInParts(mechanisms_, voxels);
    store = {excess_.empty() ? nullptr : excess_.data(), excess_db_.empty() ? nullptr : excess_db_.data()};
    times.excess_ms += watch.lap_ms();
    warnings_ |= fillExcessCpu(excess, station, grid, ground, bounds,
                               {store, reflected_.data(), mechanisms_.empty() ? nullptr : mechanisms_.data(),
                                shadow_edge_m_.data()});
    endPart();
  }
  if (part.step > 1) interpolateColumnsCpu(grid, {store, nullptr, nullptr, shadow_edge_m_.data()});
  unknown_columns_ = std::count_if(shadow_edge_m_.begin(), shadow_edge_m_.end(),
                                   [](float edge) { return std::isnan(edge); });
  if (needs.clutter_map && !continues) mapClutter(scenario, emitter, station, extent, terrain);
  times.excess_ms += watch.lap_ms();
}

bool EmitterGeometry::interpolates(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                   const GridColumns& columns, const GeometryNeeds& needs) {
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  return !columns.every_height && (model.casts_shadow || hasExcess(scenario, emitter)) &&
         model.radial == nullptr && !model.has_reflected_ray && !(needs.mechanisms && hasMechanisms(model));
}

void EmitterGeometry::mapClutter(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                 const Station& station, const propagation::PathExtent& extent,
                                 const scenario::Terrain* terrain) {
  std::optional<ClutterMapTask> task = clutterMapTask(scenario, emitter, station, &extent);
  if (!task) return;
  const std::vector<double> ranges_m = clutterPostRanges(task->grid, postSpacing_m(terrain));
  task->ground = groundPosts(terrain, ranges_m);
  clutter_grid_ = task->grid;
  clutter_.resize(clutter_grid_.cells());
  fillClutterMapCpu(*task, clutter_.data());
}

std::size_t EmitterGeometry::bytesPerVoxel(const scenario::Scenario& scenario,
                                           const scenario::Emitter& emitter, bool on_surface,
                                           const GeometryNeeds& needs) {
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  const std::size_t of_excess = on_surface ? sizeof(float) : sizeof(ExcessCode);
  return (hasExcess(scenario, emitter) ? of_excess : 0) +
         (model.has_reflected_ray ? sizeof(ReflectedRayCode) : 0) +
         (on_surface && model.excess_at != nullptr ? sizeof(float) : 0) +
         (needs.mechanisms && hasMechanisms(model) ? 1 : 0);
}

std::size_t EmitterGeometry::bytesOf(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                     std::size_t columns, int layers, bool on_surface,
                                     const GeometryNeeds& needs) {
  return columns * (kBytesPerColumn +
                    static_cast<std::size_t>(layers) * bytesPerVoxel(scenario, emitter, on_surface, needs)) +
         clutterMapBytes(emitter);
}

void EmitterGeometry::locateColumns(const Station& station, const GridColumns& columns, FastInverse* paths) {
  column_count_ = columns.count();
  arrays_.resize(kColumnNumbers * column_count_);
  const double middle_m = columns.middle_m();
  const ColumnsView view = columns.view();
  parallelFor(static_cast<int>(column_count_), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      if (c > begin && isSameColumn(view, c - 1, c)) {  // positions that are left out
        for (int n = 0; n < kColumnNumbers; ++n)
          arrays_[n * column_count_ + c] = arrays_[n * column_count_ + c - 1];
        if (paths != nullptr) paths[c] = paths[c - 1];
        continue;
      }
      const GridColumn column = view[c];
      const FastInverse path = footInverse(station, column, middle_m);
      columnGeometry(station, column, path, middle_m, arrays_.data() + c, column_count_);
      if (paths != nullptr) paths[c] = path;
    }
  });
}

ColumnGeometryView EmitterGeometry::view() const {
  return columnGeometryView(
      arrays_.data(), column_count_, shadow_edge_m_.data(),
      {excess_.empty() ? nullptr : excess_.data(), excess_db_.empty() ? nullptr : excess_db_.data()},
      reflected_.empty() ? nullptr : reflected_.data(), mechanisms_.empty() ? nullptr : mechanisms_.data());
}

bool EmitterGeometry::isUnknown(std::size_t column) const {
  return std::isnan(shadow_edge_m_[column]);
}

}  // namespace emscape::emfield
