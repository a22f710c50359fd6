#include "emscape/scenario/model/snapshot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "scenario/antenna/shapes.h"
#include "scenario/terrain/view.h"
#include "tests/support/errors.h"

namespace emscape::scenario {
namespace {

/// Ground of one height, missing west of a meridian.
class FlatTerrain : public Terrain {
 public:
  FlatTerrain(double height_m, double missing_west_of_deg)
      : height_m_(height_m), west_deg_(missing_west_of_deg) {}
  double heightMsl_m(double, double longitude_deg) const override {
    return longitude_deg < west_deg_ ? std::nan("") : height_m_;
  }
  TerrainView view() const override { return {}; }
  double postSpacing_m() const override { return 30; }
  long long voidPosts() const override { return 0; }
  double uncoveredFraction() const override { return 0; }
  GeoBox box() const override { return {}; }
  GeoBox coverage() const override {
    GeoBox box;
    box.south_deg = 30, box.north_deg = 40, box.west_deg = -90, box.east_deg = -70;
    return box;
  }
  double lowest_m() const override { return height_m_; }
  double highest_m() const override { return height_m_; }

 private:
  double height_m_, west_deg_;
};

Scenario oneEmitter(const SitePosition& position) {
  Scenario scenario;
  scenario.clock.epoch_utc = "2026-06-01T06:00:00Z";
  Platform platform;
  platform.name = "site";
  platform.location = {"s.yaml", 12, 5};
  platform.track.resize(1);
  platform.track[0].position = position;
  scenario.platforms = {platform};
  Emitter emitter;
  emitter.platform = 0;
  emitter.antenna = makeIsotropic();
  scenario.emitters = {emitter};
  return scenario;
}

SitePosition atMsl(double height_m) {
  return {36, -84, height_m, {}, {}};
}
SitePosition atAgl(double height_m) {
  return {36, -84, {}, height_m, {}};
}

Snapshot snap(const Scenario& scenario, double t_s = 0, const Terrain* terrain = nullptr) {
  return snapshotAt(std::make_shared<const Scenario>(scenario), terrain, t_s);
}

void expectVector(const Vec3d& actual, const Vec3d& expected) {
  EXPECT_NEAR(actual.x, expected.x, 1e-12);
  EXPECT_NEAR(actual.y, expected.y, 1e-12);
  EXPECT_NEAR(actual.z, expected.z, 1e-12);
}

void expectMessage(const Scenario& scenario, const Terrain* terrain, double t_s, const std::string& message) {
  const Error error = test::thrownBy([&] { snap(scenario, t_s, terrain); });
  EXPECT_EQ(error.code(), ErrorCode::bad_input);
  EXPECT_EQ(error.location().line, 12);
  EXPECT_NE(error.message().find(message), std::string::npos) << error.message();
}

TEST(Snapshot, RefusesTimesOutsideTheLimits) {
  for (const double t_s : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1.1e9, -1e11}) {
    EXPECT_NE(test::errorOf([&] { snap(oneEmitter(atMsl(10)), t_s); }, ErrorCode::usage)
                  .find("is outside the allowed range -1000000000 to 1000000000 s"),
              std::string::npos)
        << t_s;
  }
}

TEST(Snapshot, HasItsTime) {
  EXPECT_EQ(snap(oneEmitter(atMsl(100)), 1.5).time_utc, "2026-06-01T06:00:01.500Z");
  EXPECT_EQ(snap(oneEmitter(atMsl(100)), 1.5).time_s, 1.5);
}

TEST(Snapshot, HeightsOfAllDatumsAgree) {
  const double undulation_m = geoidUndulation_m(36, -84);
  const Snapshot msl = snap(oneEmitter(atMsl(100)));
  EXPECT_EQ(msl.emitters[0].height_msl_m, 100);
  EXPECT_NEAR(msl.emitters[0].position.height_ellipsoid_m, 100 + undulation_m, 1e-9);
  const Snapshot ellipsoid = snap(oneEmitter({36, -84, {}, {}, 100 + undulation_m}));
  EXPECT_NEAR(ellipsoid.platforms[0].height_msl_m, 100, 1e-9);
  Scenario on_ground = oneEmitter(atAgl(12));
  EXPECT_EQ(snap(on_ground).platforms[0].height_msl_m, 12) << "without terrain the ground is mean sea level";
  on_ground.terrain.emplace();
  const FlatTerrain terrain(250, -90);
  EXPECT_EQ(snap(on_ground, 0, &terrain).platforms[0].height_msl_m, 262);
}

TEST(Snapshot, PlatformBelowGroundIsAnErrorWithTimeAndDepth) {
  Scenario scenario = oneEmitter(atMsl(238));
  scenario.terrain.emplace();
  const FlatTerrain terrain(250, -90);
  expectMessage(scenario, &terrain, 7.5,
                "platform 'site' at t = 7.5 s (36.000000, -84.000000 deg) is 12.0 m below ground");
  scenario = oneEmitter(atMsl(250));
  scenario.terrain.emplace();
  EXPECT_NO_THROW(snap(scenario, 0, &terrain));
  expectMessage(oneEmitter(atMsl(-3)), nullptr, 0, "is 3.0 m below the smooth earth");
}

TEST(Snapshot, HeightAboveMissingGroundIsAnError) {
  Scenario scenario = oneEmitter(atAgl(10));
  scenario.terrain.emplace();
  const FlatTerrain terrain(250, -80);
  expectMessage(scenario, &terrain, 3,
                "the terrain is missing there: void posts, or a gap between the files; ");
  expectMessage(scenario, nullptr, 3, "the terrain was not loaded");
  Scenario aloft = oneEmitter(atMsl(10));
  aloft.terrain.emplace();
  EXPECT_NO_THROW(snap(aloft, 0, &terrain)) << "a height above mean sea level needs no ground";
}

TEST(Snapshot, LevelPoseFollowsTheHeading) {
  Scenario scenario = oneEmitter(atMsl(100));
  const BeamPose north = snap(scenario).emitters[0].beam;
  expectVector(north.forward, {0, 1, 0});
  expectVector(north.right, {1, 0, 0});
  expectVector(north.up, {0, 0, 1});
  scenario.platforms[0].attitude.heading_deg = 90;
  const BeamPose east = snap(scenario).emitters[0].beam;
  expectVector(east.forward, {1, 0, 0});
  expectVector(east.right, {0, -1, 0});
}

TEST(Snapshot, YawThenPitchThenRoll) {
  Scenario scenario = oneEmitter(atMsl(100));
  const double s = std::sin(degToRad(30.0)), c = std::cos(degToRad(30.0));
  scenario.platforms[0].attitude = {90, 30, 0};
  BeamPose pose = snap(scenario).emitters[0].beam;
  expectVector(pose.forward, {c, 0, s});
  expectVector(pose.right, {0, -1, 0});
  expectVector(pose.up, {-s, 0, c});
  scenario.platforms[0].attitude = {0, 0, 30};
  pose = snap(scenario).emitters[0].beam;
  expectVector(pose.forward, {0, 1, 0});
  expectVector(pose.right, {c, 0, -s});  // the right wing is down
  expectVector(pose.up, {s, 0, c});
  // Climbing vertically, the belly looks north and the right wing east: rolled by 90 degrees, the wing points
  // north.
  scenario.platforms[0].attitude = {0, 90, 90};
  pose = snap(scenario).emitters[0].beam;
  expectVector(pose.forward, {0, 0, 1});
  expectVector(pose.right, {0, 1, 0});
  expectVector(pose.up, {1, 0, 0});
}

TEST(Snapshot, PosesAreOrthonormalWithRightClockwiseOfForward) {
  Scenario scenario = oneEmitter(atMsl(100));
  for (int i = 0; i < 50; ++i) {
    scenario.platforms[0].attitude = {i * 37.0, std::fmod(i * 17.0, 180) - 90, i * 53.0};
    scenario.emitters[0].scan.azimuth_deg = i * 29.0;
    scenario.emitters[0].scan.elevation_deg = std::fmod(i * 41.0, 180) - 90;
    const BeamPose pose = snap(scenario).emitters[0].beam;
    expectVector(cross(pose.right, pose.forward), pose.up);
    EXPECT_NEAR(length(pose.forward), 1, 1e-12);
    EXPECT_NEAR(dot(pose.forward, pose.right), 0, 1e-12);
  }
}

TEST(Snapshot, MechanicalBeamTurnsAboutTheMountsAxes) {
  Scenario scenario = oneEmitter(atMsl(100));
  ScanSpec& scan = scenario.emitters[0].scan;
  scan.azimuth_deg = 90;
  scan.elevation_deg = 30;
  BeamPose pose = snap(scenario).emitters[0].beam;
  expectVector(pose.forward, {std::cos(degToRad(30.0)), 0, 0.5});
  expectVector(pose.right, {0, -1, 0});
  // On its side, the mount's vertical axis points east: an azimuth of 90 degrees looks down.
  scenario.platforms[0].attitude.roll_deg = 90;
  scan.elevation_deg = 0;
  pose = snap(scenario).emitters[0].beam;
  expectVector(pose.forward, {0, 0, -1});
}

TEST(Snapshot, RotatingBeamIsWhereItsRateSays) {
  Scenario scenario = oneEmitter(atMsl(100));
  scenario.emitters[0].scan.kind = ScanKind::rotate;
  scenario.emitters[0].scan.rate_rpm = 15;
  scenario.platforms[0].attitude.heading_deg = 90;
  expectVector(snap(scenario, 1).emitters[0].beam.forward, {0, -1, 0});
  expectVector(snap(scenario, 1e8 + 3).emitters[0].beam.forward, {0, 1, 0});
}

TEST(Snapshot, BeamOfAVictimScanIsAlongTheLineToItsPlatform) {
  Scenario scenario = oneEmitter(atMsl(3000));
  scenario.platforms[0].attitude = {130, 10, -20};
  scenario.platforms.push_back(scenario.platforms[0]);
  scenario.platforms[1].track[0].position = {36.4, -83.6, 200.0, {}, {}};
  ScanSpec& scan = scenario.emitters[0].scan;
  scan.kind = ScanKind::victim;
  scan.victim = 1;
  const Snapshot snapshot = snap(scenario);
  const BeamPose& pose = snapshot.emitters[0].beam;
  const GeodeticPosition from = snapshot.platforms[0].position, to = snapshot.platforms[1].position;
  const GeodesicInverse path =
      geodesicInverse(from.latitude_deg, from.longitude_deg, to.latitude_deg, to.longitude_deg);
  EXPECT_NEAR(std::atan2(pose.forward.x, pose.forward.y), path.azimuth_rad, 1e-4);
  const double down_rad = -(2800.0 / path.distance_m + path.distance_m / (2 * 6371e3));
  EXPECT_NEAR(std::asin(pose.forward.z), down_rad, 1e-4);
  EXPECT_NEAR(pose.right.z, 0, 1e-12) << "level across the line";
}

TEST(Snapshot, DwellSteersAnArrayAndTurnsAnythingElse) {
  Scenario scenario = oneEmitter(atMsl(100));
  Emitter& emitter = scenario.emitters[0];
  emitter.scan.kind = ScanKind::dwell_list;
  emitter.scan.azimuth_deg = 90;
  emitter.scan.dwells = {{30, 0, 1}, {0, 45, 1}, {30, 45, 1}};
  const BeamPose turned = snap(scenario, 0).emitters[0].beam;
  expectVector(turned.forward, {std::cos(degToRad(30.0)), -0.5, 0});
  EXPECT_EQ(turned.steer_u, 0);

  emitter.antenna = makePhasedArray(30, 16, 16, 0.5, 0.5);
  for (const double t : {0.0, 1.0, 2.0}) {
    const BeamPose pose = snap(scenario, t).emitters[0].beam;
    expectVector(pose.forward, {1, 0, 0});
    const Dwell& dwell = emitter.scan.dwells[static_cast<std::size_t>(t)];
    EXPECT_NEAR(pose.steer_u, std::sin(degToRad(dwell.azimuth_deg)) * std::cos(degToRad(dwell.elevation_deg)),
                1e-12);
    EXPECT_NEAR(pose.steer_v, std::sin(degToRad(dwell.elevation_deg)), 1e-12);
  }
}

TEST(Snapshot, IntervalsHoldTheirBeginAndNotTheirEnd) {
  Scenario scenario = oneEmitter(atMsl(100));
  EXPECT_TRUE(snap(scenario, -5).emitters[0].active);
  scenario.emitters[0].active_s = {{0, 10}, {20, 30}};
  for (const auto& [t_s, active] : std::vector<std::pair<double, bool>>{
           {-1, false}, {0, true}, {9.99, true}, {10, false}, {20, true}, {30, false}}) {
    EXPECT_EQ(snap(scenario, t_s).emitters[0].active, active) << t_s;
  }
}

TEST(Snapshot, ThreadsMayShareAScenario) {
  Scenario scenario = oneEmitter(atMsl(100));
  scenario.platforms[0].track.push_back(scenario.platforms[0].track[0]);
  scenario.platforms[0].track[1].t_s = 100;
  scenario.platforms[0].track[1].position.latitude_deg = 37;
  const auto shared = std::make_shared<const Scenario>(scenario);
  std::vector<std::thread> threads;
  std::vector<double> latitudes_deg(4);
  for (std::size_t i = 0; i < latitudes_deg.size(); ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 50; ++k)
        latitudes_deg[i] = snapshotAt(shared, nullptr, k).platforms[0].position.latitude_deg;
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double latitude_deg : latitudes_deg) EXPECT_EQ(latitude_deg, latitudes_deg[0]);
}

}  // namespace
}  // namespace emscape::scenario
