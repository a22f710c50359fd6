/// Elevation files: units, projections, errors.
#include <fmt/core.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/log.h"
#include "emscape/base/units.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/view.h"
#include "scenario/terrain/vrt.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using test::DemFile;
using test::geographicDem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

double flat(double, double) {
  return 100;
}

class TerrainFileTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const DemFile& file) const {
    file.write(folder_ / name);
    return folder_ / name;
  }

  /// The message of loading a file over a box; nothing may be printed meanwhile.
  std::string problemOf(const std::string& file, const SourceLocation& location = {}) const {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    const std::string message = test::errorOf(
        [&] {
          Terrain::load({{file}, {location}, VerticalDatum::egm96}, {49, 50, 10, 11});
        },
        ErrorCode::bad_input);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    return message;
  }

  test::TemporaryFolder folder_;
};

TerrainPtr load(const std::vector<std::string>& files, const GeoBox& box) {
  return Terrain::load({files, {}, VerticalDatum::egm96}, box);
}

// --- units

TEST_F(TerrainFileTest, FeetBecomeMetres) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.unit = "ft";
  EXPECT_NEAR(load({write("ft.tif", file)}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5), 30.48, 1e-4);
  EXPECT_THAT(Terrain::describe(folder_ / "ft.tif").notes, Contains(HasSubstr("'ft' are converted")));
  file.unit = "US survey foot";
  EXPECT_NEAR(load({write("us.tif", file)}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5), 100 * 1200 / 3937.0,
              1e-4);
}

TEST_F(TerrainFileTest, ScaleAndOffsetAreAppliedBeforeTheUnit) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.scale = 0.5;
  file.offset = -20;
  file.unit = "ft";
  EXPECT_NEAR(load({write("a.tif", file)}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5), 30 * 0.3048, 1e-4);
}

TEST_F(TerrainFileTest, AnUnknownUnitIsAnError) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.unit = "fathom";
  EXPECT_THAT(problemOf(write("a.tif", file)),
              AllOf(HasSubstr("a.tif"), HasSubstr("'fathom'"), HasSubstr("m, ft")));
}

TEST_F(TerrainFileTest, OfSeveralBandsTheFirstHoldsHeights) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.bands = 3;
  const auto path = write("a.tif", file);
  EXPECT_EQ(load({path}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5), 100);
  EXPECT_THAT(Terrain::describe(path).notes, Contains(HasSubstr("3 bands")));
}

TEST_F(TerrainFileTest, ANoteOnManyFilesIsLoggedOnce) {
  std::vector<std::string> files;
  for (const double longitude_deg : {10, 11, 12}) {
    DemFile file = geographicDem(longitude_deg, 50, 0.1, 10, 10, flat);
    file.bands = 3;
    if (longitude_deg == 12) file.unit = "ft";
    files.push_back(write("e" + std::to_string(int(longitude_deg)) + ".tif", file));
  }
  std::vector<std::string> messages;
  setLogSink([&](LogLevel, const std::string& message) { messages.push_back(message); });
  const TerrainPtr terrain = load(files, {49, 50, 10, 13});
  setLogSink({});
  EXPECT_THAT(
      messages,
      ElementsAre("elevation file " + files[0] + " and 2 more: has 3 bands: heights are taken from the first",
                  "elevation file " + files[2] + ": heights in 'ft' are converted to metres"));
}

// --- projections

/// A height that encodes easting and northing, so that misplaced heights are detected.
double ramp(double east_m, double north_m) {
  return 0.01 * (east_m - 500e3) + 0.02 * (north_m - 5500e3) + 1000;
}

DemFile rampDem(const std::string& crs, double west_m, double north_m, double step_m, int columns, int rows) {
  DemFile file;
  file.crs = crs;
  file.columns = columns;
  file.rows = rows;
  file.transform = {west_m, step_m, 0, north_m, 0, -step_m};
  file.value = [=](int column, int row) {
    return ramp(west_m + (column + 0.5) * step_m, north_m - (row + 0.5) * step_m);
  };
  return file;
}

TEST_F(TerrainFileTest, ProjectedPostsLieWhereTheProjectionPutsThem) {
  const std::string utm = "EPSG:32632";
  const auto file = write("utm.tif", rampDem(utm, 480e3, 5520e3, 50, 800, 800));
  const TerrainPtr terrain = load({file}, {49.5, 49.8, 8.8, 9.2});
  EXPECT_NEAR(terrain->postSpacing_m(), 50, 0.1);
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  for (double latitude_deg : {49.5, 49.612, 49.7789}) {
    for (double longitude_deg : {8.8, 8.91, 9.0, 9.1234}) {
      const auto [east_m, north_m] = test::projected(utm, latitude_deg, longitude_deg);
      EXPECT_NEAR(terrain->heightMsl_m(latitude_deg, longitude_deg), ramp(east_m, north_m), 0.02);
    }
  }
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.0, 9.0)));
}

