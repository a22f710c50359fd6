// The excess loss in the field against the models path by path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/geoid.h"
#include "base/units.h"
#include "emfield/excess/excess_code.h"
#include "emfield/models/diffraction.h"
#include "emfield/terrain_fan.h"
#include "tests/emfield/random_profile.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::PropagationModel;

constexpr double kEarth_m = 6371000.0 * 4 / 3;

/// An isotropic emitter of 1 kW in the White Mountains.
std::shared_ptr<scenario::Scenario> whiteMountains(double frequency_hz, double height_agl_m,
                                                   FrameKind frame = FrameKind::altitude) {
  auto scenario = emptyScenario(frame, 44.4, -71.5, {40e3, 40e3, 4000}, {50, 50, 40});
  if (frame == FrameKind::enu) scenario->region.origin.height_msl_m = 0;
  scenario::Emitter emitter = plainEmitter("site", 0);
  emitter.frequency_hz = frequency_hz;
  emitter.propagation = PropagationModel::diffraction;
  addEmitter(*scenario, {44.43, -71.47, 0}, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_agl_m = height_agl_m;
  scenario->terrain = scenario::TerrainSpec{};
  return scenario;
}

/// The terrain along the geodesic from an emitter to below a point, at a fan's ranges.
ProfileData profileTo(const scenario::Terrain& terrain, const GeodeticPosition& from,
                      const GeodeticPosition& to, double even_step_m) {
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
  for (const double range_m : fanRanges(path.distance_m, even_step_m)) {
    if (range_m < path.distance_m) add(range_m);
  }
  add(path.distance_m);
  return profile;
}

/// The excess (dB) that a voxel of a lone emitter of 1 kW holds.
double excessIn(const volume::DenseVolume& volume, int i, int j, int k, const GeodeticPosition& from) {
  const GeodeticPosition to = GeoFrame(volume.grid.frame).toGeodetic(volume.grid.center_m(i, j, k));
  const double distance_m = length(toEcef(to) - toEcef(from));
  return ratioToDb(1000 / (4 * kPi * distance_m * distance_m)) -
         static_cast<double>(valueAt(volume, i, j, k));
}

struct Spread {
  std::vector<double> errors_db;

  double quantile(double part) {
    std::sort(errors_db.begin(), errors_db.end());
    return errors_db[static_cast<std::size_t>(part * static_cast<double>(errors_db.size() - 1))];
  }
};

TEST(Excess, DiffractionInTheFieldAgreesWithTheModelPathByPathOverRealTerrain) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  if (!terrain) GTEST_SKIP() << "no dem/N44W072.hgt among the reference data";
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    for (const double frequency_hz : {100e6, 1e9, 10e9}) {
      SCOPED_TRACE(::testing::Message() << toString(frame) << ", " << frequency_hz << " Hz");
      const auto scenario = whiteMountains(frequency_hz, 15, frame);
      const auto volume = solve(scenario, terrain);
      const scenario::EmitterState state = scenario::snapshotAt(scenario, terrain.get(), 0).emitters[0];
      DiffractionParameters parameters;
      parameters.frequency_hz = frequency_hz;
      parameters.effective_earth_radius_m = kEarth_m;
      parameters.polarization = LinearPolarization::vertical;
      const auto model = diffractionModel<double>(parameters);
      const double step_m = fanResolution(volume->grid, terrain.get()).range_m;
      const GeoFrame geo(volume->grid.frame);

      std::mt19937 random(7);
      Spread spread;
      while (spread.errors_db.size() < 400) {
        const int i = int(random() % 50), j = int(random() % 50), k = int(random() % 40);
        const Vec3d center = volume->grid.center_m(i, j, k);
        const GeodeticPosition to = geo.toGeodetic(center);
        const double to_msl_m = geo.heightMsl_m(center);
        if (to_msl_m < terrain->heightMsl_m(to.latitude_deg, to.longitude_deg) + 1) continue;
        const ProfileData profile = profileTo(*terrain, state.position, to, step_m);
        const double expected = deltaBullington(model, profile.view(), state.height_msl_m, to_msl_m).loss_db;
        spread.errors_db.push_back(std::abs(excessIn(*volume, i, j, k, state.position) - expected));
      }
      // What is left comes from the terrain between the fan's azimuths, which stand a post apart.
      EXPECT_LT(spread.quantile(0.9), 0.01);
      EXPECT_LT(spread.quantile(0.99), 0.1);
      EXPECT_LT(spread.quantile(1), 0.5);
    }
  }
}

}  // namespace
}  // namespace emscape::emfield
