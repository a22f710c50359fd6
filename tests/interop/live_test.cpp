// The present state of streams.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "interop/live/live_acmi.h"
#include "interop/live/live_cot.h"
#include "interop/live/live_dis.h"
#include "recording/acmi/acmi_handshake.h"
#include "recording/common/dates.h"
#include "recording/dis/dead_reckoning.h"
#include "tests/recording/dis_pdus.h"

namespace emscape::interop {
namespace {

using dis::Header;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

dis::EntityState stateOf(int entity, double longitude_deg = 5) {
  dis::EntityState state;
  state.id = {1, 1, static_cast<std::uint16_t>(entity)};
  state.type = {1, 2, 225, 1, 0, 0, 0};
  state.position_m = toEcef({52, longitude_deg, 1000});
  state.orientation_rad = dis::eulerOf(dis::axesOf(dis::LocalAttitude{90, 0, 0}, 52, longitude_deg));
  state.velocity_mps = {0, 200, 0};
  state.marking = "E" + std::to_string(entity);
  return state;
}

dis::Emission emissionOf(int entity, const std::vector<int>& beams) {
  return test::radarOf({1, 1, static_cast<std::uint16_t>(entity)}, beams);
}

/// A state that takes PDUs.
struct Stream {
  LiveDis live{ReadOptions{}};
  int version = 7;

