// The loop from the field to the settled picture, against a clock that passes only where the loop waits.
#include "playback/pictures/real_time_loop.h"

#include <algorithm>
#include <numeric>

#include "emscape/base/work.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using render::ControllerState;
using render::Pattern;

/// The report and the displayed pictures of a played loop.
struct Played {
  RealTimeReport report;
  std::vector<int> slots;  // of each picture that was displayed

  std::vector<ControllerState> states() const {
    std::vector<ControllerState> states;
    for (const RealTimeEvent& event : report.events) states.push_back(event.state);
    return states;
  }
  int count(ControllerState state) const {
    return static_cast<int>(std::count_if(report.events.begin(), report.events.end(),
                                          [&](const RealTimeEvent& event) { return event.state == state; }));
  }
};

RealTimeOptions optionsOf(std::optional<Pattern> pattern) {
  RealTimeOptions options;
  options.frames_per_s = 10;
  options.controller.pattern = pattern;
  options.controller.epsilon_ms = 200;
  options.verify = true;
  return options;
}

Played play(const RealTimeOptions& options, FrameSource& source, Clock& clock, bool displayed = false,
            const StopFlag* interrupt = nullptr) {
  ViewState view;
  view.size = {97, 75};
  view.range = ValueRange{0, static_cast<float>(source.count())};
  Painter painter(view, source, {});
  Played played;
  Display display;
  if (displayed) display = [&](const render::Image8&, int slots) { played.slots.push_back(slots); };
  RealTimeLoop loop(options, view, source, painter, display, clock, interrupt);
  played.report = loop.play([](const RealTimeEvent&) {});
  const std::vector<render::Rgba>& pixels = painter.image().pixels;
  EXPECT_TRUE(
      std::any_of(pixels.begin(), pixels.end(), [](const render::Rgba& pixel) { return pixel.a > 0; }));
  return played;
}

Played play(const RealTimeOptions& options, FrameSource& source) {
  ManualClock clock;
  return play(options, source, clock);
}

TEST(RealTimeLoop, GoesFromBusyToRestoreToIdleAtEveryStepAndSettlesExactly) {
  for (const Pattern pattern :
       {Pattern::columns, Pattern::checkerboard, Pattern::quarter, Pattern::adaptive}) {
    MadeFrames source(seconds(3));
    const Played played = play(optionsOf(pattern), source);
    const std::vector<ControllerState> round{ControllerState::busy, ControllerState::restore,
                                             ControllerState::idle};
    std::vector<ControllerState> expected;
    for (int step = 0; step < 3; ++step) expected.insert(expected.end(), round.begin(), round.end());
    EXPECT_EQ(played.states(), expected) << render::toString(pattern);
    EXPECT_EQ(played.report.totals.unequal(), 0);
    for (const RealTimeEvent& event : played.report.events) {
      EXPECT_EQ(event.pattern, pattern);
      EXPECT_EQ(event.equals_full.has_value(), event.state == ControllerState::idle);
      EXPECT_FALSE(event.late);
    }
  }
}

TEST(RealTimeLoop, ABusyFrameAndItsRestorationCastEveryPixelOnce) {
  MadeFrames source(seconds(2));
  const Played played = play(optionsOf(Pattern::quarter), source);
  ASSERT_EQ(played.count(ControllerState::restore), 2);
  long long busy_rays = 0;
  for (const RealTimeEvent& event : played.report.events) {
    if (event.state == ControllerState::busy) busy_rays = event.rays;
    if (event.state == ControllerState::restore) {
      EXPECT_EQ(busy_rays, 49 * 38);
      EXPECT_EQ(busy_rays + event.rays, 97 * 75);
    }
  }
}

TEST(RealTimeLoop, AFullFrameSettlesWithoutARestoration) {
  MadeFrames source(seconds(2));
  const Played played = play(optionsOf(Pattern::full), source);
  EXPECT_EQ(played.count(ControllerState::restore), 0);
  EXPECT_EQ(played.count(ControllerState::idle), 2);
}

