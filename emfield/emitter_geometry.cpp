#include "emfield/emitter_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/stopwatch.h"
#include "emfield/column_geometry.h"
#include "emfield/emitter_excess.h"
#include "emfield/fill_excess.h"
#include "emfield/shadow.h"
#include "emscape/base/parallel.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

/// Samples of a fan held at once.
constexpr int kFanSamples = 1 << 23;

}  // namespace

void EmitterGeometry::compute(const scenario::EmitterState& state, const scenario::Scenario& scenario,
                              const scenario::Emitter& emitter, const GridColumns& columns,
                              const scenario::Terrain* terrain, const FanResolution& resolution,
                              Times& times) {
  Stopwatch watch;
  const Station station = makeStation(state.position, state.height_msl_m, scenario.atmosphere.k_factor);
  const std::vector<FanCoordinates> coordinates = fanCoordinates(station, columns);
  locateColumns(station, columns, coordinates);
  shadow_edge_m_.assign(column_count_, -std::numeric_limits<float>::infinity());
  excess_.clear();
  reflected_.clear();
  unknown_columns_ = 0;
  warnings_ = 0;
  const propagation::ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  const bool has_shadow = model.casts_shadow;
  std::optional<EmitterExcess> excess;
  if (hasExcess(scenario, emitter)) {
    excess = makeExcess(scenario, emitter, station, terrain, columns, resolution);
    excess_.resize(column_count_ * columns.t_m.size());
    if (model.has_reflected_ray) reflected_.resize(excess_.size());
  }
  times.fan_ms += watch.lap_ms();
  const double tilt_m = tiltOf(columns);
  const ExcessGrid grid = excessGrid(columns, resolution);
  const ExcessOutput out{excess_.data(), reflected_.data(), shadow_edge_m_.data()};
  const bool needs_terrain = excess && excess->needsTerrain();
  if (excess && !needs_terrain) {
    warnings_ |= fillExcessCpu(*excess, station, grid, {}, out);
    times.excess_ms += watch.lap_ms();
  }
  if (has_shadow || needs_terrain) {
    // Some intervals at a time, so that a fine fan over a wide region does not fill the memory.
    const FanShape shape = fanShape(station, coordinates, terrain, resolution, tilt_m);
    const int at_once = columns.tilted ? shape.interval_count : std::max(1, kFanSamples / shape.rangeCount());
    times.fan_ms += watch.lap_ms();
    for (int first = 0; first < shape.interval_count; first += at_once) {
      const int count = std::min(at_once, shape.interval_count - first);
      const TerrainFan fan = readTerrainFan(station, shape, terrain, first, count);
      times.fan_ms += watch.lap_ms();
      if (has_shadow) findShadowEdges(station, columns, coordinates, shape, fan, shadow_edge_m_);
      if (needs_terrain) {
        warnings_ |=
            fillExcessCpu(*excess, station, grid, {shape.view(), fan.height_msl_m.data(), first, count}, out);
      }
      times.excess_ms += watch.lap_ms();
    }
  }
  unknown_columns_ = std::count_if(shadow_edge_m_.begin(), shadow_edge_m_.end(),
                                   [](float edge) { return std::isnan(edge); });
  times.excess_ms += watch.lap_ms();
}

std::size_t EmitterGeometry::bytesPerVoxel(const scenario::Scenario& scenario,
                                           const scenario::Emitter& emitter) {
  const bool has_reflected = propagation::modelInfo(emitter.propagation.model).has_reflected_ray;
  return (hasExcess(scenario, emitter) ? sizeof(ExcessCode) : 0) +
         (has_reflected ? sizeof(ReflectedRayCode) : 0);
}

std::size_t EmitterGeometry::bytesOf(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                     std::size_t columns, int layers) {
  return columns * (kBytesPerColumn + static_cast<std::size_t>(layers) * bytesPerVoxel(scenario, emitter));
}

void EmitterGeometry::locateColumns(const Station& station, const GridColumns& columns,
                                    const std::vector<FanCoordinates>& coordinates) {
  column_count_ = columns.columns.size();
  arrays_.resize(kColumnNumbers * column_count_);
  const double middle_m = columns.middle_m();
  parallelFor(static_cast<int>(column_count_), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      columnGeometry(station, columns.columns[c], coordinates[c], middle_m, arrays_.data() + c,
                     column_count_);
    }
  });
}

ColumnGeometryView EmitterGeometry::view() const {
  return columnGeometryView(arrays_.data(), column_count_, shadow_edge_m_.data(),
                            excess_.empty() ? nullptr : excess_.data(),
                            reflected_.empty() ? nullptr : reflected_.data());
}

bool EmitterGeometry::isUnknown(std::size_t column) const {
  return std::isnan(shadow_edge_m_[column]);
}

}  // namespace emscape::emfield
