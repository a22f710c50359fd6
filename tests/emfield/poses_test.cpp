// Platforms that a host program moves itself.
#include "emscape/scenario/model/poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using scenario::PlatformPose;
using scenario::Scenario;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The shipped scenario with terrain, radars and a jammer, coarse.
std::shared_ptr<const Scenario> terrainScenario(const std::vector<scenario::Edit>& edits = {}) {
  std::vector<scenario::Edit> all{{"region.dims", "[24, 24, 10]"}};
  all.insert(all.end(), edits.begin(), edits.end());
  return scenario::loadScenario(test::shippedScenario("jacksboro.yaml"), all,
                                scenario::ReadFor::chosen_times);
}

/// A pose a little beside a platform's place at t = 0.
PlatformPose besideOf(const Scenario& scenario, int platform) {
  const auto at = scenario::pointAt(scenario.platforms[static_cast<std::size_t>(platform)], 0).position;
  PlatformPose pose;
  pose.platform = platform;
  pose.position = scenario::positionAgl(at.latitude_deg + 0.004, at.longitude_deg - 0.003, 40);
  pose.attitude = {75, 3, -2};
  return pose;
}

TEST(Poses, APlatformThatAHostMovesHasTheFieldOfAScenarioWithThePlatformThere) {
  const auto base = terrainScenario();
  const auto terrain = scenario::loadTerrain(*base);
  for (const double tolerance_m : {0.0, 100.0}) {
    FieldOptions options;
    options.move_tolerance_m = tolerance_m;
    SolvedField solver(base, terrain, options);
    for (int p = 0; p < static_cast<int>(base->platforms.size()); ++p) {
      PlatformPose pose = besideOf(*base, p);
      for (int step = 0; step < 2; ++step, pose.position.latitude_deg += 1e-5) {
        solver.update(7, {pose});
        auto there = std::make_shared<Scenario>(*base);
        scenario::Platform& platform = there->platforms[static_cast<std::size_t>(p)];
        platform.track = {{0, pose.position, {}, {}, {}}};
        platform.attitude = pose.attitude;
        SolvedField fresh(there, terrain, {}, 7);
        for (std::size_t c = 0; c < fresh.volumes().size(); ++c)
          EXPECT_EQ(solver.volumes()[c].host()->values, fresh.volumes()[c].host()->values) << p << " " << c;
      }
    }
  }
}

TEST(Poses, OnlyTheEmittersOfPlatformsThatMovedAreComputedAgain) {
  const auto scenario = emptyScenario(FrameKind::enu, 45, 7, {2000, 2000, 1000}, {6, 6, 4});
  addEmitter(*scenario, {45, 7, 200}, plainEmitter("a", 0));
  addEmitter(*scenario, {45.001, 7, 200}, plainEmitter("b", 0));
  FieldSolver solver(scenario, nullptr);
  PlatformPose pose{1, scenario::positionMsl(45.002, 7.001, 300), {}};
  EXPECT_TRUE(solver.update(0, {pose}).any);
  EXPECT_FALSE(solver.update(0, {pose}).any) << "it rests";
  pose.position.latitude_deg += 1e-9;  // 0.1 mm, below the tolerance of tracks
  EXPECT_THAT(solver.update(0, {pose}).moved, ElementsAre(1));
  EXPECT_THAT(solver.update(1, {pose}).moved, IsEmpty());
}

TEST(Poses, ACopyOfTheScenarioHasThePlatformsThere) {
  const auto scenario = emptyScenario(FrameKind::enu, 45, 7, {2000, 2000, 1000}, {6, 6, 4});
  addEmitter(*scenario, {45, 7, 200}, plainEmitter("a", 0));
  const PlatformPose pose{0, scenario::positionMsl(45.01, 7.01, 500), {90, 0, 0}};
  const auto moved = scenario::withPoses(*scenario, {{0, scenario::positionMsl(1, 2, 3), {}}, pose});
  const auto expected = scenario::snapshotAt(moved, nullptr, 3);
  const auto got = scenario::snapshotAt(scenario, nullptr, 3, {pose});
  EXPECT_EQ(got.emitters[0].position.latitude_deg, 45.01);
  EXPECT_EQ(got.emitters[0].position.height_ellipsoid_m, expected.emitters[0].position.height_ellipsoid_m);
  EXPECT_EQ(got.platforms[0].attitude.heading_deg, 90);
  EXPECT_EQ(scenario->platforms[0].track.front().position.latitude_deg, 45);
}

TEST(Poses, WhatCannotBeIsRefusedWithTheAllowedRange) {
  const auto scenario = emptyScenario(FrameKind::enu, 45, 7, {2000, 2000, 1000}, {6, 6, 4});
  addEmitter(*scenario, {45, 7, 200}, plainEmitter("a", 0));
  const auto fault = [&](const PlatformPose& pose) {
    return test::errorOf([&] { scenario::withPoses(*scenario, {pose}); });
  };
  const auto at = scenario::positionMsl(45, 7, 10);
  EXPECT_THAT(fault({1, at, {}}), HasSubstr("a pose of platform 1: the scenario has platforms 0..0"));
  EXPECT_THAT(fault({0, scenario::positionMsl(91, 7, 10), {}}),
              HasSubstr("the pose of platform 'site' has latitude 91; allowed: -90..90 deg"));
  EXPECT_THAT(fault({0, scenario::positionMsl(45, std::nan(""), 10), {}}), HasSubstr("longitude nan"));
  EXPECT_THAT(fault({0, scenario::SitePosition{45, 7, {}, {}, {}}, {}}),
              HasSubstr("a number of heights of 0"));
  EXPECT_THAT(fault({0, scenario::positionMsl(45, 7, 2e5), {}}), HasSubstr("height 200000"));
  EXPECT_THAT(fault({0, at, {0, 91, 0}}), HasSubstr("pitch 91"));
  EXPECT_THAT(test::errorOf([&] { scenario::platformNamed(*scenario, "sites"); }), HasSubstr("'sites'"));
}

}  // namespace
}  // namespace emscape::emfield
