/// Heights of mosaics: positions of posts, voids, precedence of files.
#include "emscape/scenario/terrain/terrain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "base/geodesy/geoid_grid.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "scenario/terrain/view.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using test::DemFile;
using test::geographicDem;
using test::geographicPointDem;

/// A surface that bilinear interpolation reproduces exactly.
double slope(double latitude_deg, double longitude_deg) {
  return 500 + 20 * latitude_deg + 10 * longitude_deg;
}
/// The same for a slope that continues across the antimeridian.
double slopeAcross180(double latitude_deg, double longitude_deg) {
  return slope(latitude_deg, longitude_deg < 0 ? longitude_deg + 360 : longitude_deg);
}
double flat(double, double) {
  return 100;
}

class TerrainTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const DemFile& file) const {
    file.write(folder_ / name);
    return folder_ / name;
  }

  test::TemporaryFolder folder_;
};

TerrainPtr load(const std::vector<std::string>& files, const GeoBox& box,
                VerticalDatum datum = VerticalDatum::egm96) {
  return Terrain::load({files, {}, datum}, box);
}

// --- the real files

/// Tiles of tests/data, and N44W072 in the encodings in which such tiles are distributed.
class ReferenceDem : public testing::Test {
 protected:
  const std::string tif_ = test::sourceFile("tests/data/dem/N44W072.tif");
  std::string hgt() const { return encoded("SRTMHGT", "N44W072.hgt"); }
  std::string dted() const { return encoded("DTED", "N44W072.dt1"); }

 protected:
  test::TemporaryFolder folder_;

 private:
  std::string encoded(const char* driver, const char* name) const {
    test::convertDem(tif_, driver, folder_ / name);
    return folder_ / name;
  }
};

TEST_F(ReferenceDem, ThreeEncodingsOfATileHaveIdenticalHeights) {
  const GeoBox box{44, 45, -72, -71};
  const TerrainPtr hgt = load({this->hgt()}, box);
  const TerrainPtr dted = load({this->dted()}, box);
  const TerrainPtr tif = load({tif_}, box);
  const auto expectSame = [&](double latitude_deg, double longitude_deg) {
    const double height_m = hgt->heightMsl_m(latitude_deg, longitude_deg);
    ASSERT_FALSE(std::isnan(height_m)) << latitude_deg << " " << longitude_deg;
    ASSERT_EQ(dted->heightMsl_m(latitude_deg, longitude_deg), height_m)
        << latitude_deg << " " << longitude_deg;
    ASSERT_EQ(tif->heightMsl_m(latitude_deg, longitude_deg), height_m)
        << latitude_deg << " " << longitude_deg;
  };
  for (int row = 0; row <= 1200; row += 5) {
    for (int column = 0; column <= 1200; column += 5) expectSame(44 + row / 1200.0, -72 + column / 1200.0);
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 50000; ++k) expectSame(44 + part(random), -72 + part(random));
  for (const TerrainPtr& terrain : {hgt, dted, tif}) {
    EXPECT_EQ(terrain->lowest_m(), 115);
    EXPECT_EQ(terrain->highest_m(), 1908);
    EXPECT_EQ(terrain->voidPosts(), 0);
    EXPECT_EQ(terrain->uncoveredFraction(), 0);
    EXPECT_NEAR(terrain->postSpacing_m(), 66.3, 0.1);
  }
}

TEST_F(ReferenceDem, PostsEqualBytesOfTheFile) {
  const std::string file = hgt();
  std::ifstream bytes(file, std::ios::binary);
  const TerrainPtr terrain = load({file}, {44, 45, -72, -71});
  for (int row : {0, 1, 599, 1199, 1200}) {
    for (int column : {0, 1, 600, 1200}) {
      bytes.seekg((row * 1201 + column) * 2);
      const int high = bytes.get(), low = bytes.get();
      EXPECT_EQ(terrain->heightMsl_m(45 - row / 1200.0, -72 + column / 1200.0), high * 256 + low)
          << row << " " << column;
    }
  }
}