TEST_F(TerrainFileTest, HeightsGoOnBetweenProjectedTiles) {
  const std::string utm = "EPSG:32632";
  const auto west = write("w.tif", rampDem(utm, 490e3, 5510e3, 50, 200, 400));
  const auto east = write("e.tif", rampDem(utm, 500e3, 5510e3, 50, 200, 400));
  const TerrainPtr terrain = load({west, east}, {49.6, 49.7, 8.9, 9.1});
  EXPECT_EQ(terrain->view().count, 1);
  for (double longitude_deg = 8.995; longitude_deg < 9.005; longitude_deg += 1e-4) {
    const auto [east_m, north_m] = test::projected(utm, 49.65, longitude_deg);
    ASSERT_NEAR(terrain->heightMsl_m(49.65, longitude_deg), ramp(east_m, north_m), 0.02) << longitude_deg;
  }
}

TEST_F(TerrainFileTest, HeightsGoOnBetweenZones) {
  const auto height = [](double latitude_deg, double longitude_deg) {
    return 100 * latitude_deg + 50 * longitude_deg;
  };
  std::vector<std::string> files;
  for (const char* crs : {"EPSG:32632", "EPSG:32633"}) {
    // The common border is longitude 12; each zone's file reaches over it a little.
    const auto [x, y] = test::projected(crs, 50, 12);
    DemFile file = rampDem(crs, 0, 0, 100, 400, 400);
    const bool western = std::string(crs) == "EPSG:32632";
    file.transform = {x - (western ? 38e3 : 2e3), 100, 0, y + 20e3, 0, -100};
    // Linear in the plane, and close enough to linear in degrees to reveal a seam: taken at the border's
    // scale.
    const auto [x_east, y_east] = test::projected(crs, 50, 12.1);
    const auto [x_north, y_north] = test::projected(crs, 50.1, 12);
    const double a = (x_east - x) / 0.1, b = (x_north - x) / 0.1, c = (y_east - y) / 0.1,
                 d = (y_north - y) / 0.1;
    file.value = [=, transform = file.transform](int column, int row) {
      const double u = transform[0] + (column + 0.5) * 100 - x, v = transform[3] - (row + 0.5) * 100 - y;
      const double determinant = a * d - b * c;
      return height(50 + (a * v - c * u) / determinant, 12 + (d * u - b * v) / determinant);
    };
    files.push_back(write(std::string(crs).substr(5) + ".tif", file));
  }
  const TerrainPtr terrain = load(files, {49.95, 50.05, 11.8, 12.2});
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  double last_m = terrain->heightMsl_m(50, 11.9);
  for (double longitude_deg = 11.9001; longitude_deg < 12.1; longitude_deg += 1e-4) {
    const double height_m = terrain->heightMsl_m(50, longitude_deg);
    ASSERT_NEAR(height_m - last_m, 50e-4, 0.15) << longitude_deg;
    last_m = height_m;
  }
}

TEST_F(TerrainFileTest, APolarProjectionCoversThePole) {
  const std::string polar = "EPSG:3031";
  DemFile file;
  file.crs = polar;
  file.columns = file.rows = 200;
  file.transform = {-500e3, 5000, 0, 500e3, 0, -5000};
  file.value = [](int column, int row) { return 2000 + 5 * (column - 99.5) + 3 * (row - 99.5); };
  const auto path = write("pole.tif", file);
  const auto expected = [&](double latitude_deg, double longitude_deg) {
    const auto [x, y] = test::projected(polar, latitude_deg, longitude_deg);
    return 2000 + 5 * x / 5000 - 3 * y / 5000;
  };
  const TerrainPtr terrain = load({path}, {-90, -87, -180, 180});
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  for (double longitude_deg = -180; longitude_deg <= 180; longitude_deg += 22.5) {
    for (double latitude_deg : {-87.2, -88.5, -89.7, -90.0}) {
      EXPECT_NEAR(terrain->heightMsl_m(latitude_deg, longitude_deg), expected(latitude_deg, longitude_deg),
                  0.1);
    }
  }
  const TerrainPtr across = load({path}, {-89, -88, 170, 190});
  EXPECT_EQ(across->uncoveredFraction(), 0);
  EXPECT_NEAR(across->heightMsl_m(-88.5, 180.02), expected(-88.5, -179.98), 0.1);
}