  template <class Pdu>
  void send(double time_s, const Pdu& pdu) {
    const auto bytes = test::pduAt(version, time_s, pdu);
    live.take(bytes.data(), bytes.size(), time_s);
  }
};

TEST(LiveDis, AnEntityMovesByItsDeadReckoningUntilItsNextState) {
  Stream stream;
  stream.send(10, stateOf(7));
  const Vec3d begin_m = stateOf(7).position_m;
  const auto at = [&](double time_s) {
    const PoseSample pose = stream.live.poses(time_s).at(0).pose;
    return GeodeticPosition{pose.latitude_deg, pose.longitude_deg,
                            pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg)};
  };
  EXPECT_NEAR(length(toEcef(at(10)) - begin_m), 0, 1e-3);
  EXPECT_NEAR(length(toEcef(at(12)) - begin_m), 400, 0.1);
  EXPECT_NEAR(stream.live.poses(10).at(0).pose.heading_deg, 90, 1e-5);
}

TEST(LiveDis, MovementsDoNotChangeTheRevisionAndOtherChangesDo) {
  Stream stream;
  LiveDis& live = stream.live;
  const auto changes = [&](const auto& act) {
    const long long before = live.revision();
    act();
    return live.revision() != before;
  };
  EXPECT_FALSE(changes([&] { stream.send(1, emissionOf(7, {1, 2})); })) << "of an unknown entity";
  EXPECT_TRUE(changes([&] { stream.send(2, stateOf(7)); }));
  EXPECT_THAT(live.recording(2).recording.beams, SizeIs(2)) << "what came before the state is kept";
  EXPECT_FALSE(changes([&] { stream.send(3, stateOf(7, 5.01)); }));
  EXPECT_FALSE(changes([&] { stream.send(4, emissionOf(7, {1, 2})); }));
  EXPECT_TRUE(changes([&] { stream.send(5, emissionOf(7, {1, 2, 3})); }));
  EXPECT_FALSE(changes([&] { stream.send(6, emissionOf(7, {2})); })) << "version 7: told in part";
  stream.version = 6;
  EXPECT_TRUE(changes([&] { stream.send(7, emissionOf(7, {2})); })) << "version 6: the others are off";
  EXPECT_THAT(live.recording(7).recording.beams, SizeIs(1));
  dis::Emission silent;
  silent.entity = {1, 1, 7};
  EXPECT_TRUE(changes([&] { stream.send(8, silent); }));
  EXPECT_THAT(live.recording(8).recording.beams, IsEmpty());
  dis::EntityState destroyed = stateOf(7);
  destroyed.appearance = 3 << 3;
  EXPECT_TRUE(changes([&] { stream.send(9, destroyed); }));
}

TEST(LiveDis, PositionsOutsideOfTheLimitsAreCountedAndNotUsed) {
  Stream stream;
  const auto stateAt = [](int entity, double height_m) {
    dis::EntityState state = stateOf(entity);
    state.position_m = toEcef({0, 5, height_m});
    return state;
  };
  stream.send(1, stateAt(1, 35786000));
  stream.send(1, stateAt(2, 500));
  EXPECT_EQ(stream.live.counts().outside, 1);
  EXPECT_EQ(stream.live.objectCount(), 1u);
  EXPECT_THAT(stream.live.recording(1).recording.objects, SizeIs(1));
  stream.send(2, stateAt(1, 90000));
  EXPECT_EQ(stream.live.objectCount(), 2u) << "it has come down";
  dis::EntityState climbs = stateAt(2, 99000);
  climbs.velocity_mps = {5000, 0, 0};
  stream.send(3, climbs);
  for (const LivePose& at : stream.live.poses(5)) EXPECT_LE(at.pose.height_msl_m, 100000);
}

TEST(LiveDis, WhatIsNotUpdatedIsForgotten) {
  Stream stream;
  stream.send(0, stateOf(1));
  stream.send(0, stateOf(2));
  stream.send(0, emissionOf(2, {1}));
  for (double t_s = 1; t_s < 30; ++t_s) {
    stream.send(t_s, stateOf(2, 5 + t_s / 1000));
    stream.live.expire(t_s);
    EXPECT_EQ(stream.live.objectCount(), t_s <= 12 ? 2u : 1u) << t_s;
    EXPECT_EQ(stream.live.recording(t_s).recording.beams.size(), t_s <= 24 ? 1u : 0u) << t_s;
  }
}

TEST(LiveDis, LateAndRepeatedStatesAreCountedAndNotUsed) {
  Stream stream;
  Header header;
  const auto sendAt = [&](double arrival_s, double sent_s, double longitude_deg) {
    header.timestamp = static_cast<std::uint32_t>(sent_s / 3600 * dis::kTimestampsPerHour) << 1;
    const auto bytes = dis::encode(header, stateOf(1, longitude_deg));
    stream.live.take(bytes.data(), bytes.size(), arrival_s);
  };
  sendAt(10, 10, 5);
  sendAt(11, 11, 5.1);
  sendAt(11.1, 10.5, 5.05);
  sendAt(11.2, 11, 5.1);
  EXPECT_EQ(stream.live.counts().late, 1);
  EXPECT_EQ(stream.live.counts().duplicates, 1);
  EXPECT_EQ(stream.live.counts().records, 4);
  EXPECT_NEAR(stream.live.poses(11).at(0).pose.longitude_deg, 5.1, 1e-6);
}

TEST(LiveDis, AHostileStreamIsCountedAndItsMemoryIsBounded) {
  Stream stream;
  for (int n = 0; n < 100000; ++n) {
    dis::EntityState state = stateOf(n & 0xFFFF);
    state.id.site = static_cast<std::uint16_t>(n >> 8);
    stream.send(n * 1e-4, state);
    if (n % 10 == 0) {
      dis::Emission emission = emissionOf(n & 0xFFFF, {1, 2, 3, 4, 5, 6, 7, 8});
      emission.entity.site = static_cast<std::uint16_t>(n >> 8);
      stream.send(n * 1e-4, emission);
    }
  }
  EXPECT_EQ(stream.live.objectCount(), LiveLimits::kObjects);
  EXPECT_LE(stream.live.recording(10).recording.beams.size(), LiveLimits::kBeams);
  EXPECT_GT(stream.live.counts().forgotten, 90000);
  // Lengths that lie, and values that nothing has.
  std::mt19937 random(1);
  for (int n = 0; n < 20000; ++n) {
    dis::EntityState state = stateOf(n % 100);
    state.velocity_mps = {1e30, std::nan(""), -1e30};
    Header header;
    auto bytes = dis::encode(header, state);
    for (int change = 0; change < 4; ++change)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    stream.live.take(bytes.data(), random() % (bytes.size() + 1), 10 + n * 1e-4);
  }
  EXPECT_GT(stream.live.counts().bad, 1000);
  EXPECT_THAT(stream.live.counts().first_bad, testing::Not(IsEmpty()));
  for (const LivePose& live : stream.live.poses(12)) {
    EXPECT_TRUE(std::isfinite(live.pose.latitude_deg) && std::isfinite(live.pose.height_msl_m));
  }
  stream.live.expire(1e6);
  EXPECT_EQ(stream.live.objectCount(), 0u);
}

/// Feeds a text in pieces.
void feed(LiveState& live, const std::string& text, std::size_t piece = 7, double time_s = 0) {
  for (std::size_t at = 0; at < text.size(); at += piece) {
    const std::string part = text.substr(at, piece);
    live.take(reinterpret_cast<const std::uint8_t*>(part.data()), part.size(), 0);
  }
  live.expire(time_s);
}

const char* const kAcmiHeader =
    "\xEF\xBB\xBF"
    "FileType=text/acmi/tacview\nFileVersion=2.2\n";

TEST(LiveAcmi, ObjectsAreWhereTheyWereToldLastUntilTheyAreRemoved) {
  LiveAcmi live;
  feed(live,
       std::string(kAcmiHeader) +
           "0,ReferenceLongitude=5\n#1\na,T=0.1|52|3000|0|0|90,Type=Air+FixedWing,Name=F-14B,RadarMode=1,"
           "RadarHorizontalBeamwidth=3\nb,T=0.2|52|0,Type=Sea+Watercraft,Name=Boat\n");
  EXPECT_EQ(live.objectCount(), 2u);
  const long long revision = live.revision();
  feed(live, "#2\na,T=0.15|\n", 7, 1);
  EXPECT_EQ(live.revision(), revision);
  EXPECT_NEAR(live.poses(0).at(0).pose.longitude_deg, 5.15, 1e-9);
  EXPECT_THAT(live.recording(0).recording.beams, SizeIs(1));
  feed(live, "-b\n", 7, 2);
  EXPECT_NE(live.revision(), revision);
  EXPECT_EQ(live.objectCount(), 1u);
}

TEST(LiveAcmi, AStreamThatLiesIsCountedAndItsMemoryIsBounded) {
  LiveAcmi live;
  feed(live, kAcmiHeader);
  std::string many;
  for (int id = 1; id <= 20000; ++id)
    many += "#" + std::to_string(id) + "\n" + std::to_string(id) + ",T=5|52|0\n";
  feed(live, many, 1000, 1);
  EXPECT_EQ(live.objectCount(), LiveLimits::kObjects);
  feed(live, std::string(3 << 20, 'x') + "\n1,T=nonsense\nno id\n", 1 << 16, 2);
  EXPECT_EQ(live.counts().bad, 3) << "a line that is too long, a place, an id";
}

TEST(LiveAcmi, ALineWithoutEndIsCountedOnceAndBeforeItsEnd) {
  LiveAcmi live;
  feed(live, kAcmiHeader);
  feed(live, std::string(2 << 20, 'x'), 1 << 16);
  EXPECT_EQ(live.counts().bad, 1);
  feed(live, "\n");
  EXPECT_EQ(live.counts().bad, 1);
  std::string joined;
  for (int i = 0; i < 300; ++i) joined += std::string(6000, 'y') + "\\\n";
  feed(live, joined, 1 << 16);
  EXPECT_EQ(live.counts().bad, 2);
}

TEST(LiveAcmi, WhatIsTakenIsThereAtOnceAndMeasuredAgainAFifthOfASecondLater) {
  LiveAcmi live;
  feed(live, std::string(kAcmiHeader) + "a,T=5|52|0,Type=Sea,Name=Boat\n");
  const auto takeAt = [&live](double time_s, const std::string& text) {
    live.take(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), time_s);
    live.expire(time_s);
  };
  takeAt(1000, "b,T=5.1|52|0,Type=Sea,Name=Second\n");
  EXPECT_EQ(live.objectCount(), 2u);
  takeAt(1000.05, "a,T=6||\nc,T=5.2|52|0,Type=Sea,Name=Third\n");
  EXPECT_EQ(live.objectCount(), 2u);
  EXPECT_THAT(live.poses(0), testing::Contains(testing::Truly([](const LivePose& at) {
                return at.key == 0xa && at.pose.longitude_deg == 6;
              })));
  live.expire(1000.3);
  EXPECT_EQ(live.objectCount(), 3u);
}

