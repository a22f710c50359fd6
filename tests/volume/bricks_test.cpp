#include "volume/bricks.h"

#include <limits>
#include <random>

#include "tests/volume/sample_volumes.h"

namespace emscape::volume {
namespace {

using namespace test;

/// Trilinear between voxel centres, held at the outer ones. @param p  index space
float sample(const DenseVolume& volume, const Vec3d& p) {
  const Dims& dims = volume.grid.dims;
  const auto cell = [](double position, int count, int& low, int& high) {
    const double held = std::min(std::max(position, 0.0), count - 1.0);
    low = static_cast<int>(held);
    high = std::min(low + 1, count - 1);
    return held - low;
  };
  int x[2], y[2], z[2];
  const double fx = cell(p.x, dims.x, x[0], x[1]), fy = cell(p.y, dims.y, y[0], y[1]),
               fz = cell(p.z, dims.z, z[0], z[1]);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    sum += (a ? fx : 1 - fx) * (b ? fy : 1 - fy) * (c ? fz : 1 - fz) *
           volume.values[static_cast<std::size_t>(volume.grid.index(x[a], y[b], z[c]))];
  }
  return static_cast<float>(sum);
}

TEST(Bricks, HoldEverySampleTakenInTheirBox) {
  DenseVolume volume = plainVolume({19, 8, 33});
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(-10, 10);
  for (float& voxel : volume.values) voxel = value(random);
  for (const int edge : {1, 3, 8, 64}) {
    const Bricks bricks(volume, edge);
    const BricksView view = bricks.view();
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 20000; ++i) {
      // Corner-based: voxel (i, j, k) fills [i, i + 1), its centre at i + 0.5.
      const Vec3d corner{unit(random) * 19, unit(random) * 8, unit(random) * 33};
      const float got = sample(volume, corner - Vec3d{0.5, 0.5, 0.5});
      const ValueRange range = view.at(static_cast<int>(corner.x) / edge, static_cast<int>(corner.y) / edge,
                                       static_cast<int>(corner.z) / edge);
      ASSERT_GE(got, range.min - 1e-5F);
      ASSERT_LE(got, range.max + 1e-5F);
    }
  }
}

TEST(Bricks, AreEmptyWhereAllIsMaskedOrNan) {
  DenseVolume volume = plainVolume({24, 24, 24});
  volume.first_valid_k.assign(24 * 24, 12);
  volume.first_valid_k[0] = 3;
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 14; i < 24; ++i)
        volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))] = std::nanf("");
    }
  }
  const Bricks bricks(volume);
  EXPECT_FALSE(bricks.view().at(0, 0, 0).empty());  // one column shows from layer 3 on
  EXPECT_TRUE(bricks.view().at(1, 0, 0).empty());
  EXPECT_FALSE(bricks.view().at(1, 0, 1).empty());
  EXPECT_TRUE(bricks.view().at(2, 1, 2).empty());  // NaN
}

TEST(Bricks, FollowAnUpdateOfTheirVolume) {
  DenseVolume volume = plainVolume({16, 16, 16});
  Bricks bricks(volume);
  std::fill(volume.values.begin(), volume.values.end(), 2.F);
  bricks.update(volume);
  EXPECT_EQ(bricks.view().at(1, 1, 1).min, 2.F);
  EXPECT_EQ(bricks.view().at(1, 1, 1).max, 2.F);
  EXPECT_THROW(Bricks(volume, 0), Error);
}

TEST(ValueRange, IsEmptyUntilItTakesOneIn) {
  ValueRange range;
  EXPECT_TRUE(range.empty());
  range.add({});
  EXPECT_TRUE(range.empty());
  range.add({3, 4});
  range.add({1, 3.5F});
  EXPECT_EQ(range.min, 1);
  EXPECT_EQ(range.max, 4);
}

TEST(ValueRange, TakesNoNaNs) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ValueRange range{1, 2};
  range.add({nan, nan});
  range.add({0, nan});
  EXPECT_EQ(range.min, 1);
  EXPECT_EQ(range.max, 2);
}

}  // namespace
}  // namespace emscape::volume
