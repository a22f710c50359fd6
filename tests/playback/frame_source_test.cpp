#include "emscape/playback/frame_source.h"

#include <algorithm>

#include "emscape/playback/stop.h"
#include "emscape/volume/file.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::HasSubstr;

TEST(FrameSource, TheNearestIndexToATimeIsFoundBeyondTheEndsToo) {
  const MadeFrames source({0, 1, 1.5, 4});
  const std::vector<std::pair<double, int>> expected{{-7, 0},  {0, 0},   {0.4, 0}, {0.6, 1}, {1, 1}, {1.2, 1},
                                                     {1.3, 2}, {2.7, 2}, {2.8, 3}, {4, 3},   {99, 3}};
  for (const auto& [time_s, index] : expected) EXPECT_EQ(source.nearestIndex(time_s), index) << time_s;
  EXPECT_EQ(source.nearestIndex(0.5), 0) << "of two as near the earlier";
  EXPECT_EQ(MadeFrames({3}).nearestIndex(-1), 0);
}

TEST(FrameSource, AFrameByTimeIsThatOfTheNearestStep) {
  MadeFrames source({0, 1, 2});
  EXPECT_EQ(source.frameAt(1.2).volume.info().time_s, 1);
}

TEST(FrameSource, ComputesAScenariosStepsWithOneRange) {
  const TemporaryFolder folder;
  FrameSelection selection;
  selection.input = quickScenario(folder, {{"[40, 40, 20]", "[8, 8, 6]"}});
  selection.times = "0:3:1";
  const auto source = openFrameSource(selection, {});
  EXPECT_EQ(source->count(), 4);
  EXPECT_EQ(source->name(), "quick");
  ASSERT_NE(source->scene(), nullptr);
  const Frame first = source->frame(0), last = source->frame(3);
  EXPECT_EQ(first.markers.size(), 2U);
  EXPECT_EQ(first.volume.info().range_max, last.volume.info().range_max);
  EXPECT_EQ(last.volume.info().time_s, 3);
  EXPECT_FALSE(source->frame(3).changed);
}

TEST(FrameSource, ReadsVolumesNearestToTheTimesThatAreAskedFor) {
  const TemporaryFolder folder;
  MadeFrames made(seconds(5));
  for (int i = 0; i < made.count(); ++i) {
    volume::writeVolumes(folder / ("v_000" + std::to_string(i + 1) + ".vdb"),
                         {made.frame(i).volume.host().get()});
  }
  FrameSelection selection;
  selection.input = folder.path().string();
  selection.times = "1.2:3.4:2";
  selection.range = ValueRange{-5, 5};
  const auto source = openFrameSource(selection, {});
  ASSERT_EQ(source->count(), 2);
  EXPECT_EQ(source->time_s(1), 3);
  EXPECT_EQ(source->frame(1).volume.host()->values.front(), 3.5F);
  EXPECT_EQ(source->frame(1).volume.info().range_min, -5);
}

TEST(FrameSource, WhatIsNoInputIsRefusedByName) {
  FrameSelection selection;
  selection.input = "/nowhere/there.vdb";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }), HasSubstr("/nowhere/there.vdb"));
  const TemporaryFolder folder;
  selection.input = quickScenario(folder);
  selection.quantity = "power_density_dbwm2:nobody";
  EXPECT_THAT(errorOf([&] { openFrameSource(selection, {}); }), HasSubstr("there is no such channel"));
}

TEST(FrameSource, AStopFlagEndsTheSearchForTheRange) {
  const TemporaryFolder folder;
  const StopFlag stop{true};
  FrameSelection selection;
  selection.input = quickScenario(folder);
  EXPECT_THROW(openFrameSource(selection, {}, {}, &stop), Stopped);
}

}  // namespace
}  // namespace emscape::playback::test
