#include "emfield/excess/emitter_excess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "emfield/columns/foot_inverse.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/excess/elevation_cut.h"
#include "emfield/excess/radials.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "propagation/normal_deviate.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using propagation::ModelInfo;
using propagation::PathExtent;
using propagation::PathInputs;
using scenario::Emitter;
using scenario::Scenario;

/// True if a model's excess points to tables.
template <class Model, class = void>
struct HasTables : std::false_type {};
template <class Model>
struct HasTables<Model, std::void_t<decltype(Model::tables)>> : std::true_type {};

/// Height (m above mean sea level) of the smooth surface below an emitter.
/// @throws Error (bad_input) if it is the ground and that is missing
double smoothSurface_msl_m(const Scenario& scenario, const Emitter& emitter, const ModelInfo& model,
                           const Station& station, const scenario::Terrain* terrain) {
  if (scenario.ground.surface_msl_m) return *scenario.ground.surface_msl_m;
  if (terrain == nullptr) return 0;
  const double ground_m = terrain->heightMsl_m(station.latitude_deg, station.longitude_deg);
  if (std::isnan(ground_m)) {
    throw Error(ErrorCode::bad_input, emitter.location,
                fmt::format("emitter '{}': '{}' stands on a smooth surface at the height of the ground below "
                            "the emitter, and that is missing; the key 'surface_msl_m' of 'ground' sets it",
                            emitter.name, model.name));
  }
  return ground_m;
}

/// The points of a surface as seen from a station.
propagation::PathPoints pathPoints(const Station& station, const GridColumns& columns) {
  propagation::PathPoints points;
  points.range_m.resize(columns.count());
  points.base_msl_m.resize(columns.count());
  points.above_base_m = columns.t_m;
  const auto layers = static_cast<std::uint16_t>(columns.t_m.size());
  parallelFor(static_cast<int>(columns.count()), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const PositionColumn& column = columns.of_surface[c];
      const bool is_left_out = columns.first_valid_k[c] >= layers;
      points.range_m[c] = is_left_out ? NAN : fastInverse(station.geodesy, column.foot_ecef_m).distance_m;
      points.base_msl_m[c] = column.base_msl_m;
    }
  });
  return points;
}

}  // namespace

EmitterExcess EmitterExcess::withTablesAt(const float* model_tables_copy,
                                          const float* air_tables_copy) const {
  EmitterExcess moved = *this;
  std::visit(
      [&](auto& m) {
        if constexpr (HasTables<std::decay_t<decltype(m)>>::value) m.tables = model_tables_copy;
      },
      moved.model);
  if (moved.air.gases != nullptr) moved.air.gases = air_tables_copy;
  return moved;
}

propagation::EmitterInputs emitterInputs(const Scenario& scenario, const Emitter& emitter) {
  propagation::EmitterInputs inputs{emitter.frequency_hz, emitter.polarization, emitter.propagation,
                                    scenario.ground, scenario.atmosphere};
  if (scenario::hasClutterMap(scenario))
    inputs.ground.terminal_clutter = propagation::TerminalClutterModel::none;
  return inputs;
}

propagation::TerminalClutter terminalClutter(const Scenario& scenario, const Emitter& emitter,
                                             const Station& station, const scenario::Terrain* terrain) {
  const propagation::EmitterInputs inputs = emitterInputs(scenario, emitter);
  if (!propagation::hasTerminalClutter(inputs)) return {};
  const propagation::Ground& ground = inputs.ground;
  propagation::TerminalClutter clutter;
  clutter.frequency_ghz = static_cast<float>(emitter.frequency_hz / 1e9);
  clutter.deviate = static_cast<float>(-propagation::normalDeviate(ground.terminal_clutter_percent / 100));
  clutter.below_m = static_cast<float>(ground.terminal_clutter_below_m);
  clutter.is_larger = ground.terminal_clutter_combine == propagation::ClutterCombination::larger;
  const double ground_msl_m =
      terrain == nullptr ? 0 : terrain->heightMsl_m(station.latitude_deg, station.longitude_deg);
  clutter.at_transmitter = static_cast<float>(station.height_msl_m - ground_msl_m) <= clutter.below_m;
  return clutter;
}

PathInputs pathInputs(const Scenario& scenario, const Emitter& emitter, const scenario::BeamPose& beam,
                      const Station& station, const scenario::Terrain* terrain, const PathExtent& extent) {
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  PathInputs inputs;
  inputs.emitter = emitterInputs(scenario, emitter);
  inputs.site = station;
  if (model.on_smooth_surface) {
    inputs.surface_msl_m = smoothSurface_msl_m(scenario, emitter, model, station, terrain);
  }
  inputs.extent = extent;
  inputs.post_spacing_m = postSpacing_m(terrain);
  if (auto cut = elevationCut(emitter, beam)) inputs.elevation_pattern = std::move(*cut);
  return inputs;
}