TEST_F(ReferenceDem, VoidsAreNaNAndCounted) {
  // The tile without the posts below 150 m and a square of a summit, as DTED.
  const GeoBox box{44, 45, -72, -71};
  const TerrainPtr whole = load({tif_}, box);
  constexpr float kNull = -32767;
  int missing = 0;
  test::DemFile holes = test::geographicPointDem(
      -72, 45, 1 / 1200.0, 1201, 1201, [&](double latitude_deg, double longitude_deg) {
        const float height_m =
            whole->heightMsl_m(std::clamp(latitude_deg, 44.0, 45.0), std::clamp(longitude_deg, -72.0, -71.0));
        const bool is_summit = std::hypot(latitude_deg - 44.27, longitude_deg + 71.3) < 0.01;
        missing += height_m < 150 || is_summit;
        return height_m < 150 || is_summit ? kNull : height_m;
      });
  holes.nodata = kNull;
  const std::string tif = folder_ / "holes.tif", file = folder_ / "holes.dt1";
  holes.write(tif);
  test::convertDem(tif, "DTED", file);
  ASSERT_GT(missing, 1000);

  const TerrainPtr terrain = load({file}, box);
  EXPECT_EQ(terrain->voidPosts(), missing);
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  int voids = 0;
  for (int row = 0; row <= 1200; ++row) {
    for (int column = 0; column <= 1200; ++column) {
      voids += std::isnan(terrain->heightMsl_m(44 + row / 1200.0, -72 + column / 1200.0));
    }
  }
  EXPECT_EQ(voids, missing);
  EXPECT_EQ(Terrain::describe(file).void_posts, missing);
}

TEST_F(ReferenceDem, ABoxHoldsItsOwnPostsOnlyAndTheSameHeights) {
  const TerrainPtr whole = load({tif_}, {44, 45, -72, -71});
  const GeoBox box{44.2003, 44.3001, -71.6002, -71.4007};
  const TerrainPtr part = load({tif_}, box);
  ASSERT_EQ(part->view().count, 1);
  EXPECT_LT(part->view().rasters[0].columns, 0.2 * 1200 + 8);
  EXPECT_LT(part->view().rasters[0].rows, 0.1 * 1200 + 8);
  EXPECT_EQ(part->uncoveredFraction(), 0);
  for (double y = 0; y <= 1; y += 0.05) {
    for (double x = 0; x <= 1; x += 0.05) {
      const double latitude_deg = box.south_deg + y * (box.north_deg - box.south_deg);
      const double longitude_deg = box.west_deg + x * (box.east_deg - box.west_deg);
      EXPECT_EQ(part->heightMsl_m(latitude_deg, longitude_deg),
                whole->heightMsl_m(latitude_deg, longitude_deg));
    }
  }
}

// --- positions of posts

TEST_F(TerrainTest, AreaPostsLieAtPixelCentresAndReachHalfAPostFurther) {
  const auto file = write("a.tif", geographicDem(10, 50, 0.1, 10, 10, slope));
  const TerrainPtr terrain = load({file}, {49, 50, 10, 11});
  EXPECT_NEAR(terrain->heightMsl_m(49.95, 10.05), slope(49.95, 10.05), 1e-3);
  EXPECT_NEAR(terrain->heightMsl_m(49.37, 10.63), slope(49.37, 10.63), 1e-3);
  EXPECT_NEAR(terrain->heightMsl_m(50, 10), slope(49.95, 10.05), 1e-3) << "held beyond the outer post";
  EXPECT_NEAR(terrain->heightMsl_m(49.5, 11), slope(49.5, 10.95), 1e-3);
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(50.001, 10.5)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.5, 9.999)));
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
}

TEST_F(TerrainTest, PointPostsEndAtTheOuterPosts) {
  const auto file = write("a.tif", geographicPointDem(10, 50, 0.1, 11, 11, slope));
  const TerrainPtr terrain = load({file}, {49, 50, 10, 11});
  EXPECT_NEAR(terrain->heightMsl_m(50, 10), slope(50, 10), 1e-3);
  EXPECT_NEAR(terrain->heightMsl_m(49, 11), slope(49, 11), 1e-3);
  EXPECT_NEAR(terrain->heightMsl_m(49.123, 10.456), slope(49.123, 10.456), 1e-3);
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(50.01, 10.5)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.5, 11.01)));
}

