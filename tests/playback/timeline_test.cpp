#include "playback/editing/timeline.h"

#include "emscape/scenario/file/scenario_file.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

std::vector<double> halfSeconds(int count) {
  std::vector<double> times_s;
  for (int i = 0; i < count; ++i) times_s.push_back(0.5 * i);
  return times_s;
}

std::vector<double> timesOf(const std::vector<TimelineTick>& ticks) {
  std::vector<double> times_s;
  for (const TimelineTick& tick : ticks) times_s.push_back(tick.time_s);
  return times_s;
}

TEST(Timeline, TicksAreAtRoundTimesWithBothTexts) {
  const Timeline timeline(halfSeconds(241), "2026-06-01T06:00:00Z");
  const std::vector<TimelineTick> ticks = timeline.ticks(0, 120, 8);
  EXPECT_THAT(timesOf(ticks), ElementsAre(0, 15, 30, 45, 60, 75, 90, 105, 120));
  EXPECT_EQ(ticks[1].text, "15 s");
  EXPECT_EQ(ticks[5].utc_text, "06:01:15");
  const std::vector<TimelineTick> close = timeline.ticks(10.02, 11, 5);
  EXPECT_THAT(timesOf(close),
              ElementsAre(DoubleEq(10.2), DoubleEq(10.4), DoubleEq(10.6), DoubleEq(10.8), 11));
  EXPECT_EQ(close[0].text, "10.2 s");
  EXPECT_EQ(close[0].utc_text, "06:00:10.2");
  EXPECT_THAT(timesOf(timeline.ticks(0, 86400 * 30, 6)),
              ElementsAre(0, 432000, 864000, 1296000, 1728000, 2160000, 2592000));
  EXPECT_TRUE(timeline.ticks(5, 5, 5).empty());
  EXPECT_EQ(Timeline(halfSeconds(3)).ticks(0, 1, 2)[0].utc_text, "");
}

TEST(Timeline, LongTimeLinesHaveDaysAndDates) {
  std::vector<double> times_s;
  for (int step = 0; step <= 6 * 48; ++step) times_s.push_back(600.0 * step);  // two days
  const Timeline timeline(times_s, "2026-06-01T18:00:00Z");
  const std::vector<TimelineTick> ticks = timeline.ticks(0, 172800, 8);
  ASSERT_EQ(ticks.size(), 9U);
  EXPECT_EQ(ticks[0].text, "0 d 00:00");
  EXPECT_EQ(ticks[0].utc_text, "06-01 18:00:00");
  EXPECT_EQ(ticks[1].text, "0 d 06:00");
  EXPECT_EQ(ticks[1].utc_text, "06-02 00:00:00") << "the date where it changes";
  EXPECT_EQ(ticks[2].utc_text, "06:00:00");
  EXPECT_EQ(ticks[8].text, "2 d 00:00");
  const std::vector<TimelineTick> days = timeline.ticks(0, 86400 * 8, 8);
  EXPECT_EQ(days[3].text, "3 d");
  EXPECT_EQ(days[3].utc_text, "2026-06-04");
  EXPECT_TRUE(timeline.hasLongSteps());
  EXPECT_DOUBLE_EQ(timeline.stepsPerSecond(1200), 2);
  EXPECT_EQ(timeline.usualRates().back(), 5000) << "at most 10 steps per second";
  EXPECT_EQ(Timeline(seconds(3)).usualRates(), playRates());
}

TEST(Timeline, AContinuousOneShowsTimesBetweenSteps) {
  Timeline timeline(seconds(11));
  timeline.setContinuous(true);
  timeline.seek(3.3);
  EXPECT_EQ(timeline.asked_s(), 3.3);
  EXPECT_EQ(timeline.step_s(), 3);
  timeline.stepBy(1);
  EXPECT_EQ(timeline.asked_s(), 4) << "the next step";
  timeline.seek(3.7);
  timeline.stepBy(1);
  EXPECT_EQ(timeline.asked_s(), 4);
  timeline.seek(3.7);
  timeline.stepBy(-1);
  EXPECT_EQ(timeline.asked_s(), 3);
  timeline.seek(3.3);
  timeline.stepBy(-2);
  EXPECT_EQ(timeline.asked_s(), 2);
  timeline.seek(0);
  timeline.play();
  timeline.advance(1.2345678);
  EXPECT_EQ(timeline.asked_s(), 1.23) << "no more decimals than the eye sees";
  EXPECT_EQ(timeline.untilNextStep_s(), 0);
  timeline.pause();
  EXPECT_EQ(timeline.time_s(), 1.23);
  timeline.setContinuous(false);
  EXPECT_EQ(timeline.asked_s(), 1);
}