PathExtent pathExtent(const Station& station, const GridColumns& columns) {
  PathExtent extent;
  extent.lowest_msl_m = columns.lowest_msl_m;
  extent.highest_msl_m = columns.highest_msl_m;
  for (const GridColumn& column : columns.outline) {
    for (const float t_m : {columns.t_m.front(), columns.t_m.back()}) {
      extent.farthest_m = std::max(extent.farthest_m,
                                   footInverse(station, column, t_m).distance_m + columns.beyond_outline_m);
    }
  }
  return extent;
}

void inModel(const Emitter& emitter, const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    throw Error(error.code(), emitter.propagation.location,
                fmt::format("emitter '{}': '{}': {}", emitter.name, toString(emitter.propagation.model),
                            error.message()));
  }
}

bool hasExcess(const Scenario& scenario, const Emitter& emitter) {
  return propagation::hasExcess(emitterInputs(scenario, emitter));
}

bool needsHostColumns(const Scenario& scenario) {
  return std::any_of(scenario.emitters.begin(), scenario.emitters.end(), [](const Emitter& emitter) {
    const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
    return model.radial != nullptr || model.excess_at != nullptr;
  });
}

EmitterExcess planExcess(const PathInputs& inputs, const propagation::RadialInputs* radials,
                         const propagation::PathPoints* points) {
  const ModelInfo& model = propagation::modelInfo(inputs.emitter.settings.model);
  const auto model_tables = std::make_shared<std::vector<float>>();
  const auto air_tables = std::make_shared<std::vector<float>>();
  EmitterExcess excess;
  if (points != nullptr && model.excess_at != nullptr) {
    excess.model = model.excess_at(inputs, *points, *model_tables);
  } else if (model.excess != nullptr) {
    excess.model = model.excess(inputs, *model_tables);
  }
  if (model.radial != nullptr) {
    propagation::RadialExcess planned = model.radial(inputs, *radials);
    excess.model = planned.model;
    excess.march = std::make_shared<propagation::FieldMarch>(std::move(planned.march));
    if (planned.steep)
      excess.steep = std::make_shared<const propagation::SteepGround>(*std::move(planned.steep));
  }
  if (propagation::hasAirLoss(inputs.emitter)) {
    excess.air = propagation::airLoss(inputs, propagation::hasGases(inputs.emitter), *air_tables);
  }
  excess.model_tables = model_tables;
  excess.air_tables = air_tables;
  return excess;
}

EmitterExcess planExcess(const Scenario& scenario, const Emitter& emitter, const scenario::BeamPose& beam,
                         const Station& station, const scenario::Terrain* terrain,
                         const GridColumns& columns) {
  EmitterExcess excess;
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  const bool needs_extent = propagation::needsExtent(emitterInputs(scenario, emitter));
  if (model.radial == nullptr) {
    std::optional<propagation::PathPoints> points;
    if (columns.every_height && model.excess_at != nullptr) points = pathPoints(station, columns);
    excess = planExcess(pathInputs(scenario, emitter, beam, station, terrain,
                                   needs_extent ? pathExtent(station, columns) : PathExtent{}),
                        nullptr, points ? &*points : nullptr);
    excess.terminal = terminalClutter(scenario, emitter, station, terrain);
    excess.is_raised = propagation::isRaisedByClutter(emitter.propagation);
    excess.has_clutter = hasClutter(emitter.propagation, terrain);
    return excess;
  }
  inModel(emitter, [&] {
    const PathExtent extent = pathExtent(station, columns);
    const propagation::RadialInputs radials = radialInputs(station, columns, terrain, extent);
    excess = planExcess(pathInputs(scenario, emitter, beam, station, terrain, extent), &radials);
  });
  return excess;
}

void marchTables(const Emitter& emitter, EmitterExcess& excess) {
  if (excess.march == nullptr) return;
  const auto tables = std::make_shared<std::vector<float>>(excess.march->cellCount());
  auto& model = std::get<propagation::PeExcess>(excess.model);
  inModel(emitter, [&] { propagation::marchField(*excess.march, tables->data()); });
  model.tables = tables->data();
  excess.model_tables = tables;
  excess.march.reset();
}

}  // namespace emscape::emfield