TEST_F(TerrainTest, SouthUpAndTurnedRastersLieWhereTheirTransformSays) {
  DemFile south_up = geographicDem(10, 50, 0.1, 10, 10, slope);
  south_up.transform = {10, 0.1, 0, 49, 0, 0.1};
  south_up.value = [](int column, int row) { return slope(49.05 + 0.1 * row, 10.05 + 0.1 * column); };
  const TerrainPtr upright = load({write("south.tif", south_up)}, {49, 50, 10, 11});
  EXPECT_NEAR(upright->heightMsl_m(49.22, 10.81), slope(49.22, 10.81), 1e-3);

  // Columns run north-east, rows south-east.
  DemFile turned;
  turned.columns = turned.rows = 40;
  turned.transform = {10, 0.02, 0.02, 49.5, 0.02, -0.02};
  turned.value = [](int column, int row) {
    return slope(49.5 + 0.02 * (column + 0.5) - 0.02 * (row + 0.5), 10 + 0.02 * (column + row + 1));
  };
  const TerrainPtr diamond = load({write("turned.tif", turned)}, {49, 50, 10, 11.6});
  EXPECT_NEAR(diamond->heightMsl_m(49.5, 10.8), slope(49.5, 10.8), 2e-3);
  EXPECT_NEAR(diamond->heightMsl_m(49.91, 10.62), slope(49.91, 10.62), 2e-3);
  EXPECT_TRUE(std::isnan(diamond->heightMsl_m(49.9, 10.2))) << "outside the diamond";
}

TEST_F(TerrainTest, AThinStripAcrossTheMeridiansIsRefusedNotMadeDense) {
  DemFile strip;
  strip.columns = 6;
  strip.rows = 20000;
  strip.transform = {10, 1e-5, 1e-5, 49.5, 1e-5, -1e-5};
  strip.value = [](int, int) { return 100.0; };
  const std::string file = write("strip.tif", strip);
  EXPECT_THAT(test::errorOf(
                  [&] {
                    load({file}, {49, 50, 9.5, 10.5});
                  },
                  ErrorCode::bad_input),
              testing::HasSubstr("strip.tif: 8 x 20002 of its posts take "));
  EXPECT_NEAR(load({file}, {49.4995, 49.5001, 9.9999, 10.0005})->heightMsl_m(49.49988, 10.00019), 100, 1e-3);
}

TEST_F(TerrainTest, TheViewGivesTheSameHeightsAndTakesAnyTurnOfLongitude) {
  const auto file = write("a.tif", geographicDem(-85, 37, 0.01, 100, 100, slope));
  const TerrainPtr terrain = load({file}, {36, 37, -85, -84});
  const TerrainView view = terrain->view();
  for (double longitude_deg : {-84.37, -84.37 + 360, -84.37 - 360, -84.37 + 1080}) {
    EXPECT_NEAR(terrain->heightMsl_m(36.4, longitude_deg), slope(36.4, -84.37), 1e-3);
    EXPECT_EQ(view.heightAt(degToRad(36.4), degToRad(longitude_deg)),
              terrain->heightMsl_m(36.4, longitude_deg));
  }
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(std::nan(""), -84.5)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(36.4, std::nan(""))));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(36.4, INFINITY)));
}

// --- voids

TEST_F(TerrainTest, EveryKindOfVoidIsNaN) {
  DemFile file = geographicPointDem(0, 1, 0.1, 11, 11, flat);
  file.nodata = -9999;
  file.value = [](int column, int row) {
    if (row != 5) return 100.0;
    const double voids[] = {-9999, -32767, -32768, std::nan(""), 3e38, -3e38, INFINITY};
    return column < 7 ? voids[column] : 100.0;
  };
  const TerrainPtr terrain = load({write("a.tif", file)}, {0, 1, 0, 1});
  for (int column = 0; column < 7; ++column) {
    EXPECT_TRUE(std::isnan(terrain->heightMsl_m(0.5, 0.1 * column))) << column;
  }
  EXPECT_EQ(terrain->heightMsl_m(0.5, 0.7), 100);
  EXPECT_EQ(terrain->voidPosts(), 7);
  EXPECT_EQ(terrain->uncoveredFraction(), 0) << "a void is covered, its height is not known";
  EXPECT_EQ(terrain->highest_m(), 100);
}

