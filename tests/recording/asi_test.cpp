// Reading of SIMDIS' ASCII scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "recording/simdis/asi_reader.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

Recording readLines(const std::string& lines) {
  return readAsi(*openText(lines), {});
}

const std::string kShip =
    "ReferenceYear 2012\nPlatformID 1\nPlatformName 1 \"my ship\"  # the host\nPlatformType 1 ship\n"
    "PlatformFHN 1 \"H\"\nPlatformData 1 100 52 5 50 90 1 2 0 0 0\nPlatformData 1 110 52.01 5 50 90 1 2 0 0 "
    "0\n";

TEST(Asi, PlatformsHaveNamesSidesAndHeightsAboveTheSea) {
  const Recording r = readLines(kShip);
  ASSERT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.objects[0].name, "my ship");
  EXPECT_EQ(r.objects[0].domain, Domain::sea);
  EXPECT_EQ(r.objects[0].side, Side::hostile);
  EXPECT_EQ(r.epoch_ms, 1325376100000);  // 2012-01-01T00:01:40Z
  ASSERT_EQ(r.objects[0].poses.size(), 2u);
  EXPECT_EQ(r.objects[0].poses[1].t_s, 10);
  EXPECT_NEAR(r.objects[0].poses[0].height_msl_m, 50 - geoidUndulation_m(52, 5), 1e-9);
  EXPECT_EQ(r.objects[0].poses[0].heading_deg, 90);
  EXPECT_EQ(r.tally.bad, 0) << r.tally.first_bad;
}

TEST(Asi, HeadingAloneIsThatOfALevelPlatform) {
  const Recording r = readLines("PlatformID 1\nPlatformData 1 0 52 5 50 90 100\nPlatformData 1 1 52 5 50\n");
  ASSERT_EQ(r.objects.at(0).poses.size(), 2u);
  EXPECT_EQ(r.objects[0].poses[0].heading_deg, 90);
  EXPECT_EQ(r.objects[0].poses[0].pitch_deg, 90) << "at most straight up";
  EXPECT_EQ(r.objects[0].poses[0].roll_deg, 0);
  EXPECT_TRUE(std::isnan(r.objects[0].poses[1].roll_deg));
}

TEST(Asi, EcefAndLatitudeLongitudeAreTheSamePlace) {
  const Vec3d at = toEcef({52, 5, 50});
  const Recording r =
      readLines("CoordSystem \"ECEF\"\nPlatformID 7\nPlatformData 7 0 " + std::to_string(at.x) + " " +
                std::to_string(at.y) + " " + std::to_string(at.z) + "\n");
  ASSERT_EQ(r.objects.at(0).poses.size(), 1u);
  EXPECT_NEAR(r.objects[0].poses[0].latitude_deg, 52, 1e-9);
  EXPECT_NEAR(r.objects[0].poses[0].height_msl_m, 50 - geoidUndulation_m(52, 5), 1e-3);
}

TEST(Asi, TimeOfMinusOneIsFromTheBeginOn) {
  const Recording r =
      readLines(kShip +
                "PlatformID 2\nPlatformData 2 -1 52 5.1 50 0 0 0 0 0 0\nBeamID 2 20\n"
                "BeamType 20 \"BODY\"\nBeamOnOffCmd 20 -1 1\nBeamDataRAE 20 -1 0.5 0.1 9000\n");
  EXPECT_EQ(r.objects.at(1).poses.at(0).t_s, 0);
  ASSERT_EQ(r.beams.at(0).states.size(), 1u);
  EXPECT_EQ(r.beams[0].states[0].t_s, 0);
  EXPECT_NEAR(r.beams[0].states[0].azimuth_deg, radToDeg(0.5), 1e-9) << "radians without DegreeAngles 1";
}

