#include "volume/format/raw.h"

#include <sys/stat.h>

#include "emscape/volume/statistics.h"
#include "tests/volume/sample_volumes.h"

namespace emscape::volume {
namespace {

using ::testing::HasSubstr;
using namespace test;

TEST(Raw, RoundTripIsExact) {
  TemporaryFolder folder;
  for (const DenseVolume& volume : {fieldVolume(), categoricalVolume(), plainVolume()}) {
    writeRaw(folder / "a.raw", volume);
    expectSame(readRaw(folder / "a.raw"), volume);
    expectSameInfo(describeRaw(folder / "a.raw"), volume);
  }
}

TEST(Raw, RoundTripKeepsInfinitiesOfHeader) {
  TemporaryFolder folder;
  DenseVolume volume = plainVolume();
  volume.info.floor = -std::numeric_limits<float>::infinity();
  writeRaw(folder / "a.raw", volume);
  EXPECT_EQ(readRaw(folder / "a.raw").info.floor, volume.info.floor);
}

TEST(Raw, FindsTheLayoutInTheName) {
  const auto layout = rawLayoutFromName("x/engine_256x250x110_uint8.raw");
  ASSERT_TRUE(layout.has_value());
  EXPECT_EQ(layout->dims, (Dims{256, 250, 110}));
  EXPECT_EQ(layout->type, VoxelType::uint8);
  EXPECT_FALSE(rawLayoutFromName("engine.raw").has_value());
  EXPECT_FALSE(rawLayoutFromName("engine_2x2x2_complex64.raw").has_value());
}

TEST(Raw, ReadsAFileWithoutHeaderByItsName) {
  TemporaryFolder folder;
  writeBytes(folder / "scan_3x2x1_uint16.raw", {1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 0, 1});
  const DenseVolume volume = readRaw(folder / "scan_3x2x1_uint16.raw");
  EXPECT_EQ(volume.values, (UnsetVector<float>{1, 2, 3, 4, 5, 256}));
  EXPECT_EQ(volume.info.quantity, "scan");
  EXPECT_EQ(volume.info.range_max, 256);
  RawLayout layout;
  layout.dims = {3, 2, 1};
  layout.type = VoxelType::uint16;
  layout.big_endian = true;
  EXPECT_EQ(readRaw(folder / "scan_3x2x1_uint16.raw", layout).values.back(), 1);
}

TEST(Raw, NamesExpectedAndFoundBytes) {
  TemporaryFolder folder;
  writeBytes(folder / "scan_3x2x2_uint16.raw", std::vector<std::uint8_t>(23));
  EXPECT_THAT(errorOf([&] { readRaw(folder / "scan_3x2x2_uint16.raw"); }),
              HasSubstr("expected 24 bytes for 3 x 2 x 2 voxels of uint16, found 23"));
  writeBytes(folder / "scan_60000x60000x60000_uint8.raw", {1});
  EXPECT_THAT(errorOf([&] { readRaw(folder / "scan_60000x60000x60000_uint8.raw"); }),
              HasSubstr("at most 4294967296 voxels"));
  writeBytes(folder / "scan.raw", {1});
  EXPECT_THAT(errorOf([&] { readRaw(folder / "scan.raw"); }), HasSubstr("_256x256x110_uint8.raw"));
}

TEST(Raw, NamesErrorsOfAHeader) {
  TemporaryFolder folder;
  const auto with = [&](const std::string& header) {
    writeBytes(folder / "a.raw", std::vector<std::uint8_t>(8));
    writeBytes(folder / "a.raw.json", {header.begin(), header.end()});
    return errorOf([&] { readRaw(folder / "a.raw"); });
  };
  EXPECT_THAT(with("{\"dims\": [2, 1"), HasSubstr("a.raw.json:1:15: not valid JSON"));
  EXPECT_THAT(with("[]"), HasSubstr("no JSON object"));
  EXPECT_THAT(with("{\"dims\": [2, 1, -1]}"), HasSubstr("key dims: -1 is not a whole number"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 0]}"), HasSubstr("each must be 1..65535"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 1], \"unit\": 3}"), HasSubstr("key unit:"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 1], \"time_utc\": \"-inf-06-01\"}"),
              HasSubstr("key time_utc: \"-inf-06-01\" is not a time"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 1], \"frame\": {\"kind\": \"moon\"}}"),
              HasSubstr("\"moon\" is neither"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 1]}"), HasSubstr("key type:"));
  EXPECT_THAT(with("{\"dims\": [2, 1, 1], \"type\": \"float16\"}"),
              HasSubstr("\"float16\" must be one of int8, uint8"));
  const std::string layout =
      "{\"dims\": [2, 1, 1], \"type\": \"float32\", \"order\": \"x fastest, then y, then z\"";
  EXPECT_THAT(with(layout + "}"), HasSubstr("key endianness:"));
  EXPECT_THAT(with(layout + ", \"endianness\": \"little\", \"first_valid_k\": [0]}"),
              HasSubstr("a mask of 1 columns for 2"));
  EXPECT_THAT(with(layout + ", \"endianness\": \"little\", \"first_valid_k\": [0, 2]}"),
              HasSubstr("a mask that begins at layer 2 of 1"));
}

