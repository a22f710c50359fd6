#include "emscape/playback/frames/field_series.h"

#include "emscape/base/work.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

FieldSeries quickSeries(const TemporaryFolder& folder, int steps, const StopFlag* stop = nullptr) {
  return FieldSeries(loadScenarioWithTerrain(quickScenario(folder, {{"[40, 40, 20]", "[8, 8, 6]"}})),
                     seconds(steps), {}, stop);
}

TEST(FieldSeries, TheStepThatWasComputedLastIsNotComputedAgain) {
  const TemporaryFolder folder;
  FieldSeries series = quickSeries(folder, 3);
  series.rehearse();
  series.compute(0);
  EXPECT_TRUE(series.changed());
  series.compute(0);
  EXPECT_FALSE(series.changed());
  series.compute(2);
  EXPECT_TRUE(series.changed());
}

TEST(FieldSeries, VolumesHaveTimeOfTheirStepAndTheirOwnRange) {
  const TemporaryFolder folder;
  FieldSeries series = quickSeries(folder, 3);
  const std::vector<volume::Volume> volumes = series.compute(2);
  ASSERT_EQ(volumes.size(), 1U);
  EXPECT_EQ(volumes[0].info().time_s, 2);
  EXPECT_EQ(volumes[0].info().time_utc, "2026-06-01T06:00:02.000Z");
  const ValueRange own = rangesOf(volumes)[0];
  const std::shared_ptr<const volume::DenseVolume> dense = volumes[0].host();
  EXPECT_EQ(own.max, *std::max_element(dense->values.begin(), dense->values.end()));
}

TEST(FieldSeries, AStopFlagEndsItBetweenTwoSteps) {
  const TemporaryFolder folder;
  StopFlag stop{false};
  FieldSeries series = quickSeries(folder, 3, &stop);
  series.compute(0);
  stop = true;
  EXPECT_THROW(series.compute(1), Stopped);
}

}  // namespace
}  // namespace emscape::playback::test
