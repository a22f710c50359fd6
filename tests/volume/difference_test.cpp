#include "volume/difference.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/errors.h"

namespace emscape::volume {
namespace {

DenseVolume volumeOf(const UnsetVector<float>& values, std::vector<std::uint16_t> first_valid_k = {}) {
  DenseVolume volume;
  volume.grid.dims = {2, 1, static_cast<int>(values.size()) / 2};
  volume.grid.spacing_m = {10, 10, 10};
  volume.info.quantity = "power_density_dbwm2";
  volume.info.unit = "dBW/m2";
  volume.info.floor = -120;
  volume.values = values;
  volume.first_valid_k = std::move(first_valid_k);
  return volume;
}

std::string errorOf(const DenseVolume& a, const DenseVolume& b) {
  return test::errorOf([&] { difference(a, b); });
}

TEST(Difference, IsTakenToTheFloorWhereOneHasNoField) {
  const DenseVolume made = difference(volumeOf({-40, -120, -50, -120}), volumeOf({-50, -60, -120, -120}));
  EXPECT_EQ(made.values, (UnsetVector<float>{10, -60, 70, 0}));
  EXPECT_EQ(made.info.floor, 0);
  EXPECT_EQ(made.info.range_min, -60);
  EXPECT_EQ(made.info.range_max, 70);
}

TEST(Difference, EqualVolumesDifferByZero) {
  const DenseVolume volume = volumeOf({-40, -120, -50, -120});
  const DenseVolume made = difference(volume, volume);
  EXPECT_EQ(made.values, UnsetVector<float>(4, 0.0F));
  EXPECT_EQ(made.info.range_min, 0);
  EXPECT_EQ(made.info.range_max, 0);
}

TEST(Difference, VoxelsMaskedInEitherStayMasked) {
  const DenseVolume made =
      difference(volumeOf({-120, -40, -40, -40}, {1, 0}), volumeOf({-60, -120, -60, -60}, {0, 1}));
  EXPECT_EQ(made.first_valid_k, (std::vector<std::uint16_t>{1, 1}));
  EXPECT_EQ(made.values, (UnsetVector<float>{0, 0, 20, 20}));
}

TEST(Difference, HasTheUnitOfDifferences) {
  VolumeInfo info;
  info.quantity = "power_density_dbwm2:jammer";
  info.unit = "dBW/m2";
  EXPECT_EQ(differenceInfo(info).quantity, "power_density_difference_db:jammer");
  EXPECT_EQ(differenceInfo(info).unit, "dB");
  info.quantity = "detection_probability";
  info.unit = "";
  EXPECT_EQ(differenceInfo(info).quantity, "detection_probability_difference");
  EXPECT_EQ(differenceInfo(info).unit, "");
  EXPECT_TRUE(isDifference(differenceInfo(info)));
  EXPECT_FALSE(isDifference(info));
}

TEST(Difference, RefusesIncomparableVolumes) {
  const DenseVolume volume = volumeOf({1, 2, 3, 4});
  DenseVolume other = volume;
  other.grid.spacing_m.x = 11;
  EXPECT_EQ(errorOf(volume, other), "difference of power_density_dbwm2: the two grids are not the same");
  other = volume;
  other.info.quantity = "snr_db";
  EXPECT_EQ(errorOf(volume, other),
            "difference of power_density_dbwm2 and snr_db: expected the same quantity in the same unit");
  DenseVolume indices = volume;
  indices.info.quantity = "dominant_emitter";
  indices.info.categorical = true;
  EXPECT_EQ(errorOf(indices, indices),
            "dominant_emitter: indices have no difference; compare another quantity");
}

}  // namespace
}  // namespace emscape::volume
