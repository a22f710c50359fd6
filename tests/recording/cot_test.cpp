// Reading of Cursor on Target.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/base/geodesy/geoid.h"
#include "recording/cot/cot_reader.h"

namespace emscape::interop {
namespace {

using testing::HasSubstr;

/// @param time, stale  seconds past the minute
std::string eventOf(const std::string& uid, const std::string& type, int time, int stale,
                    const std::string& point, const std::string& detail = "") {
  const auto text = [](int second) {
    return "2026-06-01T06:00:" + std::string(second < 10 ? "0" : "") + std::to_string(second) + "Z";
  };
  return "<?xml version='1.0'?>\n<event version='2.0' uid='" + uid + "' type='" + type + "' time='" +
         text(time) + "' start='" + text(time) + "' stale='" + text(stale) + "' how='m-g'><point " + point +
         "/><detail>" + detail + "</detail></event>";
}

Recording readText(const std::string& text) {
  return readCot(*openText(text), {});
}

const std::string kPoint = "lat='52' lon='5' hae='50' ce='1' le='1'";

TEST(Cot, EventsAreObjectsWithTheirCallsignsAndSides) {
  const Recording r = readText(eventOf("a1", "a-h-A-M-F", 0, 20, kPoint,
                                       "<contact callsign='Viper'/><track course='90' speed='200'/>") +
                               eventOf("a1", "a-h-A-M-F", 10, 30, "lat='52' lon='5.1' hae='50'") +
                               eventOf("s1", "a-n-S", 5, 40, "lat='52' lon='5' hae='9999999'"));
  ASSERT_EQ(r.objects.size(), 2u);
  EXPECT_EQ(r.objects[0].name, "Viper");
  EXPECT_EQ(r.objects[0].domain, Domain::air);
  EXPECT_EQ(r.objects[0].side, Side::hostile);
  EXPECT_EQ(r.objects[0].keys.cot_type, "a-h-A-M-F");
  ASSERT_EQ(r.objects[0].poses.size(), 2u);
  EXPECT_EQ(r.objects[0].poses[0].heading_deg, 90);
  EXPECT_EQ(r.objects[0].poses[1].t_s, 10);
  EXPECT_NEAR(r.objects[0].poses[0].height_msl_m, 50 - geoidUndulation_m(52, 5), 1e-9);
  EXPECT_EQ(r.objects[1].side, Side::neutral);
  EXPECT_EQ(r.objects[1].poses[0].height_msl_m, 0);
  EXPECT_THAT(r.tally.notes, testing::Contains(HasSubstr("0 m is taken (1 time)")));
  EXPECT_EQ(r.epoch_ms, 1780293600000);
}

TEST(Cot, StaleObjectsAreAbsentUntilTheirNextEvent) {
  const Recording r = readText(eventOf("a", "a-f-G", 0, 5, kPoint) + eventOf("a", "a-f-G", 20, 25, kPoint) +
                               eventOf("b", "a-f-G", 40, 45, kPoint));
  const auto& presence = r.objects.at(0).presence;
  ASSERT_EQ(presence.size(), 3u);
  EXPECT_EQ(presence[0].t_s, 5);
  EXPECT_FALSE(presence[0].is_present);
  EXPECT_EQ(presence[1].t_s, 20);
  EXPECT_TRUE(presence[1].is_present);
  EXPECT_EQ(presence[2].t_s, 25);
}

TEST(Cot, StaleBeforeStartAndADeletionRemoveAnObject) {
  const Recording r =
      readText(eventOf("a", "a-f-G", 10, 50, kPoint) + eventOf("b", "a-f-G", 10, 50, kPoint) +
               eventOf("a", "a-f-G", 20, 19, kPoint) +
               eventOf("x", "t-x-d-d", 30, 50, kPoint, "<link uid='b' relation='none' type='none'/>"));
  EXPECT_EQ(r.objects.at(0).presence.at(0).t_s, 10);
  EXPECT_FALSE(r.objects[0].presence[0].is_present);
  EXPECT_EQ(r.objects.at(1).presence.at(0).t_s, 20);
}

TEST(Cot, SensorIsABeamFromTrueNorthOfTheLinkedObject) {
  const std::string attitude = "<spatial><attitude roll='0' pitch='0' yaw='100'/></spatial>";
  const Recording r = readText(eventOf("a", "a-f-A", 0, 30, kPoint, attitude) +
                               eventOf("s", "b-m-p-s-p-loc", 2, 12, kPoint,
                                       "<link uid='a' relation='p-p'/><sensor model='X band' azimuth='130' "
                                       "elevation='4' fov='3' vfov='5'/>") +
                               eventOf("a", "a-f-A", 20, 30, kPoint, attitude) +
                               eventOf("b", "a-f-A", 0, 30, kPoint, "<sensor azimuth='0' fov='60'/>"));
  ASSERT_EQ(r.objects.size(), 2u);
  ASSERT_EQ(r.beams.size(), 2u);
  EXPECT_EQ(r.beams[0].object, 0u);
  EXPECT_EQ(r.beams[0].name, "X band");
  const auto& states = r.beams[0].states;
  ASSERT_GE(states.size(), 2u);
  EXPECT_NEAR(states[0].azimuth_deg, 30, 1e-6);
  EXPECT_NEAR(states[0].elevation_deg, 4, 1e-6);
  EXPECT_EQ(states[0].beamwidth_az_deg, 3);
  EXPECT_EQ(states[0].beamwidth_el_deg, 5);
  EXPECT_EQ(states.back().t_s, 12) << "stale";
  EXPECT_FALSE(states.back().is_on);
  EXPECT_EQ(r.beams[1].object, 1u);
}

TEST(Cot, FaultsOtherEventsAndATornEndAreTold) {
  const Recording r = readText(eventOf("a", "a-f-G", 0, 50, kPoint) + eventOf("c", "b-t-f", 1, 50, kPoint) +
                               eventOf("a", "a-f-G", 2, 50, "lat='x' lon='5'") +
                               "<event uid='a'><point></event><event uid='a' type='a-f-G'");
  EXPECT_EQ(r.objects.size(), 1u);
  EXPECT_EQ(r.tally.bad, 2);
  EXPECT_THAT(r.tally.first_bad, HasSubstr("event 3: an event has uid, type, time, stale"));
  EXPECT_EQ(r.tally.ignored.at("event of type b-t-f"), 1);
  EXPECT_THAT(r.tally.torn, HasSubstr("the last event has no </event>"));
}

TEST(Cot, EntitiesAreNotResolved) {
  const Recording r = readText("<!DOCTYPE event [<!ENTITY e SYSTEM 'file:///etc/passwd'>]>" +
                               eventOf("a", "a-f-G", 0, 50, kPoint, "<contact callsign='a &e; b'/>"));
  EXPECT_EQ(r.objects.at(0).name, "a &e; b");
}

TEST(Cot, SplitterJoinsPiecesAndDropsWhatDoesNotEnd) {
  CotSplitter splitter;
  std::vector<std::string> events;
  const auto sink = [&](std::string_view event) { events.emplace_back(event); };
  const std::string text =
      "<events>" + eventOf("a", "t", 0, 1, kPoint) + eventOf("b", "t", 0, 1, kPoint) + "</events>";
  for (const char c : text) splitter.take(std::string_view(&c, 1), sink);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1].find("<event version"), 0u);
  EXPECT_THAT(events[1], HasSubstr("uid='b'"));
  splitter.take("<event " + std::string(CotSplitter::kLongest, 'x'), sink);
  EXPECT_EQ(splitter.dropped(), 1);
  splitter.take(eventOf("c", "t", 0, 1, kPoint), sink);
  EXPECT_EQ(events.size(), 3u);
}

}  // namespace
}  // namespace emscape::interop
