#include "base/math/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape {
namespace {

TEST(Random, PhiloxEqualsPublishedVectors) {
  // The known answers of the authors' Random123 (kat_vectors, philox4x32 10).
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, TheNormalQuantileInvertsTheDistribution) {
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normalQuantile(1e-10), -6.361340902404056, 1e-13);
  for (const double p : {1e-300, 1e-12, 0.001, 0.07, 0.5, 0.61, 0.999}) {
    EXPECT_NEAR(std::erfc(-normalQuantile(p) / std::sqrt(2)) / 2 / p, 1, 1e-11) << p;
  }
}

}  // namespace
}  // namespace emscape
