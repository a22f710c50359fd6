#include <chrono>
#include <random>
#include <thread>

#include "tests/view/session_sample.h"

namespace emscape::view::test {
namespace {

class SessionTime : public SessionTest {};

TEST_F(SessionTime, StepsRatesAndTheirFaults) {
  perform(R"({"do":"step","steps":2})");
  EXPECT_EQ(session->timeline().step_s(), 2);
  perform(R"({"do":"step","steps":0.5})");
  EXPECT_EQ(error(), "step: steps 0.5: expected a whole number -1000000000..1000000000");
  perform(R"({"do":"step","steps":-1e9})");
  EXPECT_EQ(session->timeline().step_s(), 0);
  perform(R"({"do":"last"})");
  EXPECT_EQ(session->timeline().step_s(), 4);
  perform(R"({"do":"rate","value":-0.37})");
  EXPECT_EQ(session->timeline().rate(), -0.37);
  EXPECT_EQ(session->notice().text, "0.37 times real time, backwards");
  perform(R"({"do":"reverse"})");
  EXPECT_EQ(session->timeline().rate(), 0.37);
  for (const int expected : {1, 2, 3}) {
    perform(R"({"do":"rate","change":-1})");
    EXPECT_EQ(session->timeline().rate(), expected == 1 ? 0.25 : expected == 2 ? 0.1 : -0.1);
  }
  perform(R"({"do":"rate","value":0})");
  EXPECT_THAT(error(), testing::HasSubstr("rate: value 0: expected a number -10000..10000 other than 0"));
  perform(R"({"do":"rate"})");
  EXPECT_EQ(error(), "rate: expected value, change or steps_per_s");
  perform(R"({"do":"rate","steps_per_s":3})");
  EXPECT_EQ(session->timeline().rate(), 3);
  perform(R"({"do":"rate","value":-0.1})");
  perform(R"({"do":"rate","change":2})");
  EXPECT_EQ(error(), "rate: change 2: expected -1 or 1");
  EXPECT_EQ(session->timeline().rate(), -0.1);
}

TEST_F(SessionTime, TimesAreTypedInSecondsOrInUtc) {
  perform(R"({"do":"seek","time":"06:00:03"})");
  EXPECT_EQ(session->timeline().step_s(), 3);
  perform(R"({"do":"seek","time":"1.2"})");
  EXPECT_EQ(session->timeline().step_s(), 1);
  perform(R"({"do":"seek","time":"later"})");
  EXPECT_THAT(error(), testing::HasSubstr("time 'later': expected seconds (12.5, 1.5 min), M:SS"));
  for (const char* outside : {R"({"do":"seek","time":"500"})", R"({"do":"seek","time_s":500})",
                              R"({"do":"record","file":"film.mp4","end_s":1e9})",
                              R"({"do":"record","file":"film.mp4","begin":"0:01","end":"1:15:00"})"}) {
    perform(outside);
    EXPECT_THAT(error(), testing::HasSubstr("is not allowed; allowed: 0 s to 4 s")) << outside;
    EXPECT_EQ(session->timeline().step_s(), 1);
  }
  perform(R"({"do":"seek"})");
  EXPECT_THAT(error(), testing::HasSubstr("seek: expected either time_s or time"));
}

TEST_F(SessionTime, PlayingAndVisibleRangeAreSetByVerbs) {
  perform(R"({"do":"play_from","time_s":1.2})");
  perform(R"({"do":"seek","time_s":3})");
  perform(R"({"do":"play_to"})");
  EXPECT_EQ(session->report()["play_from_s"], 1);
  EXPECT_EQ(session->report()["play_to_s"], 3);
  perform(R"({"do":"play_all"})");
  EXPECT_EQ(session->report()["play_to_s"], 4);
  perform(R"({"do":"timeline","zoom":0.5,"about_s":2})");
  EXPECT_EQ(session->report()["visible_from_s"], 1);
  EXPECT_EQ(session->report()["visible_to_s"], 3);
  perform(R"({"do":"timeline","pan_s":0.5})");
  EXPECT_EQ(session->report()["visible_to_s"], 3.5);
  perform(R"({"do":"timeline","zoom":0})");
  EXPECT_THAT(error(), testing::HasSubstr("timeline: zoom 0: expected a number 1e-06..1000000"));
  perform(R"({"do":"timeline","from_s":3,"to_s":1})");
  EXPECT_EQ(error(), "timeline 3..1: expected from_s below to_s");
  perform(R"({"do":"timeline"})");
  EXPECT_EQ(session->report()["visible_from_s"], 0);
}

TEST_F(SessionTime, AnEditOfTheClockOrTheActivityChangesTheTimeLine) {
  ASSERT_EQ(session->timeline().bars().size(), 2U);
  perform(R"({"do":"set","path":"emitters.radar.active_s","value":"[[1, 2]]"})");
  EXPECT_EQ(session->timeline().bars()[0].intervals.front().begin_s, 1);
  perform(R"({"do":"set","path":"duration_s","value":"6"})");
  settle();
  EXPECT_EQ(session->timeline().end_s(), 6);
  EXPECT_EQ(session->timeline().bars()[1].intervals.front().end_s, 6);
}

TEST_F(SessionTime, TheTimeLineGetsARowForEachEmitterAndKeepsItAfterAnUndo) {
  EXPECT_EQ(session->mostEmitters(), 2U);
  perform(R"({"do":"add","what":"jammer"})");
  EXPECT_EQ(session->mostEmitters(), 3U);
  perform(R"({"do":"undo"})");
  EXPECT_EQ(session->timeline().bars().size(), 2U);
  EXPECT_EQ(session->mostEmitters(), 3U);
}

TEST_F(SessionTime, AfterSeeksDuringPlayingTheLastOneIsShown) {
  std::mt19937 random(7);
  perform(R"({"do":"loop","on":true})");
  perform(R"({"do":"rate","value":120})");
  for (int n = 0; n < 120; ++n) {
    switch (random() % 4) {
      case 0:
        perform(R"({"do":"play"})");
        break;
      case 1:
        perform(R"({"do":"reverse"})");
        break;
      default:
        session->perform({"seek", {{"time_s", static_cast<double>(random() % 41) / 10}}});
    }
    session->update();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  perform(R"({"do":"pause"})");
  perform(R"({"do":"seek","time_s":3})");
  settle();
  EXPECT_EQ(session->status().shown_s, 3);
  EXPECT_EQ(error(), "");
}

}  // namespace
}  // namespace emscape::view::test
