/// Helpers for the tests of excess losses: fields of a single emitter, and individual paths.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "emfield/excess/emitter_excess.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_profile.h"
#include "tests/emfield/random_profile.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield::testing {

constexpr double kEffectiveEarth_m = 6371000.0 * 4 / 3;

/// An isotropic emitter of 1 kW over the White Mountains, in clear air without gases.
inline std::shared_ptr<scenario::Scenario> whiteMountains(double frequency_hz, double height_agl_m,
                                                          FrameKind frame = FrameKind::altitude) {
  auto scenario = emptyScenario(frame, 44.4, -71.5, {40e3, 40e3, 4000}, {50, 50, 40});
  scenario::Emitter emitter = plainEmitter("site", 0);
  emitter.frequency_hz = frequency_hz;
  emitter.propagation.model = propagation::PropagationModel::diffraction;
  addEmitter(*scenario, {44.43, -71.47, 0}, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_agl_m = height_agl_m;
  scenario->terrain = scenario::TerrainSpec{};
  scenario->atmosphere.gases = propagation::GasLosses::never;
  return scenario;
}

/// The same over a smooth earth, 40 km x 40 km x 4 km, the emitter at 52 N 5 E.
inline std::shared_ptr<scenario::Scenario> smoothEarth(propagation::PropagationModel model,
                                                       double frequency_hz, double height_m,
                                                       double size_m = 40e3) {
  auto scenario = emptyScenario(FrameKind::altitude, 52, 5, {size_m, size_m, 4000}, {20, 21, 32});
  scenario::Emitter emitter = plainEmitter("site", 0);
  emitter.frequency_hz = frequency_hz;
  emitter.propagation.model = model;
  addEmitter(*scenario, {52, 5, 0}, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_msl_m = height_m;
  scenario->atmosphere.gases = propagation::GasLosses::never;
  return scenario;
}

/// The terrain along the geodesic from an emitter to below a point, at the field's posts.
/// @param at_crossings  see readPathProfile()
inline ProfileData profileTo(const scenario::Terrain& terrain, const GeodeticPosition& from,
                             const GeodeticPosition& to, bool at_crossings) {
  const GeodesicInverse path =
      geodesicInverse(from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg);
  ProfileData profile;
  const auto add = [&](double range_m) {
    const GeodeticPosition at =
        geodesicDirect(from.latitude_deg, from.longitude_deg, path.azimuth_rad, range_m);
    profile.range_m.push_back(range_m);
    profile.height_msl_m.push_back(
        static_cast<float>(terrain.heightMsl_m(at.latitude_deg, at.longitude_deg)));
  };
  const PathProfile posts = readPathProfile({from, 0}, {to, 0}, 4.0 / 3, &terrain, at_crossings);
  for (const double range_m : posts.ranges_m) add(range_m);
  return profile;
}

/// Excess loss (dB) at a voxel of the field of a single 1 kW emitter.
inline double excessIn(const volume::DenseVolume& volume, int i, int j, int k, const GeodeticPosition& from) {
  const GeodeticPosition to = GeoFrame(volume.grid.frame).toGeodetic(volume.grid.center_m(i, j, k));
  const double distance_m = length(toEcef(to) - toEcef(from));
  return ratioToDb(1000 / (4 * kPi * distance_m * distance_m)) -
         static_cast<double>(valueAt(volume, i, j, k));
}

/// Errors and their quantiles.
class Spread {
 public:
  void add(double error_db) { errors_db_.push_back(std::abs(error_db)); }
  std::size_t size() const { return errors_db_.size(); }
  double quantile(double part) {
    std::sort(errors_db_.begin(), errors_db_.end());
    return errors_db_[static_cast<std::size_t>(part * static_cast<double>(errors_db_.size() - 1))];
  }
  double median() { return quantile(0.5); }
  double largest() { return quantile(1); }

 private:
  std::vector<double> errors_db_;
};

}  // namespace emscape::emfield::testing
