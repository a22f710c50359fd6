#include "scenario/terrain/sea.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace emscape::scenario {
namespace {

constexpr int kColumns = 20, kRows = 12;

/// Level in the western half, rising to the east.
std::vector<float> coast(float level_m) {
  std::vector<float> heights_m;
  for (int p = 0; p < kColumns * kRows; ++p) {
    const int column = p % kColumns;
    heights_m.push_back(column < kColumns / 2 ? level_m : level_m + 5 + static_cast<float>(column));
  }
  return heights_m;
}

int count(const std::vector<std::uint8_t>& sea) {
  return std::accumulate(sea.begin(), sea.end(), 0);
}

TEST(Sea, IsLevelGroundAtMeanSeaLevel) {
  std::vector<float> heights_m = coast(0);
  heights_m[3 * kColumns + 15] = 0;  // a well, no sea
  const std::vector<std::uint8_t> sea = seaByHeights(kColumns, kRows, heights_m);
  for (std::size_t p = 0; p < sea.size(); ++p) EXPECT_EQ(sea[p], p % kColumns < kColumns / 2 ? 1 : 0) << p;
  EXPECT_EQ(count(seaByHeights(kColumns, kRows, coast(3))), 0) << "a plain above the sea";
  heights_m = coast(0);
  for (std::size_t p = 0; p < heights_m.size(); ++p) heights_m[p] += 0.05F * static_cast<float>(p % 2);
  EXPECT_EQ(count(seaByHeights(kColumns, kRows, heights_m)), 0) << "low land that is not level";
}

TEST(Sea, UnknownGroundIsNoSeaAndNoShore) {
  EXPECT_EQ(seaByHeights(kColumns, kRows, {}), std::vector<std::uint8_t>(kColumns * kRows, 0));
  std::vector<float> heights_m = coast(0);
  for (int p = 0; p < kColumns; ++p) heights_m[static_cast<std::size_t>(p)] = NAN;
  EXPECT_EQ(count(seaByHeights(kColumns, kRows, heights_m)), kColumns / 2 * (kRows - 1));
}

TEST(Sea, LevelGroundThatIsLandByTheCoastsIsLand) {
  std::vector<std::uint8_t> by_coast(kColumns * kRows, 0);
  EXPECT_EQ(count(seaByHeights(kColumns, kRows, coast(0), by_coast)), 0);
  by_coast[5 * kColumns + 3] = 1;
  EXPECT_EQ(count(seaByHeights(kColumns, kRows, coast(0), by_coast)), kColumns / 2 * kRows);
}

}  // namespace
}  // namespace emscape::scenario