TEST_F(TerrainFileTest, VoidsOfAProjectedFileStayVoid) {
  DemFile file = rampDem("EPSG:32632", 490e3, 5510e3, 50, 400, 400);
  file.nodata = -9999;
  const auto [east_m, north_m] = test::projected(file.crs, 49.65, 9.0);
  file.value = [east = (east_m - 490e3) / 50, south = (5510e3 - north_m) / 50](int column, int row) {
    return std::hypot(column + 0.5 - east, row + 0.5 - south) < 20 ? -9999 : 100;
  };
  const TerrainPtr terrain = load({write("a.tif", file)}, {49.6, 49.7, 8.9, 9.1});
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.65, 9.0)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.658, 9.0)));
  EXPECT_EQ(terrain->heightMsl_m(49.66, 9.05), 100);
  EXPECT_GT(terrain->voidPosts(), 0);
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  EXPECT_EQ(terrain->lowest_m(), 100);
}

TEST_F(TerrainFileTest, AnotherDatumIsBroughtToWgs84) {
  const std::string nad27 = "EPSG:4267";
  const auto height = [](double latitude_deg, double longitude_deg) {
    return 1e5 * (latitude_deg - 36) - 1e5 * (longitude_deg + 84);
  };
  DemFile file = geographicDem(-84.1, 36.1, 0.0002, 1000, 1000, height);
  file.crs = nad27;
  const TerrainPtr terrain = load({write("a.tif", file)}, {35.95, 36.05, -84.05, -83.95});
  const auto [longitude_deg, latitude_deg] = test::projected(nad27, 36.0, -84.0);
  ASSERT_GT(std::abs(longitude_deg + 84) + std::abs(latitude_deg - 36), 5e-5) << "the datums differ here";
  EXPECT_NEAR(terrain->heightMsl_m(36, -84), height(latitude_deg, longitude_deg), 0.5);
}

TEST_F(TerrainFileTest, AVirtualMosaicIsReadWhereTheBoxIs) {
  const auto west = write("w.tif", geographicDem(10, 50, 0.01, 100, 100, flat));
  std::ofstream(folder_ / "m.vrt") << R"(<VRTDataset rasterXSize="3600" rasterYSize="100"><SRS>EPSG:4326</SRS>
    <GeoTransform>10, 0.01, 0, 50, 0, -0.01</GeoTransform>
    <VRTRasterBand dataType="Float32" band="1"><NoDataValue>-9999</NoDataValue>
      <SimpleSource><SourceFilename relativeToVRT="1">w.tif</SourceFilename><SourceBand>1</SourceBand>
        <SrcRect xOff="0" yOff="0" xSize="100" ySize="100"/><DstRect xOff="0" yOff="0" xSize="100" ySize="100"/>
      </SimpleSource></VRTRasterBand></VRTDataset>)";
  const TerrainPtr terrain = load({folder_ / "m.vrt"}, {49.2, 49.8, 10.5, 11.5});
  EXPECT_EQ(terrain->heightMsl_m(49.5, 10.7), 100);
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.5, 11.2)));
  EXPECT_LT(terrain->view().rasters[0].columns, 110);
}

TEST_F(TerrainFileTest, AVirtualMosaicWithoutItsTilesIsAnError) {
  std::ofstream(folder_ / "m.vrt") << R"(<VRTDataset rasterXSize="100" rasterYSize="100"><SRS>EPSG:4326</SRS>
    <GeoTransform>10, 0.01, 0, 50, 0, -0.01</GeoTransform>
    <VRTRasterBand dataType="Float32" band="1">
      <SimpleSource><SourceFilename relativeToVRT="1">gone.tif</SourceFilename><SourceBand>1</SourceBand>
        <SrcRect xOff="0" yOff="0" xSize="100" ySize="100"/><DstRect xOff="0" yOff="0" xSize="100" ySize="100"/>
      </SimpleSource></VRTRasterBand></VRTDataset>)";
  EXPECT_THAT(problemOf(folder_ / "m.vrt"), AllOf(HasSubstr("m.vrt"), HasSubstr("gone.tif")));
}

// --- descriptions of files

TEST_F(TerrainFileTest, DescribeStatesContentsOfTheFile) {
  DemFile file = geographicDem(10, 50, 0.1, 20, 10, flat);
  file.nodata = -1;
  file.value = [](int column, int row) { return column == 3 ? -1 : 10 * row + column; };
  const TerrainFileInfo info = Terrain::describe(write("a.tif", file));
  EXPECT_EQ(info.format, "GeoTIFF");
  EXPECT_EQ(info.crs, "WGS 84 (EPSG:4326)");
  EXPECT_EQ(info.columns, 20);
  EXPECT_EQ(info.rows, 10);
  EXPECT_TRUE(info.pixel_is_area);
  EXPECT_NEAR(info.box.south_deg, 49, 1e-9);
  EXPECT_NEAR(info.box.north_deg, 50, 1e-9);
  EXPECT_NEAR(info.box.west_deg, 10, 1e-9);
  EXPECT_NEAR(info.box.east_deg, 12, 1e-9);
  EXPECT_NEAR(info.post_spacing_lat_deg, 0.1, 1e-9);
  EXPECT_NEAR(info.post_spacing_lon_deg, 0.1, 1e-9);
  EXPECT_EQ(info.lowest_m, 0);
  EXPECT_EQ(info.highest_m, 109);
  EXPECT_EQ(info.void_posts, 10);
  EXPECT_TRUE(info.notes.empty());
  EXPECT_TRUE(std::isnan(Terrain::describe(info.file, false).highest_m));
}

