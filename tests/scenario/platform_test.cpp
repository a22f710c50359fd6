#include "emscape/scenario/model/platform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

TrackPoint point(double t_s, double latitude_deg, double longitude_deg, double height_msl_m) {
  TrackPoint p;
  p.t_s = t_s;
  p.position.latitude_deg = latitude_deg;
  p.position.longitude_deg = longitude_deg;
  p.position.height_msl_m = height_msl_m;
  return p;
}

Platform moving(std::vector<TrackPoint> track) {
  Platform platform;
  platform.track = std::move(track);
  return platform;
}

TEST(Platform, FixedSiteKeepsPositionAndAttitude) {
  Platform site = moving({point(0, 10, 20, 30)});
  site.attitude = {-90, 2, 3};
  const TrackPoint at = pointAt(site, 1e6);
  EXPECT_EQ(at.position.latitude_deg, 10);
  EXPECT_EQ(at.position.height_msl_m, 30);
  EXPECT_EQ(at.heading_deg, 270);
  EXPECT_EQ(at.pitch_deg, 2);
  EXPECT_EQ(at.roll_deg, 3);
}

TEST(Platform, LegsBeginAtTheirFirstPointAndTheLastOneIncludesItsEnd) {
  const std::vector<TrackPoint> track = {point(0, 50, 0, 0), point(10, 50, 1, 0), point(30, 51, 1, 0)};
  const std::pair<double, std::size_t> expected[] = {{-5, 0}, {0, 0},  {9.9, 0}, {10, 1},
                                                     {29, 1}, {30, 1}, {31, 1}};
  for (const auto& [t_s, leg] : expected) EXPECT_EQ(legAt(track, t_s), leg) << t_s;
}

TEST(Platform, MovesAlongTheGeodesicInEvenTime) {
  const Platform flight = moving({point(0, 50, 0, 1000), point(100, 50, 40, 3000)});
  const GeodesicInverse whole = geodesicInverse(50, 0, 50, 40);
  for (const double t : {0.0, 10.0, 50.0, 90.0, 100.0}) {
    const SitePosition at = pointAt(flight, t).position;
    const double before_m = geodesicInverse(50, 0, at.latitude_deg, at.longitude_deg).distance_m;
    const double after_m = geodesicInverse(at.latitude_deg, at.longitude_deg, 50, 40).distance_m;
    EXPECT_NEAR(before_m + after_m, whole.distance_m, 1e-3);
    EXPECT_NEAR(before_m, whole.distance_m * t / 100, 1e-3);
    EXPECT_NEAR(*at.height_msl_m, 1000 + 20 * t, 1e-9);
  }
  EXPECT_GT(pointAt(flight, 50).position.latitude_deg, 51) << "the shortest way bulges polewards";
  EXPECT_NEAR(*pointAt(flight, 50).heading_deg, 90, 1e-9);
  EXPECT_LT(*pointAt(flight, 1).heading_deg, 76);
  EXPECT_GT(*pointAt(flight, 99).heading_deg, 104);
}

TEST(Platform, IsHeldAtTheEndsOfItsTrack) {
  const Platform flight = moving({point(10, 1, 1, 100), point(20, 1, 2, 200)});
  EXPECT_EQ(pointAt(flight, 0).position.longitude_deg, 1);
  EXPECT_EQ(pointAt(flight, 99).position.longitude_deg, 2);
  EXPECT_EQ(pointAt(flight, 99).position.height_msl_m, 200);
  EXPECT_NEAR(*pointAt(flight, 99).heading_deg, 90, 0.02);
}

TEST(Platform, PassesTheGivenPointsExactly) {
  const Platform flight = moving({point(0, 1, 1, 1), point(3, 7, 5, 2), point(7, 3, 2, 3)});
  EXPECT_EQ(pointAt(flight, 3).position.latitude_deg, 7);
  EXPECT_EQ(pointAt(flight, 7).position.longitude_deg, 2);
}

TEST(Platform, CrossesTheAntimeridianTheShortWay) {
  const Platform ship = moving({point(0, 0, 179, 0), point(10, 0, -179, 0)});
  EXPECT_NEAR(std::abs(pointAt(ship, 5).position.longitude_deg), 180, 1e-9);
  EXPECT_NEAR(pointAt(ship, 2.5).position.longitude_deg, 179.5, 1e-9);
  EXPECT_NEAR(pointAt(ship, 7.5).position.longitude_deg, -179.5, 1e-9);
  EXPECT_NEAR(*pointAt(ship, 5).heading_deg, 90, 1e-9);
}