TEST(LiveAcmi, AnglesBeyondATurnAreDirectionsWithinIt) {
  LiveAcmi live;
  feed(live, std::string(kAcmiHeader) + "a,T=5|52|3000|-725|3|400,Type=Air,Name=F-14B\n");
  for (const PoseSample& pose :
       {live.poses(0).at(0).pose, live.recording(0).recording.objects.at(0).poses.at(0)}) {
    EXPECT_NEAR(pose.heading_deg, 40, 1e-9);
    EXPECT_NEAR(pose.roll_deg, -5, 1e-9);
  }
}

TEST(LiveAcmi, APositionBeyondThePoleIsCountedOnce) {
  LiveAcmi live;
  feed(live, std::string(kAcmiHeader) + "0,ReferenceLatitude=50\n#1\na,T=5|2|0,Name=Boat\n#2\na,T=5|60|0\n");
  feed(live, "b,T=5|1|0,Name=Second\n", 7, 1);
  EXPECT_EQ(live.counts().bad, 1);
  EXPECT_THAT(live.counts().first_bad, HasSubstr("ReferenceLatitude"));
  for (const LivePose& at : live.poses(0)) EXPECT_LE(at.pose.latitude_deg, 52);
  EXPECT_EQ(live.objectCount(), 2u) << "the position before it stays";
}