TEST_F(TerrainFileTest, DescribePlacesAProjectedFileOnTheEarth) {
  const auto file = write("utm.tif", rampDem("EPSG:32632", 480e3, 5520e3, 50, 800, 800));
  const TerrainFileInfo info = Terrain::describe(file);
  EXPECT_THAT(info.crs, HasSubstr("UTM zone 32N"));
  EXPECT_NEAR(info.post_spacing_lat_deg, 50 / 111.2e3, 1e-6);
  EXPECT_NEAR(info.post_spacing_lon_deg, 50 / 111.2e3 / std::cos(degToRad(49.66)), 1e-5);
  EXPECT_NEAR(info.box.west_deg, 8.72, 0.02);
  EXPECT_NEAR(info.box.north_deg, 49.83, 0.02);
  EXPECT_THAT(info.notes, Contains(HasSubstr("UTM zone 32N")));
}

TEST_F(TerrainFileTest, DescribeRepeatsTheVerticalDatumOfTheFile) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.crs = "EPSG:4326+5773";
  const TerrainFileInfo info = Terrain::describe(write("a.tif", file));
  EXPECT_THAT(info.vertical_datum, HasSubstr("(stated by the file: EGM96 height)"));
  EXPECT_EQ(load({info.file}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5), 100);
}

TEST_F(TerrainFileTest, HeightsOfAThreeDimensionalCrsAreAboveTheEllipsoid) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.crs = "EPSG:4979";
  const TerrainFileInfo info = Terrain::describe(write("a.tif", file));
  EXPECT_THAT(info.vertical_datum, HasSubstr("the ellipsoid (stated by the file"));
  EXPECT_NEAR(Terrain::load({{info.file}, {}, {}}, {49, 50, 10, 11})->heightMsl_m(49.5, 10.5),
              100 - geoidUndulation_m(49.5, 10.5), 0.01);
}

TEST_F(TerrainFileTest, FillValuesFarBelowTheirNeighboursAreVoid) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.unit = "m";
  for (const double fill : {-9999.0, -999.0, -10000.0}) {
    file.value = [fill](int column, int) { return column == 3 || column == 4 ? fill : 100.0; };
    const std::string undeclared = write("a.tif", file);
    const TerrainFileInfo info = Terrain::describe(undeclared);
    EXPECT_THAT(info.warnings,
                Contains(HasSubstr(fmt::format("20 posts of {:g} m are more than 500 m below", fill))));
    EXPECT_EQ(info.lowest_m, 100);
    EXPECT_EQ(info.void_posts, 20);
    const TerrainPtr terrain = load({undeclared}, {49, 50, 10, 11});
    EXPECT_THAT(terrain->warnings(),
                ElementsAre(HasSubstr("elevation file " + undeclared + ": 20 posts of")));
    EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.55, 10.35)));
    EXPECT_EQ(terrain->heightMsl_m(49.55, 10.75), 100);
  }
}

TEST_F(TerrainFileTest, DepthsOfTheSeaAreNoFillValues) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  // A trench, its bottom flat, with sides of up to 400 m from post to post.
  file.value = [](int column, int) { return -1000.0 - 400.0 * std::min({column, 9 - column, 3}); };
  const std::string sea = write("sea.tif", file);
  EXPECT_THAT(Terrain::describe(sea).warnings,
              ElementsAre(HasSubstr("states no vertical datum"),
                          HasSubstr("100 of 100 posts (100 %) are below -500 m, the lowest at -2200 m")));
  EXPECT_EQ(Terrain::describe(sea).lowest_m, -2200);
  EXPECT_EQ(load({sea}, {49, 50, 10, 11})->heightMsl_m(49.55, 10.45), -2200);
}