TEST(Asi, CommandsOfABeamMayStandInAnyOrderOfTime) {
  const Recording r =
      readLines(kShip +
                "DegreeAngles 1\nBeamID 1 9\nBeamDesc 9 \"search radar\"\nBeamType 9 BODY\nHorzBW 9 3\n"
                "VertBW 9 8\nBeamOnOffCmd 9 102 1\nBeamOnOffCmd 9 108 0\nBeamDataRAE 9 102 -30 5 1000\n"
                "BeamDataRAE 9 105 -40 5 1000\n");
  ASSERT_EQ(r.beams.size(), 1u);
  EXPECT_EQ(r.beams[0].name, "search radar");
  EXPECT_EQ(r.beams[0].keys.asi_beam, "search radar");
  const auto& states = r.beams[0].states;
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[0].t_s, 2);
  EXPECT_EQ(states[0].azimuth_deg, -30);
  EXPECT_EQ(states[0].beamwidth_az_deg, 3);
  EXPECT_EQ(states[0].beamwidth_el_deg, 8);
  EXPECT_EQ(states[1].t_s, 5);
  EXPECT_EQ(states[1].azimuth_deg, -40);
  EXPECT_EQ(states[2].t_s, 8);
  EXPECT_FALSE(states[2].is_on);
}

TEST(Asi, AbsoluteDirectionsAreFromTrueNorth) {
  const Recording r = readLines(
      "DegreeAngles 1\nPlatformID 1\nPlatformData 1 0 52 5 50 90 0 0 0 0 0\nPlatformData 1 10 52 5 50 180 0 "
      "0 0 0 0\n"
      "BeamID 1 9\nBeamDataRAE 9 0 120 7 1000\n");
  const auto& states = r.beams.at(0).states;
  ASSERT_EQ(states.size(), 2u) << "the platform turns below the beam";
  EXPECT_NEAR(states[0].azimuth_deg, 30, 1e-9);
  EXPECT_NEAR(states[0].elevation_deg, 7, 1e-9);
  EXPECT_NEAR(states[1].azimuth_deg, -60, 1e-9);
}

TEST(Asi, TargetOfABeamIsAnotherPlatform) {
  const Recording r = readLines(kShip +
                                "PlatformID 2\nPlatformData 2 -1 52 5.1 50 0 0 0 0 0 0\nBeamID 1 9\n"
                                "BeamType 9 \"TARGET\"\nBeamTargetIdCmd 9 103 2\n");
  ASSERT_EQ(r.beams.at(0).states.size(), 1u);
  EXPECT_EQ(r.beams[0].states[0].target, 1u);
  EXPECT_EQ(r.beams[0].states[0].t_s, 3);
}

TEST(Asi, DatesInQuotesAreTimes) {
  const Recording r = readLines(
      "PlatformID 1\nPlatformData 1 \"001 2012 00:01:40\" 52 5 50 0 0 0 0 0 0\n"
      "PlatformData 1 \"Jan 1 2012 00:01:50.5\" 52.1 5 50 0 0 0 0 0 0\n"
      "PlatformData 1 \"2012-01-01T00:02:00Z\" 52.2 5 50 0 0 0 0 0 0\n");
  EXPECT_EQ(r.epoch_ms, 1325376100000);
  ASSERT_EQ(r.objects.at(0).poses.size(), 3u) << r.tally.first_bad;
  EXPECT_EQ(r.objects[0].poses[1].t_s, 10.5);
  EXPECT_EQ(r.objects[0].poses[2].t_s, 20);
}

TEST(Asi, FaultsAndUnusedCommandsAreCounted) {
  const Recording r = readLines(kShip +
                                "PlatformData 3 1 52 5 0\nPlatformData 1 x 52 5 0\nPlatformData 1 1 95 5 0\n"
                                "BeamID 4 1\nHorzBW 99 4\nGateID 1 5\n");
  EXPECT_EQ(r.tally.bad, 5);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("line 8: platform 3 has no PlatformID before it"));
  EXPECT_EQ(r.tally.ignored.at("command GateID"), 1);
}

TEST(Asi, IsToldByItsCommands) {
  EXPECT_TRUE(isAsi("# a comment\nVersion 24\nRefLLA 1 2 3\n"));
  EXPECT_FALSE(isAsi("hello\nworld\n"));
}

}  // namespace
}  // namespace emscape::interop
