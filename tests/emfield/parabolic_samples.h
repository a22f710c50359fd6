/// Scenarios of one emitter with the model parabolic_equation, and what its field is made from.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "emfield/columns/foot_inverse.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/radials.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "propagation/parabolic_equation/model.h"
#include "propagation/parabolic_equation/plan.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"

namespace emscape::emfield::testing {

using propagation::PePlan;
using propagation::RadialInputs;

constexpr double kLatitude_deg = 51, kLongitude_deg = 5;

/// One emitter in the middle of a region, antenna at a height above mean sea level.
inline std::shared_ptr<scenario::Scenario> around(double frequency_hz, double height_msl_m, Vec3d size_m,
                                                  Dims dims, double lowest_msl_m = 0) {
  auto scenario = emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, size_m, dims);
  scenario->region.origin.height_msl_m = lowest_msl_m;
  scenario->atmosphere.gases = propagation::GasLosses::never;
  scenario::Emitter emitter = plainEmitter("tower", 0);
  emitter.frequency_hz = frequency_hz;
  emitter.polarization = propagation::Polarization::horizontal;
  emitter.propagation.model = propagation::PropagationModel::parabolic_equation;
  addEmitter(*scenario, {kLatitude_deg, kLongitude_deg, 0}, emitter);
  scenario::SitePosition& site = scenario->platforms[0].track[0].position;
  site.height_ellipsoid_m.reset();
  site.height_msl_m = height_msl_m;
  return scenario;
}

/// Gentle hills, 60 m high and some 5 km apart.
inline scenario::TerrainPtr gentleHills() {
  return std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 1.0, [](double east, double north) {
        return 100 + 30 * std::sin(80 * east + 1) * std::cos(50 * north) +
               15 * std::sin(190 * north + 40 * east);
      });
}

/// Moves region and emitter to a position on the terrain of a file.
/// @param antenna_agl_m  above the ground
inline scenario::TerrainPtr standOn(const char* file, double latitude_deg, double longitude_deg,
                                    double antenna_agl_m, scenario::Scenario& scenario) {
  scenario::SitePosition& site = scenario.platforms[0].track[0].position;
  scenario.region.origin.latitude_deg = site.latitude_deg = latitude_deg;
  scenario.region.origin.longitude_deg = site.longitude_deg = longitude_deg;
  scenario::TerrainSpec spec;
  spec.files = {test::sourceFile(file)};
  spec.locations = {{spec.files[0]}};
  const auto terrain = scenario::Terrain::load(spec, scenario::terrainBox(scenario));
  site.height_msl_m = terrain->heightMsl_m(latitude_deg, longitude_deg) + antenna_agl_m;
  return terrain;
}

/// What the excess of the first emitter is made from.
struct Made {
  Station station;
  GridColumns columns;
  RadialInputs radials;
  propagation::PathInputs inputs;
  PePlan plan;

  Made(const scenario::Scenario& scenario, const scenario::Terrain* terrain)
      : station(makeStation(stateOf(scenario, terrain).position, stateOf(scenario, terrain).height_msl_m,
                            scenario.atmosphere)),
        columns(makeGridColumns(gridOf(scenario.region), terrain)),
        radials(radialInputs(station, columns, terrain, pathExtent(station, columns))),
        inputs(pathInputs(scenario, scenario.emitters[0], stateOf(scenario, terrain).beam, station, terrain,
                          pathExtent(station, columns))),
        plan(planMarch(inputs, radials, propagation::domainNeeds(inputs, radials))) {}

  static scenario::EmitterState stateOf(const scenario::Scenario& scenario,
                                        const scenario::Terrain* terrain) {
    return scenario::snapshotAt(std::make_shared<scenario::Scenario>(scenario), terrain, 0).emitters[0];
  }
};

/// The excess, its march done.
struct Marched {
  std::vector<float> tables;
  propagation::PeExcess excess;

  explicit Marched(const Made& made) {
    propagation::PeField field = peField(made.inputs, made.radials);
    tables.resize(field.march.cellCount());
    excess = field.excess;
    marchField(field.march, tables.data());
    excess.tables = tables.data();
  }
};

/// Excess (dB) of the emitter's voxels: with an isotropic antenna the rest is free space.
inline double excessIn(const volume::DenseVolume& volume, const Made& made, int i, int j, int k) {
  const GridColumn column = made.columns.view()[static_cast<std::size_t>(j * volume.grid.dims.x + i)];
  const Vec3d position =
      column.base_ecef_m + column.axis * static_cast<double>(made.columns.t_m[static_cast<std::size_t>(k)]);
  const double distance_m = length(position - made.station.ecef_m);
  return 10 * std::log10(1000 / (4 * kPi * distance_m * distance_m)) -
         static_cast<double>(valueAt(volume, i, j, k));
}

inline std::shared_ptr<propagation::Refractivity> duct(std::vector<double> heights_m) {
  auto refractivity = std::make_shared<propagation::Refractivity>();
  const auto airOf = [](double height_m) {
    propagation::RefractivityField field;
    field.profiles = {propagation::evaporationDuct(height_m)};
    return field;
  };
  refractivity->air = airOf(heights_m.front());
  if (heights_m.size() > 1)
    for (const double height_m : heights_m) refractivity->members.push_back(airOf(height_m));
  return refractivity;
}

/// A radar 10 m above the sea at 10 GHz.
inline std::shared_ptr<scenario::Scenario> overTheSea(double highest_m, int layers) {
  const auto scenario = around(10e9, 10, {160e3, 300, highest_m}, {160, 3, layers});
  scenario->ground.kind = propagation::GroundKind::sea;
  return scenario;
}

inline double quantileOf(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

inline void recordDifferences(const std::string& what, const std::vector<double>& differences_db) {
  for (const double part : {0.5, 0.9, 0.98, 1.0})
    ::testing::Test::RecordProperty(what + " " + std::to_string(part),
                                    std::to_string(quantileOf(differences_db, part)));
}

}  // namespace emscape::emfield::testing