TEST_F(TerrainFileTest, FillValuesAreFoundAmongManyDifferentDepths) {
  constexpr int kPosts = 400;
  DemFile file = geographicDem(10, 50, 1.0 / kPosts, kPosts, kPosts, flat);
  // More than 65536 different depths, and a block of a fill value on land beside them.
  file.value = [](int column, int row) {
    if (column < 20) return row >= 100 && row < 110 && column >= 5 && column < 10 ? -9999.0 : 50.0;
    return column < 40 ? -30.0 * (column - 19) : -600.0 - 0.002 * (column * kPosts + row);
  };
  const TerrainFileInfo info = Terrain::describe(write("a.tif", file));
  EXPECT_EQ(info.void_posts, 50);
  EXPECT_NEAR(info.lowest_m, -600 - 0.002 * kPosts * kPosts, 1);
  EXPECT_THAT(info.warnings, Contains(HasSubstr("50 posts of -9999 m")));
}

TEST_F(TerrainFileTest, APictureIsNoTerrain) {
  const std::string file = write("rgb.tif", geographicDem(10, 50, 0.1, 10, 10, flat));
  GDALDatasetH dataset = GDALOpen(file.c_str(), GA_Update);
  GDALSetRasterColorInterpretation(GDALGetRasterBand(dataset, 1), GCI_RedBand);
  GDALClose(dataset);
  EXPECT_THAT(test::errorOf([&] { Terrain::describe(file); }, ErrorCode::bad_input),
              HasSubstr("is a picture, not heights: its band 1 is 'Red'"));
}

TEST_F(TerrainFileTest, HeightsOfAMapInFeetWithoutAUnitAreWarnedOf) {
  DemFile file;
  file.crs = "EPSG:2231";  // NAD83 / Colorado North (ftUS)
  file.columns = file.rows = 10;
  file.transform = {3000000, 1000, 0, 1300000, 0, -1000};
  file.value = flat;
  const TerrainFileInfo info = Terrain::describe(write("feet.tif", file));
  EXPECT_THAT(info.warnings, Contains(HasSubstr("it has no unit of heights: they are taken as metres")));
}

// --- faults

TEST_F(TerrainFileTest, AMissingFileIsNamed) {
  const std::string file = folder_ / "none.tif";
  EXPECT_EQ(problemOf(file), "elevation file " + file + ": no such file");
  EXPECT_EQ(problemOf(file, {"s.yaml", 7, 12}), "s.yaml:7:12: elevation file " + file + ": no such file");
}

TEST_F(TerrainFileTest, FileThatIsNoRasterIsRefused) {
  std::ofstream(folder_ / "notes.tif") << "not a raster";
  EXPECT_THAT(problemOf(folder_ / "notes.tif"), AllOf(HasSubstr("notes.tif"), HasSubstr("not a raster")));
  EXPECT_THAT(problemOf(folder_.path().string()), HasSubstr("notes.tif"));
  std::filesystem::create_directory(folder_ / "folder.tif");
  EXPECT_THAT(problemOf(folder_ / "folder.tif"), HasSubstr("folder.tif has none"));
  std::ofstream(folder_ / "empty.dt1").flush();
  EXPECT_THAT(problemOf(folder_ / "empty.dt1"), HasSubstr("not a raster"));
}

TEST_F(TerrainFileTest, AbsurdPositionsAreRefused) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.transform[0] = 6e282;
  EXPECT_THAT(problemOf(write("far.tif", file)), HasSubstr("its posts are not on the earth"));
  file.transform[0] = 5000;
  EXPECT_THAT(
      problemOf(write("round.tif", file)),
      HasSubstr("its longitudes run from 5000 to 5001 deg, outside the allowed range -1080 to 1080 deg"));
  DemFile column = geographicDem(10, 50, 0.1, 1, 10, flat);
  column.transform[0] = -4e6 + 10;
  column.transform[1] = 8e6;
  EXPECT_THAT(problemOf(write("column.tif", column)), HasSubstr("its longitudes run from"));
  file.transform[0] = 10;
  file.transform[1] = 1e300;
  EXPECT_THAT(problemOf(write("wide.tif", file)), HasSubstr("its posts are not on the earth"));
  file.transform[1] = 0.1;
  file.transform[5] = -5e-315;
  EXPECT_THAT(problemOf(write("flat.tif", file)),
              HasSubstr("its posts are 5e-315 apart, less than the allowed 1e-09 of the coordinates' unit"));
}

TEST_F(TerrainFileTest, PostsThatAreNotOnTheEarthAreRefused) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.crs = "EPSG:32632";
  file.transform = {4e8, 30, 0, 4e8, 0, -30};
  const std::string name = write("off.tif", file);
  const std::string refusal = "elevation file " + name + ": its posts are not on the earth";
  EXPECT_EQ(test::errorOf([&] { Terrain::describe(name); }), refusal);
  EXPECT_EQ(problemOf(name), refusal);
}

