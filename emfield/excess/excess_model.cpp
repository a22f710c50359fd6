#include "emfield/excess/excess_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::emfield {
namespace {

using scenario::DiffractionMethod;
using scenario::Emitter;
using scenario::Polarization;
using scenario::PropagationModel;
using scenario::Scenario;

bool isLinear(Polarization polarization) {
  return polarization == Polarization::horizontal || polarization == Polarization::vertical;
}

/// How the wave lies to the ground. Mixed polarisations count as vertical, the part that is diffracted more
/// strongly.
LinearPolarization linearPolarization(Polarization polarization) {
  return polarization == Polarization::horizontal ? LinearPolarization::horizontal
                                                  : LinearPolarization::vertical;
}

ItmClimate itmClimate(scenario::RadioClimate climate) {
  switch (climate) {
    case scenario::RadioClimate::equatorial:
      return ItmClimate::equatorial;
    case scenario::RadioClimate::continental_subtropical:
      return ItmClimate::continental_subtropical;
    case scenario::RadioClimate::maritime_subtropical:
      return ItmClimate::maritime_subtropical;
    case scenario::RadioClimate::desert:
      return ItmClimate::desert;
    case scenario::RadioClimate::continental_temperate:
      return ItmClimate::continental_temperate;
    case scenario::RadioClimate::maritime_temperate_over_land:
      return ItmClimate::maritime_temperate_over_land;
    case scenario::RadioClimate::maritime_temperate_over_sea:
      return ItmClimate::maritime_temperate_over_sea;
  }
  throw Error(ErrorCode::other, "itm: unknown climate");
}

/// ITM's mode of variability (mdvar, 0..3).
int itmVariability(scenario::ItmService service) {
  switch (service) {
    case scenario::ItmService::single_message:
      return 0;
    case scenario::ItmService::individual:
      return 1;
    case scenario::ItmService::mobile:
      return 2;
    case scenario::ItmService::broadcast:
      return 3;
  }
  throw Error(ErrorCode::other, "itm: unknown service");
}

DiffractionExcess diffractionExcess(const Scenario& scenario, const Emitter& emitter,
                                    const Station& station) {
  DiffractionParameters parameters;
  parameters.frequency_hz = emitter.frequency_hz;
  parameters.effective_earth_radius_m = station.effective_earth_radius_m;
  parameters.polarization = linearPolarization(emitter.polarization);
  parameters.land = groundConstants(scenario.ground, emitter.frequency_hz);
  return {diffractionModel<float>(parameters), static_cast<float>(station.height_msl_m)};
}

TwoRayExcess twoRayExcess(const Scenario& scenario, const Emitter& emitter, const Station& station,
                          double surface_msl_m) {
  TwoRayParameters parameters;
  parameters.frequency_hz = emitter.frequency_hz;
  parameters.effective_earth_radius_m = station.effective_earth_radius_m;
  parameters.ground = groundConstants(scenario.ground, emitter.frequency_hz);
  parameters.roughness_m = scenario.ground.roughness_m;
  parameters.roughness_model = emitter.two_ray.roughness_model;
  parameters.sum = emitter.two_ray.sum;
  TwoRayExcess excess;
  excess.both = !isLinear(emitter.polarization);
  parameters.polarization = emitter.polarization == Polarization::vertical ? LinearPolarization::vertical
                                                                           : LinearPolarization::horizontal;
  excess.model = twoRayModel<double>(parameters);
  parameters.polarization = LinearPolarization::vertical;
  excess.vertical = twoRayModel<double>(parameters);
  excess.surface_msl_m = surface_msl_m;
  excess.tx_msl_m = station.height_msl_m;
  return excess;
}

ItmExcess itmExcess(const Scenario& scenario, const Emitter& emitter, const Station& station,
                    const FanResolution& resolution) {
  ItmExcess excess;
  excess.diffraction = diffractionExcess(scenario, emitter, station);
  excess.link = itmLink(scenario, emitter);
  excess.quantiles = itmQuantiles(emitter.itm);
  excess.is_area = emitter.itm.form == scenario::ItmForm::area;
  excess.area.irregularity_m = static_cast<float>(emitter.itm.irregularity_m);
  excess.area.siting[0] = emitter.itm.transmitter_siting;
  excess.area.siting[1] = emitter.itm.receiver_siting;
  excess.step_m = resolution.arc_m;  // as the posts lie
  return excess;
}

}  // namespace