TEST(Timeline, TypedTimesAreThoseOfTheSeries) {
  const Timeline timeline(halfSeconds(241), "2026-06-01T06:00:00Z");
  EXPECT_EQ(timeline.parseTime_s("1:15"), 75) << "of the clock, not 01:15 UTC";
  EXPECT_EQ(timeline.parseTime_s("2026-06-01T06:01:10Z"), 70) << "as the picture writes it";
  for (const char* outside : {"500", "-1", "121", "3:00", "05:59:59"}) {
    EXPECT_EQ(errorOf([&] { timeline.parseTime_s(outside); }),
              std::string("time '") + outside +
                  "' is not allowed; allowed: 0 s to 120 s, 2026-06-01T06:00:00Z to 2026-06-01T06:02:00Z");
  }
  EXPECT_THAT(errorOf([&] { timeline.requireTime(120.5); }),
              testing::HasSubstr("time '120.5' is not allowed"));
  timeline.requireTime(120);
  EXPECT_THAT(errorOf([&] { Timeline(halfSeconds(3)).parseTime_s("12:00"); }),
              testing::HasSubstr("time '12:00' is not allowed; allowed: 0 s to 1 s"));
  EXPECT_EQ(Timeline().parseTime_s("12:00"), 720) << "before the input is open";
}

TEST(Timeline, TicksOfEveryZoomAreAboutAsManyAsAskedFor) {
  const Timeline timeline(halfSeconds(3));
  for (double span_s = 1e-3; span_s < 1e8; span_s *= 1.3) {
    const auto count = timeline.ticks(0, span_s, 10).size();
    EXPECT_GE(count, 4u) << span_s;
    EXPECT_LE(count, 12u) << span_s;
  }
}

TEST(Timeline, BarsShowWhenEmittersRadiate) {
  const TemporaryFolder folder;
  const auto scenario = scenario::loadScenario(quickScenario(
      folder, {{"    power_w: 10000\n", "    power_w: 10000\n    active_s: [[0, 1], [1, 2], [3, 99]]\n"}}));
  const Timeline timeline(seconds(5), *scenario);
  ASSERT_EQ(timeline.bars().size(), 2u);
  EXPECT_EQ(timeline.bars()[0].emitter, "radar");
  ASSERT_EQ(timeline.bars()[0].intervals.size(), 2u);
  EXPECT_EQ(timeline.bars()[0].intervals[0].begin_s, 0);
  EXPECT_EQ(timeline.bars()[0].intervals[0].end_s, 2);
  EXPECT_EQ(timeline.bars()[0].intervals[1].begin_s, 3);
  EXPECT_EQ(timeline.bars()[0].intervals[1].end_s, 4);
  ASSERT_EQ(timeline.bars()[1].intervals.size(), 1u);
  EXPECT_EQ(timeline.bars()[1].intervals[0].end_s, 4);
}

TEST(Timeline, CachedStepsAreSpansOfTime) {
  const Timeline timeline(seconds(6));
  const auto spans = timeline.cachedSpans({0, 1, 3, 5, 77});
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_EQ(spans[0].begin_s, 0);
  EXPECT_EQ(spans[0].end_s, 1.5);
  EXPECT_EQ(spans[1].begin_s, 2.5);
  EXPECT_EQ(spans[1].end_s, 3.5);
  EXPECT_EQ(spans[2].begin_s, 4.5);
  EXPECT_EQ(spans[2].end_s, 5);
  EXPECT_TRUE(timeline.cachedSpans({}).empty());
}