/// Writes a VRT of 10 rows. @param bands  the elements of its bands  @param attributes  of its root
void writeVrt(const std::string& file, const std::string& bands,
              const std::string& attributes = "rasterXSize=\"10\"") {
  std::ofstream(file) << "<VRTDataset rasterYSize=\"10\" " << attributes << "><SRS>EPSG:4326</SRS>"
                      << "<GeoTransform>10, 0.1, 0, 50, 0, -0.1</GeoTransform>" << bands << "</VRTDataset>";
}

/// A band with one source. @param name  the element that names it
std::string bandOf(const std::string& name) {
  return "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>" + name +
         "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>";
}

TEST_F(TerrainFileTest, AVrtReadsOnlyItsOwnFolder) {
  const auto problemWith = [&](const std::string& bands, const std::string& columns = "10") {
    writeVrt(folder_ / "a.vrt", bands, "rasterXSize=\"" + columns + "\"");
    return problemOf(folder_ / "a.vrt");
  };
  const std::string own = "<SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>";
  write("a.tif", geographicDem(10, 50, 0.1, 10, 10, flat));
  EXPECT_EQ(problemWith(bandOf(own)), "");
  EXPECT_EQ(problemWith(bandOf("<SourceFilename>" + folder_ / "a.tif" + "</SourceFilename>")), "");
  for (const char* source : {"<SourceFilename relativeToVRT=\"1\">../a.tif</SourceFilename>",
                             "<sourcefilename relativetovrt=\"1\">../a.tif</sourcefilename>",
                             "<SourceFilename>/etc/hostname</SourceFilename>",
                             "<SourceFilename>/vsicurl/x.tif</SourceFilename>"}) {
    EXPECT_THAT(problemWith(bandOf(source)), HasSubstr("is not a file in its own folder")) << source;
  }
  for (const char* source : {"<SourceFilename>/vsicurl/http://127.0.0.1:1/x.tif</SourceFilename>",
                             "<SourceFilename relativeToVRT=\"1\">http://127.0.0.1:1/x.tif</SourceFilename>",
                             "<SourceFilename relativeToVRT=\"1\">PG:host=127.0.0.1</SourceFilename>",
                             "<SourceFilename relativeToVRT=\"1\">12:30.tif</SourceFilename>",
                             "<SourceFilename>&lt;VRTDataset/></SourceFilename>"}) {
    EXPECT_THAT(problemWith(bandOf(source)),
                HasSubstr("names of sources with '<', '{' or ':' are not allowed"))
        << source;
  }
  EXPECT_THAT(problemWith(bandOf("<SourceFilename relativeToVRT=\"2\">a.tif</SourceFilename>")),
              HasSubstr("relativeToVRT=\"2\", which must be 0 or 1"));
  EXPECT_THAT(problemWith(bandOf(own), "2147483647"),
              HasSubstr("more than the allowed 4194304 in a row or column"));
}

TEST_F(TerrainFileTest, AVrtIsAMosaicOrAReprojection) {
  const auto problemWith = [&](const std::string& bands, const std::string& kind = "VRTDataset") {
    writeVrt(folder_ / "a.vrt", bands, "rasterXSize=\"10\" subClass=\"" + kind + "\"");
    return problemOf(folder_ / "a.vrt");
  };
  write("a.tif", geographicDem(10, 50, 0.1, 10, 10, flat));
  const std::string own = "<SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>";
  EXPECT_THAT(problemWith("<VRTRasterBand dataType=\"Float32\" band=\"1\">"
                          "<SimpleSource SourceFilename=\"../a.tif\"/></VRTRasterBand>"),
              HasSubstr("has 'SourceFilename', which is not allowed"));
  EXPECT_THAT(problemWith(bandOf(own + "<PixelFunctionType>sum</PixelFunctionType>")),
              HasSubstr("has 'PixelFunctionType', which is not allowed"));
  const auto reprojection = [](const std::string& transformer) {
    return "<VRTRasterBand dataType=\"Float32\" band=\"1\" subClass=\"VRTWarpedRasterBand\"/>"
           "<BlockXSize>10</BlockXSize><BlockYSize>10</BlockYSize><GDALWarpOptions>"
           "<SourceDataset relativeToVRT=\"1\">a.tif</SourceDataset><Transformer><GenImgProjTransformer>"
           "<SrcGeoTransform>10,0.1,0,50,0,-0.1</SrcGeoTransform>"
           "<DstGeoTransform>10,0.1,0,50,0,-0.1</DstGeoTransform>" +
           transformer +
           "</GenImgProjTransformer></Transformer><BandList><BandMapping src=\"1\" dst=\"1\"/></BandList>"
           "</GDALWarpOptions>";
  };
  const std::string by_system =
      "<ReprojectTransformer><ReprojectionTransformer><SourceSRS>EPSG:4326</SourceSRS>"
      "<TargetSRS>EPSG:4326</TargetSRS></ReprojectionTransformer></ReprojectTransformer>";
  EXPECT_EQ(problemWith(reprojection(by_system), "VRTWarpedDataset"), "");
  EXPECT_THAT(problemWith(reprojection("<SrcRPCTransformer><RPCTransformer><DEMPath>/etc/hostname</DEMPath>"
                                       "</RPCTransformer></SrcRPCTransformer>")),
              HasSubstr("has 'SrcRPCTransformer', which is not allowed"));
}