GroundConstants groundConstants(const scenario::Ground& ground, double frequency_hz) {
  GroundConstants constants = groundConstants(ground.kind, frequency_hz);
  constants.relative_permittivity = ground.relative_permittivity.value_or(constants.relative_permittivity);
  constants.conductivity_s_per_m = ground.conductivity_s_m.value_or(constants.conductivity_s_per_m);
  return constants;
}

ItmLink<float> itmLink(const Scenario& scenario, const Emitter& emitter) {
  const GroundConstants ground = groundConstants(scenario.ground, emitter.frequency_hz);
  ItmLink<float> link;
  link.frequency_hz = static_cast<float>(emitter.frequency_hz);
  link.vertical_polarization = linearPolarization(emitter.polarization) == LinearPolarization::vertical;
  link.relative_permittivity = static_cast<float>(ground.relative_permittivity);
  link.conductivity_s_m = static_cast<float>(ground.conductivity_s_per_m);
  link.sea_level_refractivity = static_cast<float>(scenario.atmosphere.sea_level_refractivity);
  link.climate = itmClimate(scenario.atmosphere.climate);
  // Where the terrain is known the place does not vary: 10 more.
  link.variability_mode =
      itmVariability(emitter.itm.service) + (emitter.itm.form == scenario::ItmForm::point_to_point ? 10 : 0);
  return link;
}

ItmQuantiles<float> itmQuantiles(const scenario::ItmSettings& settings) {
  return {static_cast<float>(settings.time_percent), static_cast<float>(settings.location_percent),
          static_cast<float>(settings.situation_percent)};
}

double smoothSurface_msl_m(const Scenario& scenario, const Emitter& emitter, const Station& station,
                           const scenario::Terrain* terrain) {
  if (scenario.ground.surface_msl_m) return *scenario.ground.surface_msl_m;
  if (terrain == nullptr) return 0;
  const double ground_m =
      terrain->heightMsl_m(radToDeg(station.geodesy.latitude_rad), radToDeg(station.geodesy.longitude_rad));
  if (std::isnan(ground_m)) {
    throw Error(ErrorCode::bad_input, emitter.place,
                fmt::format("emitter '{}': '{}' stands on a smooth surface at the height of the ground below "
                            "the emitter, and that is missing; the key 'surface_msl_m' of 'ground' sets it",
                            emitter.name, scenario::toString(emitter.propagation)));
  }
  return ground_m;
}

bool hasExcess(const Scenario& scenario, const Emitter& emitter) {
  const bool is_bound =
      emitter.propagation == PropagationModel::free_space || emitter.propagation == PropagationModel::horizon;
  return !is_bound || hasAirLoss(scenario, emitter);
}

bool needsPathExtent(const Scenario& scenario, const Emitter& emitter) {
  return emitter.propagation == PropagationModel::p528 || hasAirLoss(scenario, emitter);
}

