#include "render/patterns/frame_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emscape/base/error.h"

namespace emscape::render {
namespace {

using testing::HasSubstr;
using Kind = ControllerAction::Kind;
using State = ControllerState;

ControllerOptions with(Pattern pattern, double epsilon_ms = 100) {
  ControllerOptions options;
  options.pattern = pattern;
  options.epsilon_ms = epsilon_ms;
  return options;
}

/// Sends an event at `now_ms` and draws the requested frame; the frame takes no simulated time.
void eventAndFrame(FrameController& controller, double now_ms, double draw_ms = 20) {
  controller.event(SceneEvent::field, now_ms);
  ASSERT_EQ(controller.next(now_ms).kind, Kind::draw);
  controller.frameDone({draw_ms, 0});
}

TEST(FrameController, IsIdleBeforeFirstEvent) {
  FrameController controller;
  EXPECT_EQ(controller.state(), State::idle);
  const ControllerAction action = controller.next(0);
  EXPECT_EQ(action.kind, Kind::wait);
  EXPECT_TRUE(std::isinf(action.until_ms));
}

TEST(FrameController, EveryKindOfEventMakesItBusy) {
  for (const SceneEvent event : {SceneEvent::transfer_function, SceneEvent::view, SceneEvent::field,
                                 SceneEvent::resized, SceneEvent::mode}) {
    FrameController controller(with(Pattern::columns));
    controller.event(event, 5);
    EXPECT_EQ(controller.state(), State::busy);
    const ControllerAction action = controller.next(5);
    EXPECT_EQ(action.kind, Kind::draw);
    EXPECT_EQ(action.plan.pattern, Pattern::columns);
  }
}

TEST(FrameController, OneFrameAnEventAndNoneWithout) {
  FrameController controller(with(Pattern::columns));
  eventAndFrame(controller, 0);
  const ControllerAction action = controller.next(20);
  EXPECT_EQ(action.kind, Kind::wait);
  EXPECT_EQ(action.until_ms, 100);
}

TEST(FrameController, AnEventDuringAFrameAsksForAnotherFrame) {
  FrameController controller(with(Pattern::columns));
  controller.event(SceneEvent::view, 0);
  ASSERT_EQ(controller.next(0).kind, Kind::draw);
  controller.event(SceneEvent::view, 10);
  EXPECT_EQ(controller.next(10).kind, Kind::wait);  // the frame is still being drawn
  controller.frameDone({20, 0});
  EXPECT_EQ(controller.next(20).kind, Kind::draw);
  controller.frameDone({20, 0});
  EXPECT_EQ(controller.next(40).until_ms, 110);  // epsilon counts from the last event
}

TEST(FrameController, RestoresAfterEpsilonAndIsIdleThen) {
  FrameController controller(with(Pattern::quarter));
  eventAndFrame(controller, 0);
  EXPECT_EQ(controller.next(99.9).kind, Kind::wait);
  EXPECT_EQ(controller.next(100).kind, Kind::restore);
  EXPECT_EQ(controller.state(), State::restore);
  EXPECT_EQ(controller.next(120).kind, Kind::wait);
  EXPECT_TRUE(controller.restoreDone(true));
  EXPECT_EQ(controller.state(), State::idle);
  EXPECT_TRUE(std::isinf(controller.next(200).until_ms));
}

TEST(FrameController, AFullFrameNeedsNoRestoration) {
  FrameController controller(with(Pattern::full));
  eventAndFrame(controller, 0);
  EXPECT_EQ(controller.next(50).until_ms, 100);
  EXPECT_EQ(controller.state(), State::busy);
  const ControllerAction action = controller.next(100);
  EXPECT_EQ(action.kind, Kind::wait);
  EXPECT_TRUE(std::isinf(action.until_ms));
  EXPECT_EQ(controller.state(), State::idle);
}

TEST(FrameController, AFullFrameWhoseEdgesAreToBeSmoothedIsRestored) {
  ControllerOptions options = with(Pattern::full);
  options.smooths_edges = true;
  FrameController controller(options);
  eventAndFrame(controller, 0);
  EXPECT_EQ(controller.next(50).kind, Kind::wait);
  EXPECT_EQ(controller.next(100).kind, Kind::restore);
  EXPECT_TRUE(controller.restoreDone(true));
  EXPECT_EQ(controller.state(), State::idle);
}

TEST(FrameController, EventsFasterThanEpsilonKeepItBusy) {
  FrameController controller(with(Pattern::columns));
  for (int n = 0; n < 50; ++n) {
    eventAndFrame(controller, 90.0 * n);
    EXPECT_EQ(controller.next(90.0 * n + 89).kind, Kind::wait);
    EXPECT_EQ(controller.state(), State::busy);
  }
}

TEST(FrameController, EventsSlowerThanEpsilonSettleEachTime) {
  FrameController controller(with(Pattern::columns));
  for (int n = 0; n < 50; ++n) {
    const double begin_ms = 500.0 * n;
    eventAndFrame(controller, begin_ms);
    ASSERT_EQ(controller.next(begin_ms + 100).kind, Kind::restore);
    EXPECT_TRUE(controller.restoreDone(true));
    EXPECT_EQ(controller.state(), State::idle);
  }
}

TEST(FrameController, EventAtEpsilonReportedFirstPrecedesRestoration) {
  FrameController controller(with(Pattern::columns));
  for (int n = 0; n < 10; ++n) eventAndFrame(controller, 100.0 * n);
  EXPECT_EQ(controller.state(), State::busy);
}

TEST(FrameController, EventAtEpsilonReportedLaterStopsRestoration) {
  FrameController controller(with(Pattern::columns));
  eventAndFrame(controller, 0);
  ASSERT_EQ(controller.next(100).kind, Kind::restore);
  controller.event(SceneEvent::field, 100);
  EXPECT_EQ(controller.next(100).kind, Kind::stop_restore);
  EXPECT_FALSE(controller.restoreDone(false));
  EXPECT_EQ(controller.next(101).kind, Kind::draw);
}

TEST(FrameController, AnEventDuringARestorationStopsItAtOnceAndBeginsFromTheStart) {
  FrameController controller(with(Pattern::quarter));
  eventAndFrame(controller, 0);
  ASSERT_EQ(controller.next(100).kind, Kind::restore);
  controller.event(SceneEvent::field, 130);
  EXPECT_EQ(controller.state(), State::busy);
  EXPECT_EQ(controller.next(130).kind, Kind::stop_restore);
  EXPECT_EQ(controller.next(131).kind, Kind::stop_restore);  // nothing else until it has stopped
  EXPECT_FALSE(controller.restoreDone(false));
  const ControllerAction action = controller.next(132);
  EXPECT_EQ(action.kind, Kind::draw);
  EXPECT_EQ(action.plan.pattern, Pattern::quarter);
  controller.frameDone({20, 0});
  EXPECT_EQ(controller.next(150).until_ms, 230);
}

TEST(FrameController, ARestorationThatEndsAfterAnEventIsNotShown) {
  FrameController controller(with(Pattern::quarter));
  eventAndFrame(controller, 0);
  ASSERT_EQ(controller.next(100).kind, Kind::restore);
  controller.event(SceneEvent::view, 130);
  EXPECT_FALSE(controller.restoreDone(true));  // complete, but of a scene that is gone
  EXPECT_EQ(controller.state(), State::busy);
  EXPECT_EQ(controller.next(130).kind, Kind::draw);
}

TEST(FrameController, AResizeDuringARestorationStopsItAndWarmsUpAgain) {
  ControllerOptions options;
  options.pattern = Pattern::columns;
  FrameController controller(options);
  for (int n = 0; n < 5; ++n) eventAndFrame(controller, n, 80);
  EXPECT_EQ(controller.epsilon_ms(), 80);
  ASSERT_EQ(controller.next(200).kind, Kind::restore);
  controller.event(SceneEvent::resized, 210);
  EXPECT_EQ(controller.next(210).kind, Kind::stop_restore);
  EXPECT_FALSE(controller.restoreDone(false));
  ASSERT_EQ(controller.next(211).kind, Kind::draw);
  EXPECT_EQ(controller.epsilon_ms(), 50);  // nothing is known of the new size
  controller.frameDone({900, 0});          // warms up
  EXPECT_EQ(controller.epsilon_ms(), 50);
  eventAndFrame(controller, 1200, 300);
  EXPECT_EQ(controller.epsilon_ms(), 300);
}

TEST(FrameController, RestorationThatStoppedByItselfRestarts) {
  FrameController controller(with(Pattern::quarter));
  eventAndFrame(controller, 0);
  ASSERT_EQ(controller.next(100).kind, Kind::restore);
  EXPECT_FALSE(controller.restoreDone(false));
  EXPECT_EQ(controller.next(110).kind, Kind::restore);
}

TEST(FrameController, AFrameLongerThanEpsilonIsRestoredRightAway) {
  FrameController controller(with(Pattern::quarter, 100));
  controller.event(SceneEvent::field, 0);
  ASSERT_EQ(controller.next(0).kind, Kind::draw);
  EXPECT_EQ(controller.next(150).kind, Kind::wait);
  controller.frameDone({180, 0});
  EXPECT_EQ(controller.next(180).kind, Kind::restore);
}

TEST(FrameController, EpsilonFollowsTheRuleOfThePaper) {
  ControllerOptions options;
  options.epsilon_floor_ms = 5;
  for (const auto& [pattern, epsilon_ms] : {std::pair{Pattern::full, 30.0},
                                            {Pattern::columns, 30.0},
                                            {Pattern::checkerboard, 30.0},
                                            {Pattern::quarter, 45.0},
                                            {Pattern::adaptive, 45.0}}) {
    options.pattern = pattern;
    FrameController controller(options);
    eventAndFrame(controller, 0, 700);  // warms up
    EXPECT_EQ(controller.epsilon_ms(), 5);
    for (const double draw_ms : {30, 31, 29, 30, 500, 30, 1}) eventAndFrame(controller, 0, draw_ms);
    EXPECT_DOUBLE_EQ(controller.epsilon_ms(), epsilon_ms) << toString(pattern);
  }
}

TEST(FrameController, EpsilonHasAFloor) {
  ControllerOptions options;
  options.pattern = Pattern::columns;
  FrameController controller(options);
  for (int n = 0; n < 5; ++n) eventAndFrame(controller, 0, 10);
  EXPECT_EQ(controller.epsilon_ms(), 50);
}

TEST(FrameController, GivenEpsilonIsKept) {
  FrameController controller(with(Pattern::quarter, 7));
  for (int n = 0; n < 5; ++n) eventAndFrame(controller, 0, 200);
  EXPECT_EQ(controller.epsilon_ms(), 7);
}

TEST(FrameController, ChoosesThePatternByTheBudget) {
  FrameController controller;  // auto
  EXPECT_EQ(controller.plan().pattern, Pattern::full);
  eventAndFrame(controller, 0, 100);
  eventAndFrame(controller, 100, 100);
  EXPECT_EQ(controller.plan().pattern, Pattern::quarter);
  EXPECT_THAT(controller.reason(), HasSubstr("full took 100.0 ms of 40 ms"));
  EXPECT_EQ(controller.epsilon_ms(), 50);  // nothing is measured with this pattern
}

TEST(FrameController, TheToleranceOfAdaptiveFollowsTheBudget) {
  FrameController controller(with(Pattern::adaptive));
  const double before = controller.plan().tolerance_levels;
  for (int n = 0; n < 5; ++n) eventAndFrame(controller, n, 100);
  EXPECT_GT(controller.plan().tolerance_levels, before);
}

TEST(FrameController, RestoresOnlyIfTheDrawnFrameWasInterpolated) {
  FrameController controller;
  eventAndFrame(controller, 0, 100);
  eventAndFrame(controller, 100, 100);  // in full; the next one would be a quarter
  ASSERT_NE(controller.plan().pattern, Pattern::full);
  EXPECT_EQ(controller.next(1000).kind, Kind::wait);
  EXPECT_EQ(controller.state(), State::idle);
}

TEST(FrameController, OtherOptionsAreAnEvent) {
  FrameController controller(with(Pattern::columns));
  eventAndFrame(controller, 0);
  ASSERT_EQ(controller.next(100).kind, Kind::restore);
  controller.setOptions(with(Pattern::checkerboard), 110);
  EXPECT_EQ(controller.next(110).kind, Kind::stop_restore);
  controller.restoreDone(false);
  EXPECT_EQ(controller.next(111).plan.pattern, Pattern::checkerboard);
  EXPECT_EQ(controller.reason(), "checkerboard was requested");
}

TEST(FrameController, RefusesEndWithoutBegin) {
  FrameController controller;
  EXPECT_THROW(controller.frameDone({}), Error);
  EXPECT_THROW(controller.restoreDone(true), Error);
}

// In all cases a picture settles only if nothing has changed since its frame was begun, and only after
// epsilon.
TEST(FrameController, ArbitraryScriptsNeverSettleOnAnotherScene) {
  std::mt19937 random(11);
  const auto chance = [&random](double p) {
    return std::uniform_real_distribution<double>(0, 1)(random) < p;
  };
  for (int script = 0; script < 200; ++script) {
    FrameController controller(with(script % 3 == 0 ? Pattern::full : Pattern::quarter, 20));
    int scene = 0;
    int drawn_scene = -1;
    double last_event_ms = 0;
    bool drawing = false;
    bool restoring = false;
    for (double now_ms = 0; now_ms < 1000; now_ms += 1) {
      if (chance(0.03)) {
        ++scene;
        last_event_ms = now_ms;
        controller.event(static_cast<SceneEvent>(scene % 5), now_ms);
      }
      if (drawing && chance(0.2)) {
        drawing = false;
        controller.frameDone({10, 1});
      }
      const bool stopped = restoring && controller.state() != State::restore;
      if (restoring && (stopped || chance(0.1))) {
        restoring = false;
        const bool shown = controller.restoreDone(!stopped || chance(0.3));
        EXPECT_EQ(shown, drawn_scene == scene);
      }
      const ControllerAction action = controller.next(now_ms);
      if (action.kind == Kind::draw) {
        EXPECT_FALSE(drawing || restoring);
        drawing = true;
        drawn_scene = scene;
      } else if (action.kind == Kind::restore) {
        EXPECT_FALSE(drawing || restoring);
        EXPECT_EQ(drawn_scene, scene);
        EXPECT_GE(now_ms, last_event_ms + 20);
        restoring = true;
      } else if (action.kind == Kind::stop_restore) {
        EXPECT_TRUE(restoring);
      }
      if (controller.state() == State::idle && scene > 0) {
        EXPECT_EQ(drawn_scene, scene);
      }
    }
  }
}

}  // namespace
}  // namespace emscape::render
