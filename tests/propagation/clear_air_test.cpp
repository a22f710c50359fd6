// P.1812 and P.452: what their reference figures do not reach: zones, limits, single precision, columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "propagation/clear_air/single_path.h"
#include "propagation/p1812/p1812.h"
#include "propagation/p452/p452.h"

namespace emscape::propagation {
namespace {

struct Terrain {
  std::vector<double> range_m;
  std::vector<float> height_msl_m;

  TerrainProfile profile() const {
    return {range_m.data(), height_msl_m.data(), static_cast<int>(range_m.size())};
  }
};

Terrain flat(double length_m, int posts, float height_msl_m) {
  Terrain terrain;
  for (int i = 0; i < posts; ++i) {
    terrain.range_m.push_back(length_m * i / (posts - 1));
    terrain.height_msl_m.push_back(height_msl_m);
  }
  return terrain;
}

Terrain randomTerrain(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  Terrain terrain = flat(1e3 * std::pow(200.0, part(random)), 50 + static_cast<int>(150 * part(random)), 0);
  double height_m = 300 * part(random);
  for (float& height : terrain.height_msl_m) {
    height_m += 60 * (part(random) - 0.5);
    height = static_cast<float>(std::max(height_m, 0.0));
  }
  return terrain;
}

ClearAirParameters parametersOf(double frequency_hz, double time_percent) {
  ClearAirParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.time_percent = time_percent;
  parameters.latitude_deg = 50;
  return parameters;
}

template <class Real>
P1812Model<Real> p1812(double frequency_hz, double time_percent) {
  P1812Model<Real> model;
  model.clear_air = clearAirModel<Real>(parametersOf(frequency_hz, time_percent));
  return model;
}

P1812Path<double> pathOf(const P1812Model<double>& model, const Terrain& terrain, double tx_agl_m,
                         double rx_agl_m, const ClearAirGround& ground = {}) {
  const ClearAirProfile profile(model.clear_air, terrain.profile(), ground,
                                static_cast<double>(terrain.height_msl_m.front()) + tx_agl_m);
  return p1812Path(model, profile.column(), static_cast<double>(terrain.height_msl_m.back()) + rx_agl_m);
}

TEST(PathZones, ExtendHalfWayToTheNextPost) {
  const Terrain terrain = flat(10e3, 11, 0);
  const PathZone s = PathZone::sea, c = PathZone::coastal_land, i = PathZone::inland;
  const PathZone zones[] = {i, i, i, c, c, s, s, i, i, c, c};
  const PathZones sums = sumZones(terrain.profile(), [&](int post) { return zones[post]; });
  EXPECT_DOUBLE_EQ(sums.sea_fraction, 0.2);
  EXPECT_DOUBLE_EQ(sums.longest_land_m, 4500);
  EXPECT_DOUBLE_EQ(sums.longest_inland_m, 2500);
  EXPECT_DOUBLE_EQ(sums.coast_distance_m[0], 4500);
  EXPECT_DOUBLE_EQ(sums.coast_distance_m[1], 3500);
  EXPECT_FALSE(sums.ends_at_sea);
}

TEST(PathZones, ComeFromHeightsAndTheDistanceToTheSea) {
  // 200 km: sea for 20 km, then low land but for a hill at 40 km
  Terrain terrain = flat(200e3, 201, 50);
  for (std::size_t post = 0; post < 20; ++post) terrain.height_msl_m[post] = post % 2 == 0 ? 0.0f : -3.0f;
  terrain.height_msl_m[40] = 101;
  const PathZones zones = zonesByHeight(terrain.profile());
  EXPECT_DOUBLE_EQ(zones.sea_fraction, 19.5 / 200);
  EXPECT_DOUBLE_EQ(zones.longest_land_m, 180.5e3);
  EXPECT_DOUBLE_EQ(zones.longest_inland_m, 130.5e3);  // beyond 69 km: 50 km from the last sea post
  EXPECT_EQ(zones.coast_distance_m[0], 0);
  EXPECT_DOUBLE_EQ(zones.coast_distance_m[1], 180.5e3);
  // the same path from its other end
  std::reverse(terrain.height_msl_m.begin(), terrain.height_msl_m.end());
  const PathZones back = zonesByHeight(terrain.profile());
  EXPECT_DOUBLE_EQ(back.longest_inland_m, 130.5e3);
  EXPECT_DOUBLE_EQ(back.longest_land_m, 180.5e3);
  EXPECT_TRUE(back.ends_at_sea);
}

TEST(PathZones, EqualSettingsAlongTheWholePath) {
  const Terrain terrain = flat(80e3, 30, -1);
  EXPECT_EQ(zonesOf(ClearAirZone::by_height, terrain.profile()).sea_fraction, 1);
  EXPECT_EQ(zonesOf(ClearAirZone::sea, terrain.profile()).coast_distance_m[1], 0);
  const PathZones coast = zonesOf(ClearAirZone::coastal_land, terrain.profile());
  EXPECT_EQ(coast.sea_fraction, 0);
  EXPECT_EQ(coast.longest_land_m, 80e3);
  EXPECT_EQ(coast.longest_inland_m, 0);
  EXPECT_EQ(zonesOf(ClearAirZone::inland, terrain.profile()).longest_inland_m, 80e3);
}

TEST(ClearAir, DuctsAreRarerInlandAndTowardThePoles) {
  // without land mu_1 and mu_4 are 1
  EXPECT_NEAR(ductingTime_percent(50.0, 0.0, 0.0), std::pow(10, 1.67 - 0.75), 1e-9);
  EXPECT_NEAR(ductingTime_percent(-80.0, 0.0, 0.0), 4.17, 1e-9);
  EXPECT_LT(ductingTime_percent(50.0, 300e3, 0.0), ductingTime_percent(50.0, 30e3, 0.0));
  EXPECT_LT(ductingTime_percent(50.0, 300e3, 300e3), ductingTime_percent(50.0, 300e3, 0.0));
}

TEST(P1812, IsFreeSpaceOnAClearPathInHalfOfTheTime) {
  const P1812Path<double> path = pathOf(p1812<double>(3e9, 50), flat(5e3, 40, 200), 100, 150);
  EXPECT_FALSE(path.geometry.is_transhorizon);
  EXPECT_NEAR(path.loss_db, path.median.sight.free_space_db, 1e-3);
}

TEST(P1812, LosesLessInASmallerPartOfTheTimeAndNeverLessThanTheLineOfSight) {
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n) {
    const Terrain terrain = randomTerrain(random);
    double below_db = 0;
    for (const double time_percent : {1.0, 5.0, 20.0, 50.0}) {
      const P1812Path<double> path = pathOf(p1812<double>(6e8, time_percent), terrain, 20, 30);
      EXPECT_GE(path.loss_db, path.median.sight.loss_db);
      EXPECT_GT(path.loss_db, below_db - 0.5) << n << ": " << time_percent << " %";
      below_db = path.loss_db;
    }
  }
}

TEST(P1812, LocationsVaryUpToTenMetresAboveTheClutter) {
  P1812Model<double> model = p1812<double>(1e9, 50);
  model.location_deviation_db = p1812LocationDeviationDb(1e9, 100);
  EXPECT_NEAR(model.location_deviation_db, (0.52 + 0.024) * std::pow(100, 0.28), 1e-12);
  model.location_deviate = normalDeviate(0.9);
  model.clutter_height_m = 15;
  const Terrain terrain = flat(30e3, 100, 300);
  const auto at = [&](double rx_agl_m) { return pathOf(model, terrain, 50, rx_agl_m).location_db; };
  EXPECT_NEAR(at(2), 1.2816 * model.location_deviation_db, 1e-3 * model.location_deviation_db);
  EXPECT_EQ(at(15), at(2));
  EXPECT_NEAR(at(20), at(2) / 2, 1e-9);
  EXPECT_EQ(at(25), 0);
  // none at sea
  EXPECT_EQ(pathOf(model, terrain, 50, 2, {ClearAirZone::sea, 0, 0}).location_db, 0);
}

TEST(P1812, ClutterOnLandObstructsThePath) {
  const P1812Model<double> model = p1812<double>(1e9, 50);
  const Terrain terrain = flat(10e3, 100, 20);
  const auto loss_db = [&](ClearAirZone zone, float clutter_m) {
    return pathOf(model, terrain, 30, 3, {zone, clutter_m, 0}).loss_db;
  };
  EXPECT_GT(loss_db(ClearAirZone::inland, 20), loss_db(ClearAirZone::inland, 0) + 10);
  EXPECT_EQ(loss_db(ClearAirZone::sea, 20), loss_db(ClearAirZone::sea, 0));
  // no clutter within a distance of the antennas that is half the path
  EXPECT_EQ(pathOf(model, terrain, 30, 3, {ClearAirZone::inland, 20, 6e3}).loss_db,
            loss_db(ClearAirZone::inland, 0));
}

TEST(P1812, InSinglePrecisionIsWithinAHundredthOfADecibel) {
  std::mt19937 random(8);
  double largest_db = 0;
  for (int n = 0; n < 500; ++n) {
    const Terrain terrain = randomTerrain(random);
    const TerrainProfile profile = terrain.profile();
    const double frequency_hz = 3e7 * std::pow(200.0, n / 500.0);
    const double tx_msl_m = static_cast<double>(terrain.height_msl_m.front()) + 25;
    const double rx_msl_m = static_cast<double>(terrain.height_msl_m.back()) + 3 + n * 4;
    const auto exact = p1812<double>(frequency_hz, 1 + n % 50);
    const ClearAirProfile path(exact.clear_air, profile, {}, tx_msl_m);
    const auto model = p1812<float>(frequency_hz, 1 + n % 50);
    std::vector<float> memory(3 * terrain.range_m.size());
    const ClearAirPosts<float> posts{profile, memory.data(), memory.data() + profile.count,
                                     memory.data() + 2 * profile.count};
    posts.fill(model.clear_air.median.earth.wavelength_m, [](int) { return 0; });
    const auto column =
        clearAirColumn(model.clear_air, posts, zonesByHeight(profile), static_cast<float>(tx_msl_m));
    const double difference_db = static_cast<double>(model.excessDb(column, static_cast<float>(rx_msl_m))) -
                                 exact.excessDb(path.column(), rx_msl_m);
    largest_db = std::max(largest_db, std::abs(difference_db));
  }
  EXPECT_LT(largest_db, 0.01);
}

P452Parameters p452Parameters(double frequency_hz) {
  P452Parameters parameters;
  parameters.clear_air = parametersOf(frequency_hz, 50);
  return parameters;
}

TEST(P452, GasesFollowTheVapourOverTheSea) {
  const auto model = p452Model<double>(p452Parameters(22.2e9));
  EXPECT_EQ(model.gasesOver(0), model.gases_db_per_km[0]);
  EXPECT_NEAR(model.gasesOver(0.5), model.gases_db_per_km[1], 1e-12);
  EXPECT_NEAR(model.gasesOver(1), model.gases_db_per_km[2], 1e-12);
  EXPECT_GT(model.gasesOver(1), 1.2 * model.gasesOver(0));
}

TEST(P452, NarrowBeamsCoupleWorseIntoTroposcatter) {
  P452Parameters parameters = p452Parameters(2e9);
  const double without_db = p452TroposcatterDb(p452Model<double>(parameters), 300e3, 30.0);
  parameters.gains_dbi = 80;
  const double with_db = p452TroposcatterDb(p452Model<double>(parameters), 300e3, 30.0);
  EXPECT_NEAR(with_db - without_db, 0.051 * (std::exp(0.055 * 80) - 1), 1e-9);
}

TEST(P452, IsNoLessThanTheLineOfSightRightAboveTheAntenna) {
  for (const double distance_m : {0.01, 1.0, 100.0}) {
    const Terrain terrain = flat(distance_m, 2, 100);
    const auto model = p452Model<double>(p452Parameters(1e9));
    const ClearAirProfile profile(model.clear_air, terrain.profile(), {}, 120);
    EXPECT_NEAR(model.excessDb(profile.column(), 6000.0), 0, 0.2) << distance_m;
  }
}

TEST(P452, IsP1812ButForGasesAndScatter) {
  // below the horizon and in half of the time neither counts at 100 MHz
  const Terrain terrain = flat(20e3, 100, 200);
  const auto model = p452Model<double>(p452Parameters(3e8));
  const ClearAirProfile profile(model.clear_air, terrain.profile(), {}, 230);
  const ClearAirLoss<double> loss = p452Path(model, profile.column(), 210.0).loss;
  const ClearAirLoss<double> other = pathOf(p1812<double>(3e8, 50), terrain, 30, 10).median;
  EXPECT_EQ(loss.diffraction.loss_db, other.diffraction.loss_db);
  EXPECT_NEAR(loss.loss_db - loss.sight.median_db, other.loss_db - other.sight.median_db, 0.01);
}

}  // namespace
}  // namespace emscape::propagation