TEST(Timeline, StepsGoToTheStepsOfTheSource) {
  Timeline timeline({0, 1, 2.5, 4});
  EXPECT_EQ(timeline.nearestStep(-10), 0);
  EXPECT_EQ(timeline.nearestStep(0.5), 0);
  EXPECT_EQ(timeline.nearestStep(0.51), 1);
  EXPECT_EQ(timeline.nearestStep(2.5), 2);
  EXPECT_EQ(timeline.nearestStep(99), 3);
  timeline.seek(1.2);
  EXPECT_EQ(timeline.time_s(), 1.2);
  timeline.stepBy(1);
  EXPECT_EQ(timeline.time_s(), 2.5);
  timeline.stepBy(-2);
  EXPECT_EQ(timeline.time_s(), 0);
  timeline.stepBy(-1);
  EXPECT_EQ(timeline.time_s(), 0);
  timeline.stepBy(1 << 30);
  EXPECT_EQ(timeline.time_s(), 4);
  timeline.goToFirst();
  EXPECT_EQ(timeline.time_s(), 0);
  timeline.goToLast();
  EXPECT_EQ(timeline.step(), 3);
  timeline.seek(77);
  EXPECT_EQ(timeline.time_s(), 4);
  timeline.seek(std::nan(""));
  EXPECT_EQ(timeline.time_s(), 4);
}

TEST(Timeline, AdvancesByTheRateAndStopsAtTheEnds) {
  Timeline timeline(seconds(11));
  EXPECT_EQ(timeline.advance(1), 0);
  timeline.play();
  EXPECT_EQ(timeline.advance(1), 1);
  timeline.setRate(5);
  EXPECT_EQ(timeline.advance(0.5), 3.5);
  timeline.reverse();
  EXPECT_EQ(timeline.advance(0.2), 2.5);
  EXPECT_TRUE(timeline.playing());
  EXPECT_EQ(timeline.advance(10), 0);
  EXPECT_FALSE(timeline.playing());
  timeline.play();  // backwards, at the beginning: from the end
  EXPECT_EQ(timeline.time_s(), 10);
  timeline.reverse();
  timeline.play();
  EXPECT_EQ(timeline.time_s(), 0);
  EXPECT_EQ(timeline.advance(10), 10);
  timeline.stepBy(-1);
  EXPECT_FALSE(timeline.playing());
}

TEST(Timeline, ALoopGoesOnFromTheOtherEnd) {
  Timeline timeline({10, 11, 12, 13, 14});
  timeline.setLoop(true);
  timeline.play();
  EXPECT_EQ(timeline.advance(5.5), 11.5);
  EXPECT_EQ(timeline.advance(41), 12.5);
  timeline.setRate(-1);
  EXPECT_EQ(timeline.advance(3), 13.5);
  EXPECT_TRUE(timeline.playing());
}

TEST(Timeline, OneStepDoesNotPlay) {
  Timeline timeline({3});
  timeline.setLoop(true);
  timeline.play();
  EXPECT_FALSE(timeline.playing());
  EXPECT_EQ(timeline.advance(1), 3);
}

TEST(Timeline, RatesSnapAndGoUpAndDownInEitherDirection) {
  EXPECT_THAT(playRates(), ElementsAre(0.1, 0.25, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1000));
  Timeline timeline(seconds(2));
  for (const double rate : {2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1000.0, 1000.0}) {
    timeline.changeRate(1);
    EXPECT_EQ(timeline.rate(), rate);
  }
  timeline.setRate(0.3);
  for (const double rate : {0.25, 0.1, -0.1, -0.25, -0.5}) {
    timeline.changeRate(-1);
    EXPECT_EQ(timeline.rate(), rate) << "slower, then backwards";
  }
  timeline.changeRate(1);
  EXPECT_EQ(timeline.rate(), -0.25);
  timeline.setRate(-5000);
  timeline.changeRate(-1);
  EXPECT_EQ(timeline.rate(), -5000);
  timeline.setRate(0);
  EXPECT_EQ(timeline.rate(), -5000);
}

TEST(Timeline, WithoutStepsTimeIsConstant) {
  Timeline timeline;
  timeline.play();
  EXPECT_FALSE(timeline.playing());
  timeline.stepBy(3);
  timeline.goToLast();
  timeline.setPlayRange(1, 2);
  timeline.zoom(0.5, 1);
  EXPECT_EQ(timeline.step_s(), 0);
  timeline.seek(3);  // before the steps are known
  timeline.setSteps(seconds(6));
  EXPECT_EQ(timeline.step(), 3);
}