std::vector<int> columnStepsOf(const Played& played) {
  std::vector<int> steps;
  for (const RealTimeEvent& event : played.report.events) {
    if (event.state == ControllerState::busy) steps.push_back(event.column_step);
  }
  return steps;
}

TEST(RealTimeLoop, FieldsThatTakeTooLongAreInterpolatedAndTheLastIsCompleted) {
  MadeFrames source(seconds(3));
  source.is_slow = true;
  const Played played = play(optionsOf(Pattern::columns), source);
  EXPECT_EQ(source.asked(), (std::vector<int>{0, 1, 2, 2}));
  EXPECT_EQ(columnStepsOf(played), (std::vector<int>{1, 2, 2, 1}));
  EXPECT_EQ(played.report.field_updates, 4);
  EXPECT_EQ(played.report.field_updates_interpolated, 2);
  EXPECT_EQ(played.report.due, played.report.totals.busy);
}

TEST(RealTimeLoop, AFieldThatRestsIsCompleted) {
  MadeFrames source(seconds(4));
  source.is_slow = true;
  source.changes = false;  // but the first step, and its columns
  const Played played = play(optionsOf(Pattern::columns), source);
  EXPECT_EQ(source.asked(), (std::vector<int>{0, 1, 1, 2, 3}));
  EXPECT_EQ(played.report.field_updates_interpolated, 0) << "an unchanged field is not shown again";
}

TEST(RealTimeLoop, WholeFieldsHaveNoTimeGoal) {
  MadeFrames source(seconds(3));
  source.is_slow = true;
  RealTimeOptions options = optionsOf(Pattern::full);
  options.whole_fields = true;
  EXPECT_EQ(columnStepsOf(play(options, source)), (std::vector<int>{1, 1, 1}));
}

TEST(RealTimeLoop, AMovingCameraKeepsItBusyAndIsDueInEverySlot) {
  MadeFrames source(seconds(1));
  RealTimeOptions options = optionsOf(Pattern::columns);
  options.orbit_rate_deg_s = 30;
  options.duration_s = 2;
  const Played played = play(options, source);
  EXPECT_EQ(played.report.due, 20);
  EXPECT_EQ(played.count(ControllerState::busy), 20);
  EXPECT_EQ(played.report.events.size(), 20U);
}

TEST(RealTimeLoop, EveryStepIsShownWhenItsTimeHasCome) {
  MadeFrames source({0, 0.5, 2});
  RealTimeOptions options = optionsOf(Pattern::full);
  options.speed = 2;
  const Played played = play(options, source);
  std::vector<std::pair<double, double>> shown;  // ms, scenario's seconds
  for (const RealTimeEvent& event : played.report.events) {
    if (event.state == ControllerState::busy) shown.emplace_back(event.time_ms, event.scenario_s);
  }
  // The first slot of 100 ms in which each is due at twice the speed: 250 ms is due in the slot that begins
  // at 300.
  EXPECT_EQ(shown, (std::vector<std::pair<double, double>>{{0, 0}, {300, 0.5}, {1000, 2}}));
  EXPECT_EQ(played.report.due, 3);
  EXPECT_EQ(played.report.field_updates, 3);
  EXPECT_EQ(played.report.field_steps_skipped, 0);
  EXPECT_EQ(played.report.seconds, 1.5);  // one step of mean length after the last
}

TEST(RealTimeLoop, StepsThatComeFasterThanSlotsAreSkippedAndCounted) {
  MadeFrames source([] {
    std::vector<double> times_s;
    for (int i = 0; i <= 40; ++i) times_s.push_back(0.025 * i);
    return times_s;
  }());
  RealTimeOptions options = optionsOf(Pattern::columns);
  const Played played = play(options, source);
  EXPECT_GT(played.report.field_steps_skipped, 20);
  EXPECT_LE(played.report.field_updates + played.report.field_steps_skipped, 41);
  double scenario_s = -1;
  for (const RealTimeEvent& event : played.report.events) {
    if (event.state != ControllerState::busy) continue;
    EXPECT_GT(event.scenario_s, scenario_s);
    EXPECT_LE(event.scenario_s, event.time_ms / 1000 + 1e-9);
    scenario_s = event.scenario_s;
  }
}

