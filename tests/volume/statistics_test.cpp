#include "emscape/volume/statistics.h"

#include "emscape/base/parallel.h"
#include "tests/volume/sample_volumes.h"

namespace emscape::volume {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace test;

/// Two columns of four voxels; one voxel is masked, one NaN, one at the floor.
DenseVolume small() {
  DenseVolume volume = plainVolume({2, 1, 4});
  volume.info.floor = -9;
  volume.values = {-9, 1, 2, 3, std::nanf(""), 4, -9, 5};
  volume.first_valid_k = {1, 0};
  return volume;
}

TEST(Statistics, LeaveOutMaskedAndNan) {
  const Statistics statistics = statisticsOf(small());
  EXPECT_EQ(statistics.voxels, 8);
  EXPECT_EQ(statistics.valid, 6);
  EXPECT_EQ(statistics.masked, 1);
  EXPECT_EQ(statistics.nan, 1);
  EXPECT_EQ(statistics.at_floor, 1);
  EXPECT_EQ(statistics.min, -9);
  EXPECT_EQ(statistics.max, 5);
  EXPECT_DOUBLE_EQ(statistics.mean, 1);
}

TEST(Statistics, EmptyVolumeHasZeros) {
  DenseVolume volume = small();
  volume.first_valid_k = {4, 4};
  const Statistics statistics = statisticsOf(volume);
  EXPECT_EQ(statistics.valid, 0);
  EXPECT_EQ(statistics.min, 0);
  EXPECT_EQ(statistics.mean, 0);
}

TEST(Statistics, DoNotDependOnThreads) {
  DenseVolume volume = fieldVolume({64, 50, 40});
  const double mean = statisticsOf(volume).mean;
  for (const int threads : {1, 2, 3}) {
    setThreadLimit(threads);
    EXPECT_EQ(statisticsOf(volume).mean, mean);
  }
  setThreadLimit(0);
}

TEST(Histogram, CountsBothEdges) {
  const Histogram histogram = histogramOf(small(), 2, 1, 4);
  EXPECT_THAT(histogram.counts, ElementsAre(2, 2));  // 1 2 | 3 4
  EXPECT_EQ(histogram.below, 1);
  EXPECT_EQ(histogram.above, 1);
  EXPECT_THAT(errorOf([] { histogramOf(small(), 0, 0, 1); }), HasSubstr("0 bins: must be 1..65536"));
  EXPECT_THAT(errorOf([] { histogramOf(small(), 4, 1, 1); }), HasSubstr("the first the lesser"));
}

TEST(Range, LeavesOutTheFloor) {
  DenseVolume volume = small();
  setRangeFromValues(volume);
  EXPECT_EQ(volume.info.range_min, 1);
  EXPECT_EQ(volume.info.range_max, 5);
  std::fill(volume.values.begin(), volume.values.end(), -9.F);
  setRangeFromValues(volume);
  EXPECT_EQ(volume.info.range_min, -9);
  EXPECT_EQ(volume.info.range_max, -9);
}

}  // namespace
}  // namespace emscape::volume