TEST(LiveAcmi, JoinedLinesAreOneRecord) {
  LiveAcmi live;
  feed(live, std::string(kAcmiHeader) + "a,T=5|52|0,Label=two\\\nlines,Name=Boat\r\n");
  EXPECT_EQ(live.counts().bad, 0);
  EXPECT_EQ(live.recording(0).recording.objects.at(0).name, "Boat");
}

std::string cotOf(const std::string& uid, const std::string& type, int time_s, int life_s,
                  const std::string& detail, double longitude_deg = 5) {
  return "<event version='2.0' uid='" + uid + "' type='" + type + "' time='" + utcTextOf(time_s) +
         "' start='" + utcTextOf(time_s) + "' stale='" + utcTextOf(time_s + life_s) +
         "'><point lat='52' lon='" + std::to_string(longitude_deg) + "' hae='50'/><detail>" + detail +
         "</detail></event>";
}

TEST(LiveCot, ObjectsAreWhereTheyWereToldLastUntilTheyAreStaleByTheirOwnClock) {
  LiveCot live(true);
  const std::string carrier = "<contact callsign='Viper'/><track course='90' speed='0'/>";
  const std::string text = cotOf("a", "a-h-A-M-F", 1000, 20, carrier) +
                           cotOf("s", "b-m-p-s-p-loc", 1000, 20,
                                 "<link uid='a' relation='p-p'/><sensor azimuth='100' fov='30'/>") +
                           cotOf("b", "a-f-G", 1000, 300, "");
  feed(live, text, 7);
  EXPECT_EQ(live.objectCount(), 2u);
  const LiveRecording now = live.recording(0);
  ASSERT_THAT(now.recording.objects, SizeIs(2));
  EXPECT_EQ(now.recording.objects[0].name, "Viper");
  EXPECT_EQ(now.recording.objects[0].side, Side::hostile);
  ASSERT_THAT(now.recording.beams, SizeIs(1));
  EXPECT_NEAR(now.recording.beams[0].states.at(0).azimuth_deg, 10, 1e-9) << "from the carrier's heading";
  const long long revision = live.revision();
  feed(live, cotOf("b", "a-f-G", 1010, 300, "", 5.1));
  EXPECT_EQ(live.revision(), revision) << "a movement";
  EXPECT_NEAR(live.poses(0).at(1).pose.longitude_deg, 5.1, 1e-6);
  EXPECT_EQ(live.poses(0).at(1).key, now.keys.at(1));
  feed(live, cotOf("b", "a-f-G", 1005, 300, "", 5.2) + cotOf("b", "a-f-G", 1010, 300, "", 5.1));
  EXPECT_EQ(live.counts().late, 1);
  EXPECT_EQ(live.counts().duplicates, 1);
  live.expire(19);
  EXPECT_EQ(live.objectCount(), 2u);
  live.expire(21);
  EXPECT_EQ(live.objectCount(), 1u) << "whatever the clock of this computer tells";
  EXPECT_THAT(live.recording(0).recording.beams, IsEmpty());
  feed(live, cotOf("x", "t-x-d-d", 1020, 20, "<link uid='b' relation='none'/>"));
  EXPECT_EQ(live.objectCount(), 0u);
}