TEST_F(TerrainTest, AVoidCornerCountsOnlyWithWeight) {
  DemFile file = geographicPointDem(0, 1, 0.1, 11, 11, slope);
  file.nodata = -1;
  file.value = [](int column, int row) {
    return column == 5 && row == 5 ? -1 : slope(1 - 0.1 * row, 0.1 * column);
  };
  const TerrainPtr terrain = load({write("a.tif", file)}, {0, 1, 0, 1});
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(0.5, 0.5)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(0.45, 0.45)));
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(0.5, 0.41)));
  EXPECT_NEAR(terrain->heightMsl_m(0.5, 0.4), slope(0.5, 0.4), 1e-3) << "a post beside a void";
  EXPECT_NEAR(terrain->heightMsl_m(0.45, 0.4), slope(0.45, 0.4), 1e-3) << "an edge of the void's cell";
  EXPECT_NEAR(terrain->heightMsl_m(0.6, 0.55), slope(0.6, 0.55), 1e-3);
}

// --- several files

TEST_F(TerrainTest, HeightsGoOnBetweenAreaTiles) {
  const auto west = write("w.tif", geographicDem(10, 50, 0.1, 10, 10, slope));
  const auto east = write("e.tif", geographicDem(11, 50, 0.1, 10, 10, slope));
  const auto south = write("s.tif", geographicDem(10, 49, 0.1, 20, 10, slope));
  const TerrainPtr terrain = load({west, east, south}, {48, 50, 10, 12});
  EXPECT_EQ(terrain->view().count, 1);
  for (double longitude_deg : {10.951, 10.98, 11.0, 11.03, 11.049}) {
    for (double latitude_deg : {48.97, 49.0, 49.02, 49.5}) {
      EXPECT_NEAR(terrain->heightMsl_m(latitude_deg, longitude_deg), slope(latitude_deg, longitude_deg),
                  1e-3);
    }
  }
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
}

TEST_F(TerrainTest, GeoreferencesRoundedInTheFileStillMeet) {
  const double step_deg = 0.000833333;  // 1/1200 in nine digits
  const auto west = write("w.tif", geographicDem(10, 50, step_deg, 1200, 20, slope));
  const auto east = write("e.tif", geographicDem(11, 50, step_deg, 1200, 20, slope));
  const TerrainPtr terrain = load({west, east}, {49.985, 49.995, 10.9, 11.1});
  EXPECT_EQ(terrain->view().count, 1);
  EXPECT_NEAR(terrain->heightMsl_m(49.99, 11), slope(49.99, 11), 1e-2);
}

TEST_F(TerrainTest, OfTilesThatShareAnEdgeTheFirstNamedIsBelievedUnlessVoid) {
  DemFile first = geographicPointDem(10, 50, 0.1, 11, 11, flat);
  first.nodata = -1;
  first.value = [](int column, int row) { return column == 10 && row == 5 ? -1 : 100; };
  const DemFile second = geographicPointDem(11, 50, 0.1, 11, 11, [](double, double) { return 200; });
  const auto a = write("a.tif", first), b = write("b.tif", second);
  const GeoBox box{49, 50, 10, 12};
  EXPECT_EQ(load({a, b}, box)->heightMsl_m(49.8, 11), 100);
  EXPECT_EQ(load({b, a}, box)->heightMsl_m(49.8, 11), 200);
  const TerrainPtr terrain = load({a, b}, box);
  EXPECT_EQ(terrain->heightMsl_m(49.5, 11), 200) << "void in the first";
  EXPECT_EQ(terrain->voidPosts(), 0);
  EXPECT_NEAR(terrain->heightMsl_m(49.8, 11.05), 150, 1e-3);
}

TEST_F(TerrainTest, TheFinestFileDecidesAndItsVoidsFallThrough) {
  const auto coarse = write("c.tif", geographicDem(10, 50, 0.1, 20, 20, flat));
  DemFile fine_file = geographicDem(10.5, 49.5, 0.01, 50, 50, flat);
  fine_file.nodata = -1;
  fine_file.value = [](int column, int row) { return column == 25 && row == 25 ? -1 : 300; };
  const auto fine = write("f.tif", fine_file);
  for (const std::vector<std::string>& files : {std::vector{coarse, fine}, std::vector{fine, coarse}}) {
    const TerrainPtr terrain = load(files, {48, 50, 10, 12});
    EXPECT_EQ(terrain->heightMsl_m(49.3, 10.7), 300);
    EXPECT_EQ(terrain->heightMsl_m(49.7, 10.2), 100);
    EXPECT_EQ(terrain->heightMsl_m(49.245, 10.755), 100) << "the void";
    EXPECT_EQ(terrain->voidPosts(), 0);
    EXPECT_NEAR(terrain->postSpacing_m(), 0.01 * 111.2e3 * std::cos(degToRad(49.25)), 10);
  }
}

