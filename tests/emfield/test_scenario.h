/// Scenarios for the tests, made in code.
#pragma once

#include <memory>
#include <string>

#include "emfield/field_solver.h"
#include "scenario/antenna_shapes.h"
#include "scenario/scenario.h"
#include "scenario/snapshot.h"

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
  emitter.propagation = scenario::PropagationModel::free_space;
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

/// Solves one instant and returns the first channel's volume.
inline std::shared_ptr<const volume::DenseVolume> solve(const std::shared_ptr<scenario::Scenario>& scenario,
                                                        const scenario::TerrainPtr& terrain = nullptr,
                                                        const FieldOptions& options = {}) {
  FieldSolver solver(scenario, terrain, options);
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0));
  return solver.volumes().front();
}

inline float valueAt(const volume::DenseVolume& volume, int i, int j, int k) {
  return volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))];
}

}  // namespace emscape::emfield::testing