TEST(Platform, CrossesThePole) {
  const Platform flight = moving({point(0, 89, 0, 0), point(10, 89, 180, 0)});
  EXPECT_NEAR(pointAt(flight, 5).position.latitude_deg, 90, 1e-9);
  EXPECT_NEAR(pointAt(flight, 2.5).position.latitude_deg, 89.5, 1e-6);
  EXPECT_NEAR(pointAt(flight, 2.5).position.longitude_deg, 0, 1e-6);
  EXPECT_NEAR(std::abs(pointAt(flight, 7.5).position.longitude_deg), 180, 1e-6);
  EXPECT_NEAR(std::remainder(*pointAt(flight, 2.5).heading_deg, 360), 0, 1e-6);
  EXPECT_NEAR(*pointAt(flight, 7.5).heading_deg, 180, 1e-6);
}

TEST(Platform, GivenHeadingTurnsOverTheShorterArc) {
  Platform ship = moving({point(0, 0, 0, 0), point(10, 0, 1, 0)});
  ship.track[0].heading_deg = 350;
  ship.track[1].heading_deg = 30;
  ship.track[0].roll_deg = 0;
  ship.track[1].roll_deg = 10;
  EXPECT_NEAR(*pointAt(ship, 2.5).heading_deg, 0, 1e-9);
  EXPECT_NEAR(*pointAt(ship, 5).heading_deg, 10, 1e-9);
  EXPECT_NEAR(*pointAt(ship, 5).roll_deg, 5, 1e-9);
  EXPECT_EQ(*pointAt(ship, 5).pitch_deg, 0);
  ship.track[0].heading_deg = 30;
  ship.track[1].heading_deg = -10;
  EXPECT_NEAR(*pointAt(ship, 10).heading_deg, 350, 1e-9);
}

TEST(Platform, RollTurnsOverTheShorterArc) {
  Platform aircraft = moving({point(0, 0, 0, 0), point(10, 0, 1, 0), point(20, 0, 2, 0)});
  aircraft.track[0].roll_deg = 350;
  aircraft.track[1].roll_deg = 10;
  aircraft.track[2].roll_deg = -170;
  EXPECT_NEAR(*pointAt(aircraft, 0).roll_deg, -10, 1e-9);
  EXPECT_NEAR(*pointAt(aircraft, 2.5).roll_deg, -5, 1e-9);
  EXPECT_NEAR(*pointAt(aircraft, 5).roll_deg, 0, 1e-9);
  EXPECT_NEAR(*pointAt(aircraft, 10).roll_deg, 10, 1e-9);
  aircraft.track[0].roll_deg = 170;
  aircraft.track[1].roll_deg = -170;
  EXPECT_NEAR(std::abs(*pointAt(aircraft, 5).roll_deg), 180, 1e-9);
}

TEST(Platform, KeepsLastCourseWhileStationary) {
  const Platform hover =
      moving({point(0, 0, 0, 0), point(1, 0, 0, 5), point(2, 1, 0, 5), point(3, 1, 0, 0), point(4, 1, 1, 0)});
  EXPECT_NEAR(std::remainder(*pointAt(hover, 0.5).heading_deg, 360), 0, 1e-9) << "the first course to come";
  EXPECT_NEAR(std::remainder(*pointAt(hover, 2.5).heading_deg, 360), 0, 1e-9) << "the last course";
  EXPECT_NEAR(*pointAt(hover, 3.5).heading_deg, 90, 0.1);
  EXPECT_EQ(*pointAt(moving({point(0, 5, 5, 0), point(1, 5, 5, 9)}), 0.5).heading_deg, 0)
      << "no course at all";
  EXPECT_NEAR(*pointAt(hover, 0.5).position.height_msl_m, 2.5, 1e-12) << "it still climbs";
}

TEST(Platform, HasTheSideOfItsSymbol) {
  const test::TemporaryFolder folder;
  const auto platformWith = [&](const std::string& keys) {
    return parseScenario(folder.write("sides.yaml", R"(schema_version: 1
name: sides
region: {origin: {latitude_deg: 50, longitude_deg: 8}, size_m: [10000, 10000, 1000], dims: [10, 10, 10]}
platforms:
  - {name: mast, position: {latitude_deg: 50, longitude_deg: 8, height_agl_m: 5}, )" +
                                                        keys + R"(}
emitters:
  - {name: beacon, platform: mast, kind: transmitter, frequency_hz: 1.0e9, power_w: 1, antenna: {pattern: isotropic}}
)"))
        .scenario->platforms.at(0);
  };
  EXPECT_EQ(platformWith("side: neutral").side, Side::neutral);
  EXPECT_EQ(platformWith(R"(sidc: "10031500002203000000")").side, Side::friendly);
  EXPECT_EQ(platformWith(R"(sidc: "10051500002203000000")").side, Side::hostile) << "suspect";
  EXPECT_EQ(platformWith(R"(sidc: "10001500002203000000")").side, Side::unknown) << "pending";
  EXPECT_EQ(platformWith(R"(side: friend, sidc: "10021500002203000000")").sidc, "10021500002203000000");
}

}  // namespace
}  // namespace emscape::scenario