TEST(Timeline, PlaysWithinTheRangeThatIsSet) {
  Timeline timeline(seconds(11));
  timeline.setPlayRange(2.2, 4.9);
  EXPECT_EQ(timeline.playRange().begin_s, 2) << "at steps";
  EXPECT_EQ(timeline.playRange().end_s, 5);
  timeline.play();
  EXPECT_EQ(timeline.time_s(), 2);
  EXPECT_EQ(timeline.advance(10), 5);
  EXPECT_FALSE(timeline.playing());
  timeline.setLoop(true);
  timeline.play();
  EXPECT_EQ(timeline.advance(4), 3);
  timeline.setRate(-1);
  EXPECT_EQ(timeline.advance(2), 4);
  timeline.setLoop(false);
  timeline.seek(8);  // out of the range while it plays backwards: into it
  EXPECT_EQ(timeline.advance(1), 7);
  timeline.setRate(1);
  EXPECT_EQ(timeline.advance(1), 7) << "beyond the end it stops where it is";
  EXPECT_FALSE(timeline.playing());
  timeline.setPlayRange(3, 3);
  EXPECT_EQ(timeline.playRange().end_s, 4) << "two steps at least";
  timeline.setPlayRange(10, 10);
  EXPECT_EQ(timeline.playRange().begin_s, 9);
  timeline.setPlayRange(3, 6);
  timeline.setPlayBegin(8);
  EXPECT_EQ(timeline.playRange().begin_s, 5) << "a step before the end";
  timeline.setPlayEnd(-1);
  EXPECT_EQ(timeline.playRange().end_s, 6);
  timeline.playAll();
  EXPECT_EQ(timeline.playRange().begin_s, 0);
  EXPECT_EQ(timeline.playRange().end_s, 10);
}

TEST(Timeline, SaysWhenTheNextStepIsDue) {
  Timeline timeline({0, 1, 3});
  EXPECT_FALSE(timeline.untilNextStep_s());
  timeline.setRate(2);
  timeline.play();
  EXPECT_DOUBLE_EQ(*timeline.untilNextStep_s(), 0.25);
  timeline.seek(1);
  EXPECT_DOUBLE_EQ(*timeline.untilNextStep_s(), 0.5);
  timeline.setRate(-1);
  EXPECT_DOUBLE_EQ(*timeline.untilNextStep_s(), 0.5);
  timeline.seek(0.25);
  EXPECT_DOUBLE_EQ(*timeline.untilNextStep_s(), 0.25);
}

TEST(Timeline, ZoomsAboutATimeAndPansWithTheCursor) {
  Timeline timeline(seconds(101));
  timeline.zoom(0.5, 20);
  EXPECT_EQ(timeline.visible().begin_s, 10);
  EXPECT_EQ(timeline.visible().end_s, 60);
  timeline.pan(100);
  EXPECT_EQ(timeline.visible().begin_s, 50);
  EXPECT_EQ(timeline.visible().end_s, 100);
  timeline.zoom(100, 60);
  EXPECT_EQ(timeline.visible().end_s - timeline.visible().begin_s, 100);
  timeline.setVisible(3, 3);
  EXPECT_EQ(timeline.visible().end_s, 100) << "no length";
  timeline.zoom(1e-12, 50);
  EXPECT_NEAR(timeline.visible().end_s - timeline.visible().begin_s, 1e-4, 1e-9);
  timeline.setVisible(0, 10);
  timeline.play();
  timeline.advance(12);
  EXPECT_EQ(timeline.visible().begin_s, 12);
  EXPECT_EQ(timeline.visible().end_s, 22);
  timeline.seek(50);  // the user looks elsewhere
  timeline.advance(1);
  EXPECT_EQ(timeline.visible().begin_s, 12);
  timeline.showAll();
  EXPECT_EQ(timeline.visible().begin_s, 0);
}

TEST(Timeline, OtherStepsKeepTimeAndRangeWithinThem) {
  Timeline timeline(seconds(11));
  timeline.seek(9);
  timeline.setPlayRange(2, 9);
  timeline.setVisible(1, 8);
  timeline.setRate(5);
  timeline.setSteps(seconds(6));
  EXPECT_EQ(timeline.time_s(), 5);
  EXPECT_EQ(timeline.playRange().begin_s, 2);
  EXPECT_EQ(timeline.playRange().end_s, 5);
  EXPECT_EQ(timeline.visible().end_s, 5);
  EXPECT_EQ(timeline.rate(), 5);
}

}  // namespace
}  // namespace emscape::playback::test
