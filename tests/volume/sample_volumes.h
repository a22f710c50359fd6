/// Volumes that the tests of this module write and read back.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/files/file_reading.h"
#include "emscape/base/log.h"
#include "emscape/volume/dense_volume.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::volume::test {

using emscape::test::errorOf;
using emscape::test::TemporaryFolder;

/// The messages that a call logs.
inline std::vector<std::string> messagesOf(const std::function<void()>& body) {
  std::vector<std::string> messages;
  setLogSink([&](LogLevel, const std::string& message) { messages.push_back(message); });
  body();
  setLogSink({});
  return messages;
}

/// Uneven dims, spacing without short decimals, a mask with empty and full columns, voxels at the floor above
/// the ground, a block of one value (a tile in .vdb), and a NaN. @param dims  at least 4 x 5 x 4
inline DenseVolume fieldVolume(Dims dims = {21, 17, 18}) {
  DenseVolume volume;
  volume.grid.dims = dims;
  volume.grid.spacing_m = {150.0 / 7, 151.0 / 3, 60.1};
  volume.grid.first_center_m = {-15000.0 / 7, 1.0 / 3, -0.1};
  volume.grid.frame = {FrameKind::enu, 36.59, -84.25, 123.4};
  volume.grid.georeferenced = true;
  volume.info.quantity = "power_density_dbwm2";
  volume.info.unit = "dBW/m2";
  volume.info.time_s = 1.1;
  volume.info.time_utc = "2026-06-01T06:00:01.100Z";
  volume.info.floor = -120;
  volume.info.range_min = -119.5F;
  volume.info.range_max = 3.25F;
  volume.info.extra = {
      {"scenario_hash", "0123abcd"}, {"version", "0.1.0"}, {"warnings", "a \"quoted\" <tag> & more"}};
  volume.values.assign(static_cast<std::size_t>(dims.count()), -120.F);
  volume.first_valid_k.assign(static_cast<std::size_t>(dims.x) * dims.y, 0);
  for (int j = 0; j < dims.y; ++j) {
    for (int i = 0; i < dims.x; ++i) {
      const int ground = i == 0 ? dims.z : (i * 7 + j * 3) % 5;
      volume.first_valid_k[static_cast<std::size_t>(j) * dims.x + i] = static_cast<std::uint16_t>(ground);
      for (int k = ground; k < dims.z; ++k) {
        const bool block = i >= 8 && i < 16 && j >= 8 && j < 16 && k >= 8 && k < 16;
        const bool quiet = (i + j + k) % 11 == 0;
        const float value = block ? -3.5F : quiet ? -120.F : std::sin(0.3F * i + 0.7F * j) * 50 - k;
        volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))] = value;
      }
    }
  }
  volume.values[static_cast<std::size_t>(volume.grid.index(3, 4, dims.z - 1))] = std::nanf("");
  return volume;
}

inline DenseVolume categoricalVolume(Dims dims = {9, 10, 11}) {
  DenseVolume volume = fieldVolume(dims);
  volume.grid.frame.kind = FrameKind::altitude;
  volume.info.quantity = "dominant_emitter";
  volume.info.unit = "";
  volume.info.floor = -1;
  volume.info.range_min = 0;
  volume.info.range_max = 4;
  volume.info.categorical = true;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        const float value = volume.isMasked(i, j, k) ? -1.F : static_cast<float>((i / 3 + j / 4 + k) % 6 - 1);
        volume.values[static_cast<std::size_t>(volume.grid.index(i, j, k))] = value;
      }
    }
  }
  return volume;
}

/// A scan without a position on the earth and without a mask.
inline DenseVolume plainVolume(Dims dims = {5, 4, 3}) {
  DenseVolume volume;
  volume.grid.dims = dims;
  volume.grid.spacing_m = {1, 1, 1};
  volume.info.quantity = "density";
  volume.values.resize(static_cast<std::size_t>(dims.count()));
  for (std::size_t i = 0; i < volume.values.size(); ++i) volume.values[i] = static_cast<float>(i) * 0.1F;
  volume.info.range_min = 0.1F;
  volume.info.range_max = volume.values.back();
  return volume;
}

inline void expectSameInfo(const DenseVolume& read, const DenseVolume& written) {
  EXPECT_TRUE(read.grid == written.grid);
  EXPECT_EQ(read.info.quantity, written.info.quantity);
  EXPECT_EQ(read.info.unit, written.info.unit);
  EXPECT_EQ(read.info.time_s, written.info.time_s);
  EXPECT_EQ(read.info.time_utc, written.info.time_utc);
  EXPECT_EQ(read.info.floor, written.info.floor);
  EXPECT_EQ(read.info.range_min, written.info.range_min);
  EXPECT_EQ(read.info.range_max, written.info.range_max);
  EXPECT_EQ(read.info.categorical, written.info.categorical);
  EXPECT_EQ(read.info.extra, written.info.extra);
}

/// Equal to the last bit, NaN included.
inline void expectSame(const DenseVolume& read, const DenseVolume& written) {
  expectSameInfo(read, written);
  EXPECT_EQ(read.first_valid_k, written.first_valid_k);
  ASSERT_EQ(read.values.size(), written.values.size());
  EXPECT_EQ(std::memcmp(read.values.data(), written.values.data(), written.values.size() * sizeof(float)), 0);
}

inline void writeBytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Changes one byte of a file.
inline void putByte(const std::filesystem::path& path, std::size_t at, std::uint8_t byte) {
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(static_cast<char>(byte));
}

/// Reads the file truncated at many lengths, which must give an Error, and with damaged bytes all over it,
/// which must give an Error or a volume.
inline void survivesDamage(const std::filesystem::path& path, const std::function<void()>& read) {
  const std::vector<std::uint8_t> whole = readWhole(path);
  const std::size_t step = whole.size() / 70 + 1;
  for (std::size_t at = 0; at < whole.size(); at += at < 1200 ? 5 : step) {
    for (const std::uint8_t flip : {0x80, 0x7f}) {
      putByte(path, at, whole[at] ^ flip);
      try {
        read();
      } catch (const Error&) {
      }
    }
    putByte(path, at, whole[at]);
  }
  EXPECT_NO_THROW(read());
  // A text is complete without its last newline.
  for (std::size_t size = whole.size() - 2; size > 0; size -= std::min(size, size > 400 ? step : 13)) {
    std::filesystem::resize_file(path, size);
    EXPECT_THROW(read(), Error) << "truncated to " << size << " of " << whole.size() << " bytes";
  }
}

}  // namespace emscape::volume::test