PathExtent pathExtent(const Station& station, const GridColumns& columns) {
  // A grid's corners hold its farthest columns; they or its middle those whose heights reach farthest.
  PathExtent extent;
  extent.lowest_msl_m = HUGE_VAL;
  extent.highest_msl_m = -HUGE_VAL;
  const auto take = [&](int i, int j) {
    const GridColumn& column = columns.columns[static_cast<std::size_t>(j) * columns.dims.x + i];
    for (const float t_m : {columns.t_m.front(), columns.t_m.back()}) {
      const double height_m = heightMsl_m(column, static_cast<double>(t_m));
      extent.lowest_msl_m = std::min(extent.lowest_msl_m, height_m);
      extent.highest_msl_m = std::max(extent.highest_msl_m, height_m);
      extent.farthest_m = std::max(extent.farthest_m, fanCoordinates(station, column, t_m).range_m);
    }
  };
  for (const int i : {0, columns.dims.x / 2, columns.dims.x - 1}) {
    for (const int j : {0, columns.dims.y / 2, columns.dims.y - 1}) take(i, j);
  }
  return extent;
}

EmitterExcess makeExcess(const Scenario& scenario, const Emitter& emitter, const Station& station,
                         const scenario::Terrain* terrain, const PathExtent& extent,
                         const FanResolution& resolution) {
  EmitterExcess excess;
  const auto model_tables = std::make_shared<std::vector<float>>();
  const auto air_tables = std::make_shared<std::vector<float>>();
  excess.model_tables = model_tables;
  excess.air_tables = air_tables;
  switch (emitter.propagation) {
    case PropagationModel::free_space:
    case PropagationModel::horizon:
      break;
    case PropagationModel::diffraction: {
      const DiffractionExcess diffraction = diffractionExcess(scenario, emitter, station);
      if (emitter.diffraction.method == DiffractionMethod::delta_bullington) {
        excess.model = diffraction;
      } else {
        excess.model = EdgeExcess{diffraction.model, diffraction.tx_msl_m,
                                  emitter.diffraction.method == DiffractionMethod::deygout};
      }
      break;
    }
    case PropagationModel::two_ray:
      excess.model =
          twoRayExcess(scenario, emitter, station, smoothSurface_msl_m(scenario, emitter, station, terrain));
      break;
    case PropagationModel::itm:
      excess.model = itmExcess(scenario, emitter, station, resolution);
      break;
    case PropagationModel::p528: {
      const double surface_msl_m = smoothSurface_msl_m(scenario, emitter, station, terrain);
      excess.model =
          p528Excess(emitter, station.height_msl_m - surface_msl_m, surface_msl_m, extent, *model_tables);
      break;
    }
  }
  if (hasAirLoss(scenario, emitter)) {
    excess.air = airLoss(scenario, emitter, radToDeg(station.geodesy.latitude_rad), station.height_msl_m,
                         station.earth_radius_m, extent, *air_tables);
  }
  return excess;
}

EmitterExcess EmitterExcess::withTablesAt(const float* model_tables_copy,
                                          const float* air_tables_copy) const {
  EmitterExcess moved = *this;
  if (auto* const p528 = std::get_if<P528Excess>(&moved.model)) {
    p528->horizon_m = model_tables_copy + (p528->horizon_m - model_tables->data());
    p528->excess_db = model_tables_copy + (p528->excess_db - model_tables->data());
  }
  if (moved.air.gases != nullptr) moved.air.gases = air_tables_copy;
  return moved;
}

bool EmitterExcess::needsTerrain() const {
  return std::visit([](const auto& m) { return std::decay_t<decltype(m)>::kNeedsTerrain; }, model);
}

std::vector<std::string> remarkMessages(const Emitter& emitter, unsigned remarks) {
  std::vector<std::string> messages;
  if (emitter.propagation != PropagationModel::itm) return messages;
  std::string all;
  for (const std::string& message : itmMessages(remarks & ~(kMissingTerrain | kItmRefused))) {
    all += (all.empty() ? "on some paths: " : "; ") + message;
  }
  if (!all.empty()) messages.push_back(all);
  if ((remarks & kItmRefused) != 0) {
    messages.push_back(
        "paths refused, on which 'diffraction' stands instead: the refractivity at the surface "
        "or the effective earth is outside the model's limits");
  }
  return messages;
}

}  // namespace emscape::emfield
