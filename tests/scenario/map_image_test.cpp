#include "scenario/map/map_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/geodesy/gdal_file.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

/// An image of 40 x 20 pixels from 3 to 5 degrees east, 51 to 52 north: red grows to the east, green to the
/// south.
std::string writeImage(const test::TemporaryFolder& folder, int bands) {
  const std::string file = folder / "image.tif";
  gdal::prepare();
  const gdal::Dataset image(
      GDALCreate(GDALGetDriverByName("GTiff"), file.c_str(), 40, 20, bands, GDT_Byte, nullptr));
  double transform[6] = {3, 0.05, 0, 52, 0, -0.05};
  GDALSetGeoTransform(image.get(), transform);
  const gdal::SpatialReference wgs84(OSRNewSpatialReference(nullptr));
  OSRImportFromEPSG(wgs84.get(), 4326);
  char* text = nullptr;
  OSRExportToWkt(wgs84.get(), &text);
  GDALSetProjection(image.get(), text);
  CPLFree(text);
  for (int band = 1; band <= bands; ++band) {
    std::vector<std::uint8_t> values;
    for (int row = 0; row < 20; ++row) {
      for (int column = 0; column < 40; ++column)
        values.push_back(static_cast<std::uint8_t>(band == 1 ? 6 * column : (band == 2 ? 12 * row : 100)));
    }
    EXPECT_EQ(GDALRasterIO(GDALGetRasterBand(image.get(), band), GF_Write, 0, 0, 40, 20, values.data(), 40,
                           20, GDT_Byte, 0, 0),
              CE_None);
  }
  return file;
}

TEST(MapImage, ColoursAreThoseAtThePositions) {
  const test::TemporaryFolder folder;
  const std::vector<GeodeticPosition> positions{
      {51.975, 3.025, 0}, {51.975, 4.975, 0}, {51.025, 3.025, 0}, {53, 3.5, 0}, {51.5, -170, 0}};
  const MapColors colors = readMapColors(writeImage(folder, 3), positions);
  EXPECT_EQ(colors[0], 0xFF640000U);
  EXPECT_EQ(colors[1], 0xFF640000U + 6 * 39);
  EXPECT_EQ(colors[2], 0xFF640000U + (12 * 19 << 8));
  EXPECT_EQ(colors[3], 0U) << "outside";
  EXPECT_EQ(colors[4], 0U) << "outside";
  const MapColors grey = readMapColors(writeImage(folder, 1), positions);
  EXPECT_EQ(grey[1], 0xFF000000U + 6 * 39 * 0x10101);
}

TEST(MapImage, FaultsNameTheFile) {
  const test::TemporaryFolder folder;
  const auto faultOf = [](const std::string& file) {
    return test::errorOf([&] { readMapColors(file, {{51.5, 4, 0}}); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(faultOf(folder / "missing.tif"), HasSubstr("missing.tif: no such file"));
  EXPECT_THAT(faultOf(folder.write("text.tif", "no image")), HasSubstr("text.tif: not a GeoTIFF or MBTiles"));
  test::geographicDem(3, 52, 0.1, 10, 10, [](double, double) { return 5; }).write(folder / "heights.tif");
  EXPECT_THAT(faultOf(folder / "heights.tif"), HasSubstr("8 bits"));
}

}  // namespace
}  // namespace emscape::scenario