TEST_F(TerrainTest, HeightsGoOnAtTheRimOfAFineFile) {
  const auto coarse = write("c.tif", geographicDem(10, 50, 0.1, 20, 20, slope));
  const auto fine = write("f.tif", geographicDem(10.53, 49.51, 0.01, 50, 50, slope));
  const TerrainPtr terrain = load({coarse, fine}, {48, 50, 10, 12});
  for (double longitude_deg = 10.4; longitude_deg < 11.2; longitude_deg += 0.0013) {
    ASSERT_NEAR(terrain->heightMsl_m(49.33, longitude_deg), slope(49.33, longitude_deg), 2e-3)
        << longitude_deg;
  }
}

TEST_F(TerrainTest, HeightsGoOnBetweenTilesOfDifferentSpacing) {
  // As in models whose columns thin out polewards: posts on the tile's north and west edge, none on the
  // others.
  DemFile north = geographicPointDem(10, 51, 0.02, 50, 50, slope);
  north.transform = {9.985, 0.03, 0, 51.01, 0, -0.02};
  north.value = [](int column, int row) { return slope(51 - 0.02 * row, 10 + 0.03 * column); };
  const auto northern = write("n.tif", north);
  const auto southern = write("s.tif", geographicPointDem(10, 50, 0.02, 75, 50, slope));
  const TerrainPtr terrain = load({northern, southern}, {49.1, 50.9, 10, 11.4});
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  for (double latitude_deg = 49.9; latitude_deg < 50.1; latitude_deg += 0.0017) {
    ASSERT_NEAR(terrain->heightMsl_m(latitude_deg, 10.777), slope(latitude_deg, 10.777), 2e-3)
        << latitude_deg;
  }
}

TEST_F(TerrainTest, TilesFarApartTakeNoMemoryBetweenThem) {
  const auto here = write("h.tif", geographicDem(10, 50, 0.001, 50, 50, slope));
  const auto there = write("t.tif", geographicDem(170, -49, 0.001, 50, 50, slope));
  const TerrainPtr terrain = load({here, there}, {-60, 60, 0, 180});
  ASSERT_EQ(terrain->view().count, 2);
  EXPECT_LE(terrain->view().rasters[0].columns, 52);
  EXPECT_NEAR(terrain->heightMsl_m(49.97, 10.02), slope(49.97, 10.02), 1e-2);
  EXPECT_NEAR(terrain->heightMsl_m(-49.02, 170.02), slope(-49.02, 170.02), 1e-2);
}

TEST_F(TerrainTest, AHoleBetweenFilesIsNotSeaLevel) {
  const auto west = write("w.tif", geographicDem(10, 50, 0.1, 10, 10, slope));
  const auto east = write("e.tif", geographicDem(12, 50, 0.1, 10, 10, slope));
  const TerrainPtr terrain = load({west, east}, {49, 50, 10, 13});
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(49.5, 11.5)));
  EXPECT_NEAR(terrain->uncoveredFraction(), 1 / 3., 0.01);
}

TEST_F(TerrainTest, AFileThatDoesNotMeetTheBoxIsNoError) {
  const auto file = write("a.tif", geographicDem(10, 50, 0.1, 10, 10, slope));
  const TerrainPtr terrain = load({file}, {0, 1, 100, 101});
  EXPECT_TRUE(std::isnan(terrain->heightMsl_m(0.5, 100.5)));
  EXPECT_EQ(terrain->uncoveredFraction(), 1);
  EXPECT_EQ(terrain->view().count, 0);
  EXPECT_TRUE(std::isnan(terrain->lowest_m()));
  EXPECT_EQ(load({}, {0, 1, 100, 101})->uncoveredFraction(), 1);
}

TEST_F(TerrainTest, CoverageIsThePartOfTheBoxWithPosts) {
  const auto file = write("a.tif", geographicDem(10, 50, 0.1, 10, 10, slope));
  const GeoBox coverage = load({file}, {49.5, 52, 8, 10.5})->coverage();
  EXPECT_NEAR(coverage.south_deg, 49.5, 1e-9);
  EXPECT_NEAR(coverage.north_deg, 50, 1e-9);
  EXPECT_NEAR(coverage.west_deg, 10, 1e-9);
  EXPECT_NEAR(coverage.east_deg, 10.5, 1e-9);
}

