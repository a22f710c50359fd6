#include "study/sweep/choose_sites.h"

#include <gtest/gtest.h>

#include <random>

namespace emscape::study {
namespace {

TEST(ChooseSites, ThreeOfEightCoverNearlyAsMuchAsTheBestThree) {
  constexpr int kWidth = 60, kSites = 8;
  const std::vector<float> weights(kWidth * kWidth, 2.5f);
  std::mt19937 random(11);
  int best_found = 0;
  for (int area = 0; area < 20; ++area) {
    // Discs that overlap, with holes.
    std::vector<std::vector<std::uint8_t>> pixels;
    for (int s = 0; s < kSites; ++s) {
      const int x = static_cast<int>(random() % kWidth), y = static_cast<int>(random() % kWidth);
      const int radius = 8 + static_cast<int>(random() % 14);
      pixels.emplace_back(weights.size());
      for (int p = 0; p < kWidth * kWidth; ++p) {
        const int dx = p % kWidth - x, dy = p / kWidth - y;
        pixels.back()[static_cast<std::size_t>(p)] =
            dx * dx + dy * dy < radius * radius && random() % 4 != 0 ? 1 : 0;
      }
    }
    double best = 0;
    for (std::size_t a = 0; a < kSites; ++a) {
      for (std::size_t b = a + 1; b < kSites; ++b) {
        for (std::size_t c = b + 1; c < kSites; ++c) {
          best = std::max(best, coveredWeight(pixels, weights, {a, b, c}));
        }
      }
    }
    const double found = coveredWeight(pixels, weights, chooseSites(pixels, weights, 3));
    EXPECT_GE(found, 0.98 * best) << area;
    best_found += found == best ? 1 : 0;
  }
  EXPECT_GE(best_found, 15);
}

TEST(ChooseSites, AllSitesIfAllAreAskedFor) {
  const std::vector<std::vector<std::uint8_t>> pixels{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(chooseSites(pixels, {1, 1, 1}, 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(chooseSites(pixels, {1, 2, 1}, 1), (std::vector<std::size_t>{1}));
}

TEST(ChooseSites, CountsSitesThatWouldDoAsWell) {
  const std::vector<std::vector<std::uint8_t>> pixels{{1, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {1, 1, 0, 0}};
  const std::vector<float> weights{1, 1, 1, 1};
  EXPECT_EQ(chooseSites(pixels, weights, 1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(equalSites(pixels, weights, {0}), 1u) << "site 3";
  EXPECT_EQ(equalSites(pixels, weights, {0, 1}), 2u) << "site 3 for 0, or 2 for 1";
  EXPECT_EQ(equalSites(pixels, {1, 1, 2, 1}, {0, 1}), 1u);
}

}  // namespace
}  // namespace emscape::study
