#include "emscape/volume/device_volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/errors.h"
#include "tests/support/gpu.h"

namespace emscape::volume {
namespace {

DenseVolume makeVolume(const Dims& dims, bool masked) {
  DenseVolume volume;
  volume.grid.dims = dims;
  volume.grid.spacing_m = {100, 100, 50};
  volume.info.quantity = "power_density_dbwm2";
  volume.info.floor = -120;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) volume.values.push_back(static_cast<float>(i - 3 * j) + 0.25F * k);
    }
  }
  if (!masked) return volume;
  for (int column = 0; column < dims.x * dims.y; ++column) {
    const int first = column * 7 % (dims.z + 1);
    volume.first_valid_k.push_back(static_cast<std::uint16_t>(first));
    for (int k = 0; k < first; ++k) {
      volume.values[static_cast<std::size_t>(k) * dims.x * dims.y + column] = volume.info.floor;
    }
  }
  return volume;
}

TEST(DeviceVolume, EqualsUploadedVolume) {
  EMSCAPE_NEEDS_GPU();
  for (const Dims& dims : {Dims{1, 1, 1}, Dims{17, 5, 9}, Dims{64, 33, 21}}) {
    for (const bool masked : {false, true}) {
      const DenseVolume volume = makeVolume(dims, masked);
      for (const VoxelPrecision precision : {VoxelPrecision::float32, VoxelPrecision::float16}) {
        DeviceVolume device(volume.grid, precision);
        device.upload(volume);
        const DenseVolume back = device.download();
        // Multiples of a quarter below 512 are exact in 16 bits too.
        EXPECT_EQ(back.values, volume.values) << dims.x << " " << masked;
        EXPECT_EQ(back.first_valid_k, volume.first_valid_k);
        EXPECT_EQ(back.grid, volume.grid);
        EXPECT_EQ(back.info.quantity, volume.info.quantity);
      }
    }
  }
}

TEST(DeviceVolume, RoundsTo11BitsInHalfPrecision) {
  EMSCAPE_NEEDS_GPU();
  DenseVolume volume = makeVolume({8, 8, 8}, false);
  for (float& value : volume.values) value = std::sin(value) * 100;
  DeviceVolume device(volume.grid, VoxelPrecision::float16);
  device.upload(volume);
  const DenseVolume back = device.download();
  for (std::size_t n = 0; n < volume.values.size(); ++n) {
    EXPECT_NEAR(back.values[n], volume.values[n], std::abs(volume.values[n]) / 2048);
  }
}

TEST(DeviceVolume, NamesSizeThatDoesNotFit) {
  EMSCAPE_NEEDS_GPU();
  Grid grid;
  grid.dims = {4096, 16384, 64};  // 16 GiB
  const std::size_t needed = deviceBytes(grid.dims, VoxelPrecision::float32);
  EXPECT_GE(needed, std::size_t{16} << 30);
  // Volumes are taken until nothing is left.
  std::vector<std::unique_ptr<DeviceVolume>> volumes;
  const std::string error = test::errorOf(
      [&] {
        while (volumes.size() < 64) volumes.push_back(std::make_unique<DeviceVolume>(grid));
      },
      ErrorCode::device);
  EXPECT_THAT(error, ::testing::HasSubstr("4096 x 16384 x 64 voxels in 32 bit needs 16"));
  EXPECT_THAT(error, ::testing::HasSubstr("MiB are free"));
  EXPECT_THAT(error, ::testing::HasSubstr("in 16 bit it would need 8"));
  grid.dims = {40000, 1, 1};
  EXPECT_THROW(DeviceVolume{grid}, Error);
}

TEST(DeviceVolume, RefusesAnotherVolumesDimsAndMasks) {
  EMSCAPE_NEEDS_GPU();
  DeviceVolume device(makeVolume({8, 8, 8}, false).grid);
  EXPECT_THROW(device.upload(makeVolume({8, 8, 7}, false)), Error);
  EXPECT_THROW(device.setMask({1, 2, 3}), Error);
}

TEST(DeviceVolumeRing, ReturnsUnusedVolume) {
  EMSCAPE_NEEDS_GPU();
  Grid grid;
  grid.dims = {4, 4, 4};
  DeviceVolumeRing ring;
  auto first = ring.next(grid, VoxelPrecision::float32);
  auto second = ring.next(grid, VoxelPrecision::float32);
  EXPECT_NE(first, second);
  const DeviceVolume* const let_go = first.get();
  first.reset();
  EXPECT_EQ(ring.next(grid, VoxelPrecision::float32).get(), let_go);
  grid.dims.z = 5;
  EXPECT_EQ(ring.next(grid, VoxelPrecision::float16)->grid().dims.z, 5);
}

TEST(DeviceVolume, IsRefusedWhereThereIsNoGpu) {
  if (findDevice().usable) GTEST_SKIP() << "there is a GPU";
  Grid grid;
  grid.dims = {4, 4, 4};
  EXPECT_NE(test::errorOf([&] { DeviceVolume volume(grid); }, ErrorCode::device), "");
}

}  // namespace
}  // namespace emscape::volume