TEST_F(TerrainFileTest, FilesThatGdalReadsWithAnotherAreRefusedIfTheyNameServers) {
  const std::string server =
      "<GDAL_WMS><Service name=\"WMS\"><Version>1.1.1</Version><ServerUrl>http://127.0.0.1:1/?</ServerUrl>"
      "<Layers>a</Layers></Service><DataWindow><UpperLeftX>10</UpperLeftX><UpperLeftY>50</UpperLeftY>"
      "<LowerRightX>11</LowerRightX><LowerRightY>49</LowerRightY><SizeX>10</SizeX><SizeY>10</SizeY>"
      "</DataWindow><BandsCount>1</BandsCount></GDAL_WMS>";
  std::ofstream(folder_ / "server.xml") << server;
  writeVrt(folder_ / "a.vrt",
           bandOf("<SourceFilename relativeToVRT=\"1\">server.xml</SourceFilename>"
                  "<SourceProperties RasterXSize=\"10\" RasterYSize=\"10\" DataType=\"Float32\"/>"));
  EXPECT_THAT(problemOf(folder_ / "a.vrt"),
              AllOf(HasSubstr("server.xml: cannot be read as an elevation file"), HasSubstr("WMS")));

  const std::string file = write("a.tif", geographicDem(10, 50, 0.1, 10, 10, flat));
  for (const char* sidecar : {"a.tif.msk", "a.tif.ovr", "A.TIF.MSK", "a.tif.msk.ovr"}) {
    std::ofstream(folder_ / sidecar) << server;
    EXPECT_THAT(problemOf(file), AllOf(HasSubstr(sidecar), HasSubstr("is not a GeoTIFF"))) << sidecar;
    std::filesystem::remove(folder_ / sidecar);
  }
  write("a.tif.msk", geographicDem(10, 50, 0.1, 10, 10, flat));
  EXPECT_EQ(problemOf(file), "");
  std::ofstream(file + ".aux.xml") << "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">"
                                      "/vsicurl/http://127.0.0.1:1/o.tif</MDI></Metadata></PAMDataset>";
  EXPECT_THAT(problemOf(file), HasSubstr("its metadata names a file of overviews, '/vsicurl/http"));
}

/// A GeoTIFF without values, in square blocks. @param size  posts along each axis  @return its name
std::string writeBlocks(const std::string& path, int edge, int bands, int size = 100) {
  GDALAllRegister();
  const std::string pixels = std::to_string(edge);
  const std::string x = "BLOCKXSIZE=" + pixels, y = "BLOCKYSIZE=" + pixels;
  std::vector<const char*> options{
      "TILED=YES", "SPARSE_OK=TRUE", "COMPRESS=DEFLATE", "INTERLEAVE=PIXEL", x.c_str(), y.c_str(), nullptr};
  const std::unique_ptr<GDALDataset> dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), size, size, bands, GDT_Float32, const_cast<char**>(options.data())));
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  std::array<double, 6> corners{10, 1.0 / size, 0, 50, 0, -1.0 / size};
  dataset->SetSpatialRef(&wgs84);
  dataset->SetGeoTransform(corners.data());
  return path;
}

TEST_F(TerrainFileTest, BlocksThatTakeMuchMemoryAreRefused) {
  EXPECT_THAT(problemOf(writeBlocks(folder_ / "tile.tif", 16384, 1)),
              AllOf(HasSubstr("tile.tif: its blocks of 16384 x 16384 values take 1024 MiB each"),
                    HasSubstr("allowed 256 MiB")));
  const std::string bands = writeBlocks(folder_ / "bands.tif", 256, 3000);
  EXPECT_LT(std::filesystem::file_size(bands), 1U << 20);
  EXPECT_THAT(problemOf(bands), HasSubstr("its blocks of 256 x 256 values in 3000 bands take 750 MiB each"));
  EXPECT_EQ(problemOf(writeBlocks(folder_ / "few.tif", 256, 3)), "");

  const std::string file = folder_ / "a.vrt";
  writeVrt(file, bandOf("<SourceFilename relativeToVRT=\"1\">tile.tif</SourceFilename>"));
  EXPECT_THAT(problemOf(file), AllOf(HasSubstr("a.vrt: source "), HasSubstr("tile.tif: its blocks")));
}

