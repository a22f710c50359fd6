#include "apps/view/playhead.h"

#include <gtest/gtest.h>

namespace emscape::view {
namespace {

Playhead withSteps() {
  Playhead playhead;
  playhead.setTimes_s({0, 0.5, 1, 1.5, 2});
  return playhead;
}

TEST(Playhead, SeekTakesTheNearestStep) {
  Playhead playhead = withSteps();
  playhead.seek(0.7);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 0.5);
  playhead.seek(0.8);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 1);
  playhead.seek(-5);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 0);
  playhead.seek(99);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 2);
}

TEST(Playhead, StepsStayWithinTheSeriesAndPause) {
  Playhead playhead = withSteps();
  playhead.play();
  playhead.stepBy(3);
  EXPECT_FALSE(playhead.playing());
  EXPECT_EQ(playhead.step(), 3);
  playhead.stepBy(9);
  EXPECT_EQ(playhead.step(), 4);
  playhead.stepBy(-99);
  EXPECT_EQ(playhead.step(), 0);
}

TEST(Playhead, PlayingFollowsTheRateAndEndsAtTheEnd) {
  Playhead playhead = withSteps();
  playhead.setRate(2);
  playhead.play();
  playhead.advance(0.3);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 0.5);
  EXPECT_NEAR(*playhead.untilNextStep_s(), 0.2, 1e-9);
  playhead.advance(10);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 2);
  EXPECT_FALSE(playhead.playing());
  EXPECT_FALSE(playhead.untilNextStep_s());
  playhead.play();  // from the beginning
  EXPECT_DOUBLE_EQ(playhead.step_s(), 0);
}

TEST(Playhead, ALoopShowsTheLastStepAsLongAsTheOthers) {
  Playhead playhead = withSteps();
  playhead.setLoop(true);
  playhead.play();
  playhead.advance(2.4);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 2);
  playhead.advance(0.2);
  EXPECT_DOUBLE_EQ(playhead.step_s(), 0);
  EXPECT_TRUE(playhead.playing());
  playhead.advance(1e6);
  EXPECT_TRUE(playhead.playing());
}

TEST(Playhead, RatesGoThroughTheUsualOnes) {
  Playhead playhead;
  playhead.changeRate(1);
  EXPECT_DOUBLE_EQ(playhead.rate(), 2);
  playhead.setRate(7);
  playhead.changeRate(1);
  EXPECT_DOUBLE_EQ(playhead.rate(), 10);
  playhead.setRate(7);
  playhead.changeRate(-1);
  EXPECT_DOUBLE_EQ(playhead.rate(), 5);
  for (int i = 0; i < 20; ++i) playhead.changeRate(-1);
  EXPECT_DOUBLE_EQ(playhead.rate(), 0.1);
}

TEST(Playhead, ASeriesOfOneStepDoesNotPlay) {
  Playhead playhead;
  playhead.setTimes_s({3});
  playhead.play();
  EXPECT_FALSE(playhead.playing());
  EXPECT_DOUBLE_EQ(playhead.step_s(), 3);
  EXPECT_EQ(Playhead().step(), -1);
}

}  // namespace
}  // namespace emscape::view
