#include <gtest/gtest.h>

#include <cmath>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {
namespace {

Scenario around(double latitude_deg, double longitude_deg, double size_m) {
  Scenario scenario;
  scenario.region.origin.latitude_deg = latitude_deg;
  scenario.region.origin.longitude_deg = longitude_deg;
  scenario.region.size_m = {size_m, size_m, 1000};
  return scenario;
}

void addSite(Scenario& scenario, double latitude_deg, double longitude_deg) {
  Platform platform;
  platform.track.resize(1);
  platform.track[0].position.latitude_deg = latitude_deg;
  platform.track[0].position.longitude_deg = longitude_deg;
  scenario.platforms.push_back(platform);
}

bool holds(const GeoBox& box, double latitude_deg, double longitude_deg) {
  const double from_west_deg = std::fmod(longitude_deg - box.west_deg + 720, 360);
  return latitude_deg >= box.south_deg && latitude_deg <= box.north_deg &&
         from_west_deg <= box.east_deg - box.west_deg;
}

TEST(TerrainBox, HoldsTheRegionWithItsMargin) {
  const GeoBox box = terrainBox(around(36.5, -84.25, 20000));
  EXPECT_NEAR(box.south_deg, 36.5 - 0.0901 - 0.018, 1e-3);
  EXPECT_NEAR(box.north_deg, 36.5 + 0.0901 + 0.018, 1e-3);
  EXPECT_NEAR(box.west_deg, -84.25 - 0.1117 - 0.0224, 1e-3);
  EXPECT_NEAR(box.east_deg, -84.25 + 0.1117 + 0.0224, 1e-3);
}

TEST(TerrainBox, HoldsPlatformsOutsideTheRegionAndTheWayToThem) {
  Scenario scenario = around(60, 10, 20000);
  addSite(scenario, 60, 20);
  const GeoBox box = terrainBox(scenario);
  EXPECT_TRUE(holds(box, 60, 20));
  for (double part = 0; part <= 1; part += 0.05) {
    const GeodesicInverse way = geodesicInverse(60, 10, 60, 20);
    const GeodeticPosition between = geodesicDirect(60, 10, way.azimuth_rad, way.distance_m * part);
    EXPECT_TRUE(holds(box, between.latitude_deg, between.longitude_deg)) << part;
  }
}

TEST(TerrainBox, HoldsTheWholeTrack) {
  Scenario scenario = around(50, 0, 1000);
  Platform platform;
  platform.track.resize(2);
  platform.track[0].position.latitude_deg = platform.track[1].position.latitude_deg = 50;
  platform.track[1].position.longitude_deg = 60;
  platform.track[1].t_s = 100;
  scenario.platforms.push_back(platform);
  const GeoBox box = terrainBox(scenario);
  for (int t = 0; t <= 100; ++t) {
    const SitePosition at = pointAt(platform, t).position;
    EXPECT_TRUE(holds(box, at.latitude_deg, at.longitude_deg)) << t;
  }
}

TEST(TerrainBox, CrossesTheAntimeridian) {
  Scenario scenario = around(10, 179.95, 20000);
  addSite(scenario, 10, -179.5);
  const GeoBox box = terrainBox(scenario);
  EXPECT_TRUE(holds(box, 10, 179.9));
  EXPECT_TRUE(holds(box, 10, -179.5));
  EXPECT_GE(box.west_deg, -180);
  EXPECT_LE(box.west_deg, 180);
  EXPECT_GT(box.east_deg, 180);
  EXPECT_LT(box.east_deg - box.west_deg, 1);
  const GeoBox other_side = terrainBox(around(10, -179.95, 20000));
  EXPECT_TRUE(holds(other_side, 10, 179.99));
  EXPECT_LT(other_side.east_deg - other_side.west_deg, 1);
}

TEST(TerrainBox, AroundAPoleSpansAllLongitudes) {
  const GeoBox box = terrainBox(around(89.95, 30, 50000));
  EXPECT_EQ(box.north_deg, 90);
  EXPECT_EQ(box.west_deg, -180);
  EXPECT_EQ(box.east_deg, 180);
  EXPECT_LT(box.south_deg, 89.8);
  EXPECT_GT(box.south_deg, 89.4);
}

}  // namespace
}  // namespace emscape::scenario
