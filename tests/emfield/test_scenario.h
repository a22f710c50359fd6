/// Scenarios for the tests, made in code.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/antenna/shapes.h"

namespace emscape::emfield::testing {

inline scenario::Platform fixedPlatform(const GeodeticPosition& position, double heading_deg = 0) {
  scenario::Platform platform;
  platform.name = "site";
  scenario::TrackPoint point;
  point.position.latitude_deg = position.latitude_deg;
  point.position.longitude_deg = position.longitude_deg;
  point.position.height_ellipsoid_m = position.height_ellipsoid_m;
  platform.track = {point};
  platform.attitude.heading_deg = heading_deg;
  return platform;
}

/// An isotropic transmitter of 1 kW at 1 GHz, free space.
inline scenario::Emitter plainEmitter(const std::string& name, int platform) {
  scenario::Emitter emitter;
  emitter.name = name;
  emitter.platform = platform;
  emitter.frequency_hz = 1e9;
  emitter.power_w = 1000;
  emitter.antenna = scenario::makeIsotropic();
  emitter.propagation.model = propagation::PropagationModel::free_space;
  return emitter;
}

inline std::shared_ptr<scenario::Scenario> emptyScenario(FrameKind kind, double latitude_deg,
                                                         double longitude_deg, Vec3d size_m, Dims dims) {
  auto scenario = std::make_shared<scenario::Scenario>();
  scenario->name = "test";
  scenario->file = "test.yaml";
  scenario->region = {{kind, latitude_deg, longitude_deg, 0}, size_m, dims};
  scenario->clock.duration_s = 10;
  scenario->output.floor = -300;
  return scenario;
}

/// Adds a fixed platform and an emitter on it; the emitter's platform is set.
inline void addEmitter(scenario::Scenario& scenario, const GeodeticPosition& position,
                       scenario::Emitter emitter) {
  emitter.platform = static_cast<int>(scenario.platforms.size());
  scenario.platforms.push_back(fixedPlatform(position));
  scenario.emitters.push_back(std::move(emitter));
}

/// A solver with the field of an instant.
struct SolvedField : FieldSolver {
  explicit SolvedField(const std::shared_ptr<const scenario::Scenario>& scenario,
                       const scenario::TerrainPtr& terrain = nullptr, const FieldOptions& options = {},
                       double time_s = 0)
      : FieldSolver(scenario, terrain, options) {
    update(scenario::snapshotAt(scenario, terrain.get(), time_s));
  }
};

/// Solves one instant and returns the first channel's volume.
inline std::shared_ptr<const volume::DenseVolume> solve(const std::shared_ptr<scenario::Scenario>& scenario,
                                                        const scenario::TerrainPtr& terrain = nullptr,
                                                        const FieldOptions& options = {}) {
  return SolvedField(scenario, terrain, options).volumes().front().host();
}

inline float valueAt(const volume::DenseVolume& volume, int i, int j, int k) {
  return volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
}

/// Voxels along x at whole kilometres of an emitter in the middle; straight rays (k = 1).
inline std::shared_ptr<scenario::Scenario> lineOfVoxels(double farthest_m, double spacing_m) {
  const int count = 2 * static_cast<int>(std::lround(farthest_m / spacing_m)) + 1;
  auto scenario =
      emptyScenario(FrameKind::enu, 44.3, -71.4, {count * spacing_m, 3 * spacing_m, 2000}, {count, 3, 2});
  scenario->atmosphere.k_factor = 1;
  return scenario;
}

/// The geodetic position of the voxel in the middle of the lowest layer.
inline GeodeticPosition middleOf(const scenario::Scenario& scenario) {
  const volume::Grid grid = gridOf(scenario.region);
  return GeoFrame(grid.frame).toGeodetic(grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0));
}

inline float valueEast(const volume::DenseVolume& volume, double distance_m) {
  const int steps = static_cast<int>(std::lround(distance_m / volume.grid.spacing_m.x));
  return valueAt(volume, volume.grid.dims.x / 2 + steps, volume.grid.dims.y / 2, 0);
}

}  // namespace emscape::emfield::testing