TEST(LiveCot, AClockThatIsSetBackIsFollowed) {
  LiveCot live(true);
  feed(live, cotOf("b", "a-f-G", 10000, 300, "", 5) + cotOf("b", "a-f-G", 2800, 300, "", 5.1));
  EXPECT_NEAR(live.poses(0).at(0).pose.longitude_deg, 5.1, 1e-6);
  EXPECT_EQ(live.counts().late, 0);
}

TEST(LiveCot, AHostileStreamIsCountedAndItsMemoryIsBounded) {
  LiveCot live(false);
  const auto send = [&](const std::string& bytes) {
    live.take(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), 0);
  };
  for (int i = 0; i < 20000; ++i) send(cotOf("o" + std::to_string(i), "a-f-G", 1000, 1000000, ""));
  EXPECT_EQ(live.objectCount(), LiveLimits::kObjects);
  EXPECT_EQ(live.counts().forgotten, 20000 - static_cast<long long>(LiveLimits::kObjects));
  send("<event uid='cut'");
  send("/></event>");
  send("\xBF\x01\xBF\x12");
  send(cotOf("o1", "a-f-G", 2000, 10, "", 1e9));
  EXPECT_EQ(live.counts().bad, 4);
  EXPECT_THAT(live.counts().first_bad, HasSubstr("without an <event>"));
  EXPECT_THAT(live.recording(0).recording.objects, SizeIs(LiveLimits::kObjects));
}

TEST(AcmiHandshake, HashesOfPasswordsAreThePublishedOnes) {
  EXPECT_EQ(acmiHash64("local"), "16d6497244e5930b");
  EXPECT_EQ(acmiHash32("local"), "e528f7a6");
}

TEST(AcmiHandshake, AHostTakesEitherHashAndRefusesOthers) {
  const std::string begin = "XtraLib.Stream.0\nTacview.RealTimeTelemetry.0\nClient\n";
  EXPECT_EQ(acmiClientFault(begin + "0", ""), "");
  EXPECT_EQ(acmiClientFault(begin + "e528f7a6", "local"), "");
  EXPECT_EQ(acmiClientFault(begin + "16d6497244e5930b", "local"), "");
  EXPECT_THAT(acmiClientFault(begin + "0", "local"), HasSubstr("the password is wrong"));
  EXPECT_THAT(acmiHostFault("HTTP/1.1 400 Bad Request"), HasSubstr("real-time protocol"));
  EXPECT_EQ(acmiHostFault(acmiHostHello("Emscape")), "");
  EXPECT_EQ(acmiClientHello("a", "local").back(), '\0');
}

}  // namespace
}  // namespace emscape::interop
