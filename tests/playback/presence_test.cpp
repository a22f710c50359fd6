#include "playback/frames/presence.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/volume/statistics.h"
#include "playback/frames/range_search.h"
#include "playback/live/live_view.h"
#include "playback/pictures/silence.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

/// The quick scenario with both platforms on tracks of some seconds.
FieldChoice recorded(const TemporaryFolder& folder, const std::string& of_radar = "2, 4",
                     const std::string& of_mast = "3, 4") {
  const auto track = [](const char* longitude, const std::string& times_s) {
    const std::size_t comma = times_s.find(',');
    const auto point = [&](const std::string& time_s) {
      return "{t_s: " + time_s + ", latitude_deg: 52, longitude_deg: " + longitude + ", height_agl_m: 30}";
    };
    return "track: {points: [" + point(times_s.substr(0, comma)) + "," + point(times_s.substr(comma + 1)) +
           "]}}";
  };
  FieldChoice choice;
  choice.input = quickScenario(
      folder,
      {{"[40, 40, 20]", "[8, 8, 6]"},
       {"position: {latitude_deg: 52, longitude_deg: 5, height_agl_m: 20}}", track("5", of_radar)},
       {"position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}}", track("5.06", of_mast)}});
  return choice;
}

FrameSelection firstOf(const FieldChoice& choice) {
  FrameSelection selection(choice);
  selection.first_only = true;
  return selection;
}

TEST(Presence, TheFirstInstantIsThatOfTheFirstEmitter) {
  const TemporaryFolder folder;
  const FieldChoice choice = recorded(folder);
  const auto one = openFrameSource(firstOf(choice), {});
  ASSERT_EQ(one->count(), 1);
  EXPECT_EQ(one->time_s(0), 2);
  EXPECT_FALSE(volume::holdsNothing(one->frame(0).info()));
  EXPECT_EQ(openFrameSource(FrameSelection(choice), {})->firstTime_s(), 2) << "of all steps";
  FieldChoice other = choice;
  other.edits = {{"emitters.radar.platform", "mast"}};
  EXPECT_EQ(openFrameSource(firstOf(other), {})->time_s(0), 3) << "the radar site alone is no emitter";
}

TEST(Presence, WithoutEmittersAnyPlatformCountsAndElseTheFirstStep) {
  const TemporaryFolder folder;
  const auto scenario = openFrameSource(firstOf(recorded(folder)), {})->scene()->scenario;
  scenario::Scenario silent = *scenario;
  silent.emitters.clear();
  EXPECT_EQ(firstPresentTime_s(silent, {0, 1, 2, 3}), 2);
  EXPECT_EQ(firstPresentTime_s(silent, {0, 1}), 0) << "none at any step";
}

TEST(Presence, ThePictureSaysThatNothingIsThere) {
  const TemporaryFolder folder;
  const auto scenario = openFrameSource(firstOf(recorded(folder)), {})->scene()->scenario;
  EXPECT_EQ(silenceText(*scenario, "power_density_dbwm2", 0), "no platform is present");
  EXPECT_EQ(silenceText(*scenario, "power_density_dbwm2", 2), "");
  EXPECT_EQ(silenceText(*scenario, "power_density_dbwm2:transmitter", 2), "'transmitter' is not present");
  scenario::Scenario one = *scenario;
  one.emitters.erase(one.emitters.begin());
  EXPECT_EQ(silenceText(one, "power_density_dbwm2", 2), "no emitter is present");
}

TEST(Presence, ColoursAreNotFittedToAFieldWithoutAValue) {
  const TemporaryFolder folder;
  ViewState view;
  static_cast<FieldChoice&>(view) = recorded(folder);
  view.size = {80, 60};
  FrameSelection selection(view);
  selection.independent = true;
  const auto source = openFrameSource(selection, {});
  Painter late(view, *source, {}), alone(view, *source, {});
  late.setFrame(source->frame(0));
  EXPECT_FALSE(late.hasColors());
  late.setFrame(source->frame(2));
  EXPECT_TRUE(late.hasColors());
  alone.setFrame(source->frame(2));
  EXPECT_EQ(late.transferFunction(), alone.transferFunction());
  late.setFrame(source->frame(1));
  EXPECT_EQ(late.transferFunction(), alone.transferFunction()) << "they are kept";
  view.range = {-90, -20};
  Painter given(view, *source, {});
  given.setFrame(source->frame(0));
  EXPECT_TRUE(given.hasColors());
}

TEST(Presence, TheRangeOfASeriesLeavesFieldsWithoutAValueOut) {
  RangeSearch search(2);
  volume::VolumeInfo info;
  info.floor = info.range_min = info.range_max = -120;
  search.add(info);
  EXPECT_TRUE(search.range().empty());
  info.range_min = -65;
  info.range_max = -5;
  search.add(info);
  EXPECT_EQ(search.range(), (ValueRange{-65, -5}));
}

TEST(Presence, AWindowBeginsAtTheFirstInstantOrAtAnUtcTime) {
  const TemporaryFolder folder;
  ViewState view;
  static_cast<FieldChoice&>(view) = recorded(folder);
  view.size = {40, 30};
  const auto shown = [&] {
    LiveView live(view, {}, {});
    while (!live.status().isSettled() && live.status().error.empty())
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_EQ(live.status().error, "");
    return live.picture() ? live.picture()->info().time_s : -1;
  };
  EXPECT_EQ(shown(), 2);
  view.time_s = 0;
  EXPECT_EQ(shown(), 0) << "as given";
  view.time_s = ViewState().time_s;
  view.time_utc = "2026-06-01T06:00:03Z";
  EXPECT_EQ(shown(), 3);
}

}  // namespace
}  // namespace emscape::playback::test