TEST_F(TerrainFileTest, TheEpsgCodeOfAnotherKindOfSystemIsRefused) {
  const std::string file = folder_ / "code.tif";
  std::filesystem::copy_file(
      test::sourceFile("tests/fuzz/regressions/terrain_tif/code_of_a_geocentric_system"), file);
  EXPECT_THAT(problemOf(file), AllOf(HasSubstr("code.tif: its coordinate reference system"),
                                     HasSubstr("EPSG:4342, which is of another kind of system")));
}

TEST_F(TerrainFileTest, SLOW_VeryLargeFileIsDescribedByAPart) {
  const TerrainFileInfo info = Terrain::describe(writeBlocks(folder_ / "large.tif", 512, 1, 30000));
  EXPECT_EQ(info.rows, 30000);
  EXPECT_EQ(info.highest_m, 0);
  EXPECT_THAT(info.notes, Contains(HasSubstr("its range and voids are those of 8896 of its 30000 rows")));
}

TEST_F(TerrainFileTest, AVrtThatNamesVrtsManyTimesIsReadOnce) {
  write("0.tif", geographicDem(10, 50, 0.1, 10, 10, flat));
  const auto vrt = [&](int level, int sources) {
    const std::string file = folder_ / std::to_string(level) + ".vrt";
    const std::string source = "<SourceFilename relativeToVRT=\"1\">" + std::to_string(level - 1) +
                               (level == 1 ? ".tif" : ".vrt") + "</SourceFilename>";
    std::string bands;
    for (int k = 0; k < sources; ++k) bands += bandOf(source);
    writeVrt(file, bands);
    return file;
  };
  vrt(1, 300);
  vrt(2, 300);
  vrt(3, 300);
  EXPECT_EQ(sourcesOfVrt(vrt(4, 300)), std::set<std::filesystem::path>{folder_ / "0.tif"});
}

TEST_F(TerrainFileTest, ATruncatedFileIsAnErrorAndNotSeaLevel) {
  const auto path = write("a.tif", geographicDem(10, 50, 0.001, 1000, 1000, flat));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THAT(problemOf(path), AllOf(HasSubstr("a.tif: rows "), HasSubstr("cannot be read")));
  EXPECT_THROW(Terrain::describe(path), Error);
}

TEST_F(TerrainFileTest, FileWithoutGeoreferenceIsRefused) {
  DemFile file = geographicDem(10, 50, 0.1, 10, 10, flat);
  file.crs = "";
  EXPECT_THAT(problemOf(write("a.tif", file)), HasSubstr("has no coordinate reference system"));
  file.transform = {};
  EXPECT_THAT(problemOf(write("b.tif", file)), HasSubstr("has no georeference"));
  file.transform = {0, 1, 0, 0, 0, -1};
  file.crs = "LOCAL_CS[\"building site\",UNIT[\"metre\",1]]";
  EXPECT_THAT(problemOf(write("c.tif", file)), HasSubstr("cannot be brought to latitude and longitude"));
}

TEST_F(TerrainFileTest, ComplexNumbersAreNoHeights) {
  GDALAllRegister();
  const std::string path = folder_ / "a.tif";
  GDALClose(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 4, 4, 1, GDT_CFloat32, nullptr));
  EXPECT_THAT(problemOf(path), HasSubstr("complex numbers"));
}

TEST_F(TerrainFileTest, InvalidBoxIsRefused) {
  for (const GeoBox& box : {GeoBox{1, 0, 0, 1}, GeoBox{0, 91, 0, 1}, GeoBox{0, 1, 10, 9},
                            GeoBox{0, 1, 0, 361}, GeoBox{std::nan(""), 1, 0, 1}}) {
    EXPECT_THROW(load({}, box), Error);
  }
}

TEST_F(TerrainFileTest, ARegionOfTooManyPostsIsRefusedBeforeItIsRead) {
  std::ofstream(folder_ / "world.vrt")
      << R"(<VRTDataset rasterXSize="1296000" rasterYSize="648000"><SRS>EPSG:4326</SRS>
    <GeoTransform>-180, 0.000277777777777778, 0, 90, 0, -0.000277777777777778</GeoTransform>
    <VRTRasterBand dataType="Int16" band="1"/></VRTDataset>)";
  EXPECT_THAT(test::errorOf([&] {
                load({folder_ / "world.vrt"}, {-80, 80, -180, 180});
              }),
              AllOf(HasSubstr("world.vrt"), HasSubstr("posts"), HasSubstr("smaller region")));
}

}  // namespace
}  // namespace emscape::scenario