TEST(Raw, AHeaderBeyondTheLimitsIsRefused) {
  TemporaryFolder folder;
  const auto with = [&](const std::string& member) {
    const std::string header =
        "{\"dims\": [2, 1, 1], \"type\": \"float32\", \"endianness\": \"little\", "
        "\"order\": \"x fastest, then y, then z\", " +
        member + "}";
    writeBytes(folder / "a.raw", std::vector<std::uint8_t>(8));
    writeBytes(folder / "a.raw.json", {header.begin(), header.end()});
    const std::string error = errorOf([&] { readRaw(folder / "a.raw"); }, ErrorCode::bad_input);
    EXPECT_EQ(errorOf([&] { describeRaw(folder / "a.raw"); }, ErrorCode::bad_input), error);
    return error;
  };
  EXPECT_EQ(with("\"spacing_m\": [1, 2, 0]"),
            folder / "a.raw.json: spacing_m in z 0 m is outside the allowed range 1e-20 to 1e+20 m");
  EXPECT_THAT(with("\"spacing_m\": [-1, 2, 3]"), HasSubstr("spacing_m in x -1 m is outside"));
  EXPECT_THAT(with("\"spacing_m\": [1, 1e30, 1]"), HasSubstr("spacing_m in y 1e+30 m is outside"));
  EXPECT_THAT(with("\"spacing_m\": [1, \"nan\", 1]"), HasSubstr("spacing_m in y nan m is outside"));
  EXPECT_THAT(with("\"first_center_m\": [0, 0, 1e300]"),
              HasSubstr("first_center_m in z 1e+300 m is outside the allowed range -1e+12 to 1e+12 m"));
  EXPECT_THAT(with("\"range_min\": 3, \"range_max\": 2"), HasSubstr("range_min 3 is above range_max 2"));
  EXPECT_THAT(with("\"range_min\": \"-inf\", \"range_max\": 2"),
              HasSubstr("range_min -inf is outside the allowed range"));
  EXPECT_THAT(with("\"time_s\": 1e99"),
              HasSubstr("time_s 1e+99 s is outside the allowed range -1e+12 to 1e+12 s"));
  EXPECT_THAT(with("\"floor\": 1e300"), HasSubstr("key floor: 1e+300 is outside the allowed range -3.4"));
  const auto withFrame = [&](const std::string& place) {
    return with("\"frame\": {\"kind\": \"enu\", " + place + "}");
  };
  EXPECT_THAT(
      withFrame("\"latitude_deg\": 95, \"longitude_deg\": 0, \"height_msl_m\": 0"),
      HasSubstr("latitude_deg of the frame's origin 95 deg is outside the allowed range -90 to 90 deg"));
  EXPECT_THAT(withFrame("\"latitude_deg\": 9, \"longitude_deg\": 181, \"height_msl_m\": 0"),
              HasSubstr("longitude_deg of the frame's origin 181 deg"));
  EXPECT_THAT(withFrame("\"latitude_deg\": 9, \"longitude_deg\": 0, \"height_msl_m\": 1e9"),
              HasSubstr("height_msl_m of the frame's origin 1000000000 m"));
  EXPECT_THAT(with("\"range_min\": 1e400"), HasSubstr("number overflow parsing '1e400'"));
  EXPECT_EQ(with("\"range_min\": 3"), "") << "not a range";
}

TEST(Raw, SurvivesADamagedHeader) {
  TemporaryFolder folder;
  writeRaw(folder / "a.raw", plainVolume());
  survivesDamage(folder / "a.raw.json", [&] { readRaw(folder / "a.raw"); });
}

TEST(Dat, ReadsSizesAndVoxels) {
  TemporaryFolder folder;
  writeBytes(folder / "a.dat", {2, 0, 1, 0, 1, 0, 7, 0, 0, 2});
  const DenseVolume volume = readDat(folder / "a.dat");
  EXPECT_EQ(volume.grid.dims, (Dims{2, 1, 1}));
  EXPECT_EQ(volume.values, (UnsetVector<float>{7, 512}));
  survivesDamage(folder / "a.dat", [&] { readDat(folder / "a.dat"); });
}

TEST(Dat, RefusesAPipeWithoutWaitingForIt) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "a.dat").c_str(), 0600), 0);
  EXPECT_THAT(errorOf([&] { describeDat(folder / "a.dat"); }), HasSubstr("it is not a regular file"));
}

TEST(Raw, ReadsAScanOfTheSizeOfTheEngine) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> bytes(256 * 256 * 110);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  writeBytes(folder / "engine_256x256x110_uint8.raw", bytes);
  const DenseVolume volume = readRaw(folder / "engine_256x256x110_uint8.raw");
  const Statistics statistics = statisticsOf(volume);
  EXPECT_EQ(statistics.valid, 256 * 256 * 110);
  EXPECT_EQ(statistics.min, 0);
  EXPECT_EQ(statistics.max, 255);
  EXPECT_EQ(volume.info.quantity, "engine");
}

}  // namespace
}  // namespace emscape::volume