TEST(RealTimeLoop, ConstantFieldIsDrawnOnce) {
  MadeFrames source(seconds(4));
  source.changes = false;
  const Played played = play(optionsOf(Pattern::quarter), source);
  EXPECT_EQ(played.count(ControllerState::busy), 1);
  EXPECT_EQ(played.count(ControllerState::idle), 1);
  EXPECT_EQ(played.report.due, 1);
}

TEST(RealTimeLoop, EventDuringRestorationStartsNextFrameAtOnce) {
  MadeFrames source(seconds(1));
  RealTimeOptions options = optionsOf(Pattern::quarter);
  options.controller.epsilon_ms = 0;  // a restoration begins as soon as a frame is drawn
  options.orbit_rate_deg_s = 30;
  options.duration_s = 1;
  // On a busy machine every restoration may be done before the event of the next slot reaches it.
  int aborted = 0, begun_after_abort = 0;
  for (int trial = 0; trial < 20 && begun_after_abort == 0; ++trial) {
    ManualClock clock(/*work_takes_no_time=*/false);
    const Played played = play(options, source, clock);
    EXPECT_EQ(played.count(ControllerState::busy), 10);
    aborted = 0;
    for (const RealTimeEvent& event : played.report.events) {
      if (event.state == ControllerState::restore && !event.restored) ++aborted;
      if (!event.abort_latency_ms) continue;
      ++begun_after_abort;
      EXPECT_EQ(event.state, ControllerState::busy);
      EXPECT_EQ(*event.abort_latency_ms, 0);
    }
  }
  EXPECT_GT(begun_after_abort, 0);
  EXPECT_LE(begun_after_abort, aborted);
  EXPECT_GE(begun_after_abort, aborted - 1);  // the last one may have been stopped by the end
}

TEST(RealTimeLoop, ThePicturesOnDisplayFillTheTimeOfThePlaying) {
  MadeFrames source(seconds(3));
  ManualClock clock;
  const Played played = play(optionsOf(Pattern::quarter), source, clock, /*displayed=*/true);
  EXPECT_EQ(played.slots.size(), 6U);  // a busy and a restored one at each step
  EXPECT_EQ(std::accumulate(played.slots.begin(), played.slots.end(), 0), 30);
}

TEST(RealTimeLoop, ReportsReasonForEachChangeOfPattern) {
  MadeFrames source(seconds(2));
  const Played played = play(optionsOf(Pattern::columns), source);
  EXPECT_EQ(played.report.events.front().reason, "columns was requested");
  for (std::size_t i = 1; i < played.report.events.size(); ++i) EXPECT_EQ(played.report.events[i].reason, "");
}

TEST(RealTimeLoop, AnInterruptEndsIt) {
  StopFlag interrupt{false};
  MadeFrames source(seconds(100), [&](int index) { interrupt = index == 3; });
  ManualClock clock;
  EXPECT_THROW(play(optionsOf(Pattern::full), source, clock, false, &interrupt), Stopped);
}

TEST(RealTimeLoop, ExceptionOfTheSourceEndsIt) {
  MadeFrames source(seconds(10), [](int index) {
    if (index == 2) throw Error(ErrorCode::bad_input, "step 2 is damaged");
  });
  EXPECT_EQ(errorOf([&] { play(optionsOf(Pattern::full), source); }), "step 2 is damaged");
}

TEST(RealTimeLoop, OnlyAnOrbitGoesRound) {
  MadeFrames source(seconds(1));
  ViewState view;
  view.size = {8, 6};
  view.camera.kind = render::CameraSpec::Kind::lookat;
  RealTimeOptions options;
  options.orbit_rate_deg_s = 5;
  ViewState orbit = view;
  orbit.camera.kind = render::CameraSpec::Kind::orbit;
  Painter painter(orbit, source, {});
  ManualClock clock;
  EXPECT_THAT(errorOf([&] { RealTimeLoop(options, view, source, painter, {}, clock); }),
              testing::HasSubstr("orbit"));
}

}  // namespace
}  // namespace emscape::playback::test
