#include "study/sweep/definition/sample_points.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace emscape::study {
namespace {

TEST(SamplePoints, ALatinHypercubeHasOnePointInEachInterval) {
  constexpr int kCount = 97, kDimensions = 5;
  const SamplePoints points = latinHypercube(kCount, kDimensions, 12345678901234);
  for (int d = 0; d < kDimensions; ++d) {
    std::vector<int> used(kCount, 0);
    bool is_sorted = true;
    for (int i = 0; i < kCount; ++i) {
      ++used[static_cast<std::size_t>(points.at(i, d) * kCount)];
      is_sorted = is_sorted && (i == 0 || points.at(i, d) > points.at(i - 1, d));
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), kCount);
    EXPECT_FALSE(is_sorted);
  }
  EXPECT_EQ(points.coordinates, latinHypercube(kCount, kDimensions, 12345678901234).coordinates);
  EXPECT_NE(points.coordinates, latinHypercube(kCount, kDimensions, 12345678901235).coordinates);
}

TEST(SamplePoints, SobolHasTheDirectionNumbersOfJoeAndKuo) {
  // Point 777 of the unscrambled sequence in units of 1/1024, as of SciPy 1.16 (qmc.Sobol).
  const std::vector<std::uint32_t> expected{709, 959, 167, 281, 651, 365, 195, 781, 357, 331, 763,
                                            713, 393, 485, 583, 527, 413, 885, 379, 771, 243};
  const std::vector<std::uint32_t> words = sobolWords(1024, kMaxSobolDimensions);
  for (int d = 0; d < kMaxSobolDimensions; ++d) {
    EXPECT_EQ(words[777 * kMaxSobolDimensions + static_cast<std::size_t>(d)] >> 22,
              expected[static_cast<std::size_t>(d)])
        << d;
  }
  // The shift keeps the balance: each half of each axis has half of the points.
  const SamplePoints points = sobolPoints(1024, kMaxSobolDimensions, 7);
  for (int d = 0; d < kMaxSobolDimensions; ++d) {
    int low = 0;
    for (int i = 0; i < points.count; ++i) low += points.at(i, d) < 0.5 ? 1 : 0;
    EXPECT_EQ(low, 512);
  }
}

}  // namespace
}  // namespace emscape::study