// --- round the globe

TEST_F(TerrainTest, ABoxAcrossTheAntimeridianJoinsTilesOfBothSides) {
  const auto east = write("e.tif", geographicDem(179, 1, 0.1, 10, 20, slopeAcross180));
  const auto west = write("w.tif", geographicDem(-180, 1, 0.1, 10, 20, slopeAcross180));
  const TerrainPtr terrain = load({east, west}, {-1, 1, 179, 181});
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  for (double longitude_deg : {179.5, 179.96, 180.0, 180.03, 180.7}) {
    EXPECT_NEAR(terrain->heightMsl_m(0.33, longitude_deg), slope(0.33, longitude_deg), 1e-3) << longitude_deg;
    EXPECT_NEAR(terrain->heightMsl_m(0.33, longitude_deg - 360), slope(0.33, longitude_deg), 1e-3)
        << longitude_deg;
  }
}

TEST_F(TerrainTest, FilesThatCountTo360AreFoundOnEitherSide) {
  const auto file = write("a.tif", geographicDem(270, 40, 0.1, 20, 20, slope));
  const TerrainPtr terrain = load({file}, {38.5, 39.5, -89.5, -88.5});
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
  EXPECT_NEAR(terrain->heightMsl_m(39.01, -89.02), slope(39.01, 270.98), 1e-3);
}

TEST_F(TerrainTest, AGlobalFileGoesOnAcrossItsOwnSeam) {
  const auto wave = [](double latitude_deg, double longitude_deg) {
    return 1000 + 500 * std::cos(degToRad(longitude_deg)) + latitude_deg;
  };
  const auto file = write("globe.tif", geographicDem(-180, 90, 1, 360, 180, wave));
  for (const GeoBox& box :
       {GeoBox{-10, 10, 170, 190}, GeoBox{-10, 10, -190, -170}, GeoBox{-90, 90, -180, 180}}) {
    const TerrainPtr terrain = load({file}, box);
    EXPECT_EQ(terrain->uncoveredFraction(), 0);
    for (double longitude_deg : {179.3, 179.8, 180.0, -179.7, -179.5}) {
      EXPECT_NEAR(terrain->heightMsl_m(3.3, longitude_deg), wave(3.3, longitude_deg), 0.05) << longitude_deg;
    }
  }
  const TerrainPtr globe = load({file}, {-90, 90, -180, 180});
  EXPECT_NEAR(globe->heightMsl_m(90, 12.5), wave(89.5, 12.5), 0.05);
  EXPECT_NEAR(globe->heightMsl_m(-90, 0), wave(-89.5, 0), 0.05);
}

// --- vertical datum

TEST_F(TerrainTest, EllipsoidalHeightsBecomeHeightsAboveMeanSeaLevel) {
  const auto file = write("a.tif", geographicPointDem(10, 50, 0.1, 11, 11, flat));
  const TerrainPtr terrain = load({file}, {49, 50, 10, 11}, VerticalDatum::ellipsoid);
  EXPECT_NEAR(terrain->heightMsl_m(49.3, 10.4), 100 - geoidUndulation_m(49.3, 10.4), 1e-3);
}

TEST_F(TerrainTest, HeightsAboveEgm2008GoByItsOwnGrid) {
  const auto file = write("a.tif", geographicPointDem(10, 50, 0.1, 11, 11, flat));
  const GeoBox box{49, 50, 10, 11};
  double expected_m = 0;
  try {
    expected_m = 100 + egm2008Grid({49, 50, 10, 11}).undulation_m(49.3, 10.4) - geoidUndulation_m(49.3, 10.4);
  } catch (const Error& missing) {
    const std::string message =
        test::errorOf([&] { load({file}, box, VerticalDatum::egm2008); }, ErrorCode::bad_input);
    EXPECT_THAT(message,
                testing::HasSubstr("heights above EGM2008 need its geoid grid, which was not found"));
    EXPECT_THAT(message, testing::HasSubstr("projsync --file us_nga_egm08_25"));
    GTEST_SKIP() << missing.message();
  }
  EXPECT_NEAR(load({file}, box, VerticalDatum::egm2008)->heightMsl_m(49.3, 10.4), expected_m, 1e-3);
}

}  // namespace
}  // namespace emscape::scenario
