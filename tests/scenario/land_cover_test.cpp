/// Land cover: class tables, rasters in each kind of projection, unknown codes, what a path reads of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include "emscape/base/units.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/clear_air/ground.h"
#include "scenario/terrain/view.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr GeoBox kBox{36.2, 36.6, -84.4, -84.0};
constexpr double kBorder_deg = -84.2;  ///< of the classes: west and east

class LandCoverFiles : public testing::Test {
 protected:
  /// A raster of whole numbers: `west` and `east` of the border, over a little more than the box.
  std::string writeCodes(const std::string& name, const std::string& crs, double west, double east) const {
    test::DemFile file;
    if (crs == "EPSG:4326") {
      file = test::geographicDem(-84.5, 36.7, 0.001, 600, 600, [&](double, double longitude_deg) {
        return longitude_deg < kBorder_deg ? west : east;
      });
    } else {
      file.crs = crs;
      const auto middle = test::projected(crs, 36.4, kBorder_deg);
      file.columns = file.rows = 1200;
      file.transform = {middle[0] - 60e3, 100, 0, middle[1] + 60e3, 0, -100};
      file.value = [=](int column, int) { return column < 600 ? west : east; };
    }
    file.write(folder_ / "codes.tif");
    return test::wholeNumbers(folder_ / "codes.tif", folder_ / name);
  }
  LandCoverSpec spec(const std::string& file, CoverTable classes) const { return {{file}, {}, classes, ""}; }
  std::string nameAt(const LandCover& cover, double latitude_deg, double longitude_deg) const {
    const int found = cover.classAt(latitude_deg, longitude_deg);
    return found < 0 ? "unknown" : cover.classes()[static_cast<std::size_t>(found)].name;
  }
  std::string writeTable(const std::string& text) const {
    std::ofstream(folder_ / "table.csv") << text;
    return folder_ / "table.csv";
  }

  test::TemporaryFolder folder_;
};

TEST(LandCoverTables, HaveEachCodeOnceAndHeightsOfTheRecommendation) {
  for (const CoverTable table : {CoverTable::worldcover, CoverTable::corine, CoverTable::nlcd}) {
    std::set<int> codes;
    for (const CoverClass& of : coverTable(table)) {
      EXPECT_TRUE(codes.insert(of.code).second) << of.code;
      EXPECT_THAT((std::set<double>{0, 10, 15, 20}), Contains(of.clutter_height_m)) << of.name;
      EXPECT_EQ(of.color >> 24, 255U);
      if (of.zone != CoverZone::land) {
        EXPECT_EQ(of.clutter_height_m, 0) << of.name;
      }
    }
  }
  EXPECT_EQ(coverTable(CoverTable::worldcover).size(), 11U);
  EXPECT_EQ(coverTable(CoverTable::corine).size(), 88U) << "44 classes, by grid code and by code";
  EXPECT_EQ(coverTable(CoverTable::nlcd).size(), 20U);
}

TEST_F(LandCoverFiles, OfDegreesMetresAndAlbersHaveTheirClassesWhereTheyLie) {
  const struct {
    const char* crs;
    CoverTable table;
    double west, east;
    const char *name_west, *name_east;
  } kCases[] = {{"EPSG:4326", CoverTable::worldcover, 10, 50, "tree cover", "built-up"},
                {"EPSG:32616", CoverTable::corine, 44, 311, "sea and ocean", "broad-leaved forest"},
                {"EPSG:5070", CoverTable::nlcd, 11, 24, "open water", "developed high intensity"}};
  for (const auto& each : kCases) {
    const LandCover cover(spec(writeCodes("a.tif", each.crs, each.west, each.east), each.table), kBox);
    EXPECT_EQ(nameAt(cover, 36.4, kBorder_deg - 0.02), each.name_west) << each.crs;
    EXPECT_EQ(nameAt(cover, 36.4, kBorder_deg + 0.02), each.name_east) << each.crs;
    EXPECT_EQ(nameAt(cover, 36.4, kBorder_deg + 0.02 + 360), each.name_east) << "another turn";
    EXPECT_EQ(nameAt(cover, 40, kBorder_deg), "unknown");
    EXPECT_THAT(cover.warnings(), IsEmpty()) << each.crs;
  }
}

TEST_F(LandCoverFiles, ReadCellsAtTheirOwnPlaces) {
  test::DemFile file =
      test::geographicDem(-84.5, 36.7, 0.01, 60, 60, [](double latitude_deg, double longitude_deg) {
        const bool is_even =
            (std::lround(latitude_deg * 100 - 0.5) + std::lround(longitude_deg * 100 - 0.5)) % 2 == 0;
        return is_even ? 10 : 80;
      });
  file.write(folder_ / "codes.tif");
  const LandCover cover(
      spec(test::wholeNumbers(folder_ / "codes.tif", folder_ / "a.tif"), CoverTable::worldcover), kBox);
  for (double latitude_deg = 36.2055; latitude_deg < 36.6; latitude_deg += 0.01) {
    for (double longitude_deg = -84.3955; longitude_deg < -84.0; longitude_deg += 0.01) {
      const bool is_even =
          (std::lround(std::floor(latitude_deg * 100)) + std::lround(std::floor(longitude_deg * 100))) % 2 ==
          0;
      EXPECT_EQ(nameAt(cover, latitude_deg, longitude_deg),
                is_even ? "tree cover" : "permanent water bodies");
    }
  }
}

TEST_F(LandCoverFiles, WithUnknownCodesSayThemWithTheirCounts) {
  const LandCover cover(spec(writeCodes("a.tif", "EPSG:4326", 10, 77), CoverTable::worldcover), kBox);
  EXPECT_THAT(cover.warnings(),
              Contains(AllOf(HasSubstr("codes that the table 'worldcover' does not have"), HasSubstr("77 ("),
                             HasSubstr("cells)"), HasSubstr("table: FILE.csv"))));
  EXPECT_EQ(nameAt(cover, 36.4, kBorder_deg + 0.02), "unknown");
  EXPECT_GT(cover.unknownCells(), 0);
}

TEST_F(LandCoverFiles, OfAnotherProductAreRefusedAndTheRemedyHelps) {
  const std::string file = writeCodes("a.tif", "EPSG:4326", 111, 311);
  EXPECT_THAT(test::errorOf([&] { LandCover(spec(file, CoverTable::worldcover), kBox); }),
              AllOf(HasSubstr("no code of the files within the area is in the table 'worldcover'"),
                    HasSubstr("corine")));
  EXPECT_EQ(nameAt(LandCover(spec(file, CoverTable::corine), kBox), 36.4, kBorder_deg + 0.02),
            "broad-leaved forest");
}

TEST_F(LandCoverFiles, WithoutASystemNameACommandThatStatesIt) {
  test::DemFile file =
      test::geographicDem(-84.5, 36.7, 0.001, 600, 600, [](double, double) { return 311.0; });
  file.crs = "";
  file.write(folder_ / "codes.tif");
  const std::string codes = test::wholeNumbers(folder_ / "codes.tif", folder_ / "a.tif");
  EXPECT_THAT(test::errorOf([&] { LandCover(spec(codes, CoverTable::corine), kBox); }),
              AllOf(HasSubstr("gdal_translate -a_srs EPSG:4326 " + codes + " COVER.tif"),
                    testing::Not(HasSubstr("crs:"))));
  const std::string command = "gdal_translate -q -a_srs EPSG:4326 " + codes + " " + (folder_ / "COVER.tif");
  if (std::system((command + " > /dev/null 2>&1").c_str()) != 0)
    GTEST_SKIP() << "gdal_translate is not installed";
  EXPECT_EQ(nameAt(LandCover(spec(folder_ / "COVER.tif", CoverTable::corine), kBox), 36.4, kBorder_deg),
            "broad-leaved forest");
}

TEST_F(LandCoverFiles, WithHeightsOrPicturesInPlaceOfCodesAreRefused) {
  test::geographicDem(-84.5, 36.7, 0.01, 60, 60, [](double, double) {
    return 10;
  }).write(folder_ / "heights.tif");
  EXPECT_THAT(test::errorOf([&] { LandCover(spec(folder_ / "heights.tif", CoverTable::nlcd), kBox); }),
              HasSubstr("holds real numbers, not codes of land cover"));
  test::writeColours(folder_ / "picture.tif", [](int, int) { return 255; });
  EXPECT_THAT(test::errorOf([&] { LandCover(spec(folder_ / "picture.tif", CoverTable::nlcd), kBox); }),
              HasSubstr("is a picture, not codes of land cover"));
}

TEST_F(LandCoverFiles, HaveTheClassesOfATableOfOnesOwn) {
  LandCoverSpec own = spec(writeCodes("a.tif", "EPSG:4326", 1, 2), CoverTable::worldcover);
  own.table = writeTable(
      "# "
      "mine\ncode,name,clutter_height_m,zone,land,color\n1,palms,7.5,land,woods,#00ff00\n2,lagoon,0,sea,,#"
      "0000ff\n");
  const LandCover cover(own, kBox);
  EXPECT_EQ(nameAt(cover, 36.4, kBorder_deg - 0.02), "palms");
  EXPECT_EQ(cover.classes()[1].color, 0xFFFF0000U);
}

TEST_F(LandCoverFiles, TablesOfSpreadsheetsHaveSemicolonsAndDecimalCommas) {
  const std::vector<CoverClass> classes = readCoverTable(
      writeTable("code;name;clutter_height_m;zone;land;color\n1;palms;7,5;land;woods;#00ff00\n"));
  ASSERT_EQ(classes.size(), 1u);
  EXPECT_EQ(classes[0].clutter_height_m, 7.5);
}

TEST_F(LandCoverFiles, TablesWithFaultsNameTheirPlaceAndRange) {
  const std::string header = "code,name,clutter_height_m,zone,land,color\n";
  const std::pair<std::string, std::string> kCases[] = {
      {"", "is empty"},
      {"code,name\n", "there is no column 'clutter_height_m'"},
      {header, "there is no class"},
      {header + "x,a,0,land,,#000000\n", "code 'x' is not a whole number from 0 to 65535"},
      {header + "1,a,200,land,,#000000\n", "clutter_height_m '200' is not within 0 to 100 m"},
      {header + "1,a,0,lake,,#000000\n", "zone 'lake' is not one of land, water, sea"},
      {header + "1,a,0,land,forest,#000000\n", "land 'forest' is not one of flatland"},
      {header + "1,a,0,land,,green\n", "color 'green' is not of the form #rrggbb"},
      {header + "1,a,0,land,,#000000\n1,b,0,land,,#000000\n", "code 1 has a row already"},
      {header + "1,a,0\n", "the row has 3 cells; the header has 6"}};
  for (const auto& [text, fault] : kCases)
    EXPECT_THAT(test::errorOf([&, &of = text] { readCoverTable(writeTable(of)); }), HasSubstr(fault)) << text;
}

/// Ground of a height, with a land cover or a surface model.
class TerrainWithCover : public LandCoverFiles {
 protected:
  TerrainSpec ground(double height_m) const {
    test::geographicDem(-84.6, 36.8, 0.01, 80, 80, [=](double, double) {
      return height_m;
    }).write(folder_ / "ground.tif");
    TerrainSpec spec;
    spec.files = {folder_ / "ground.tif"};
    return spec;
  }
  static float coverAt(const Terrain& terrain, double longitude_deg) {
    const auto ground_msl_m = static_cast<float>(terrain.heightMsl_m(36.4, longitude_deg));
    return terrain.view().coverAt(degToRad(36.4), degToRad(longitude_deg), ground_msl_m);
  }
};

TEST_F(TerrainWithCover, TakesWaterForSeaOnlyWhereItIsLow) {
  for (const auto& [height_m, expected] : {std::pair{1.0, propagation::kSeaCover}, {200.0, 0.0F}}) {
    TerrainSpec spec = ground(height_m);
    spec.land_cover = this->spec(writeCodes("a.tif", "EPSG:4326", 80, 10), CoverTable::worldcover);
    const TerrainPtr terrain = Terrain::load(spec, kBox);
    EXPECT_EQ(coverAt(*terrain, kBorder_deg - 0.05), expected);
    EXPECT_EQ(coverAt(*terrain, kBorder_deg + 0.05), 15) << "trees";
  }
}

TEST_F(TerrainWithCover, HasTheHeightOfTheSurfaceModelAsClutterAndNoNegativeOne) {
  test::geographicDem(-84.6, 36.8, 0.01, 80, 80, [](double, double longitude_deg) {
    return longitude_deg < kBorder_deg ? 112.5 : 98;
  }).write(folder_ / "surface.tif");
  TerrainSpec spec = ground(100);
  EXPECT_FALSE(Terrain::load(spec, kBox)->view().hasCover());
  spec.surface_files = {folder_ / "surface.tif"};
  const TerrainPtr terrain = Terrain::load(spec, kBox);
  EXPECT_FLOAT_EQ(coverAt(*terrain, kBorder_deg - 0.05), 12.5F);
  EXPECT_EQ(coverAt(*terrain, kBorder_deg + 0.05), 0);
}

TEST_F(TerrainWithCover, RefusesASurfaceModelThatIsNone) {
  TerrainSpec spec = ground(500);
  spec.surface_files = {folder_ / "surface.tif"};
  for (const double surface_m : {20.0, 480.0, 1700.0}) {
    test::geographicDem(-84.6, 36.8, 0.01, 80, 80, [&](double, double longitude_deg) {
      return longitude_deg < kBorder_deg || surface_m > 500 ? surface_m : 500;
    }).write(folder_ / "surface.tif");
    EXPECT_THAT(test::errorOf([&] { Terrain::load(spec, kBox); }, ErrorCode::bad_input),
                HasSubstr("the surface model ('surface_files') is"))
        << surface_m;
  }
  test::geographicDem(-84.6, 36.8, 0.01, 80, 80, [](double, double) {
    return 498.0;
  }).write(folder_ / "surface.tif");
  EXPECT_THAT(
      Terrain::load(spec, kBox)->warnings(),
      testing::Contains(HasSubstr("on average 2.0 m below the ground ('files'): trees and buildings")))
      << "models of one ground differ";
}

TEST(TerrainProfileWithCover, TellsTheSeaAndClutterByItAndByHeightsWhereItIsUnknown) {
  const double ranges_m[] = {0, 100, 200, 300};
  const float heights_m[] = {-3, 5, -3, 5}, cover_m[] = {15, propagation::kSeaCover, NAN, NAN};
  const propagation::TerrainProfile profile{ranges_m, heights_m, 4, cover_m};
  EXPECT_FALSE(profile.isSea(0)) << "land below mean sea level";
  EXPECT_TRUE(profile.isSea(1));
  EXPECT_TRUE(profile.isSea(2));
  EXPECT_FALSE(profile.isSea(3));
  EXPECT_EQ(profile.clutter_m(0, 7.0F), 15);
  EXPECT_EQ(profile.clutter_m(1, 7.0F), 0);
  EXPECT_EQ(profile.clutter_m(3, 7.0F), 7);
  EXPECT_FALSE((propagation::TerrainProfile{ranges_m, heights_m, 4}.hasCover(0)));
}

TEST(TerrainProfileWithCover, GivesTheModelsOfClearAirTheirZonesAndClutter) {
  using propagation::ClearAirZone;
  const double ranges_m[] = {0, 10e3, 20e3, 30e3};
  const float heights_m[] = {5, -3, 5, 5}, cover_m[] = {0, 15, propagation::kSeaCover, 20};
  const propagation::TerrainProfile with{ranges_m, heights_m, 4, cover_m}, without{ranges_m, heights_m, 4};
  // A post extends half way to its neighbours.
  EXPECT_NEAR(zonesOf(ClearAirZone::by_height, with).sea_fraction, 1.0 / 3, 1e-12);
  EXPECT_EQ(zonesOf(ClearAirZone::by_height, with).coast_distance_m[0], 15e3);
  EXPECT_EQ(zonesOf(ClearAirZone::by_height, without).coast_distance_m[0], 5e3);
  EXPECT_EQ(zonesOf(ClearAirZone::inland, with).sea_fraction, 0) << "a stated zone stays";
  const propagation::ClearAirGround ground{ClearAirZone::by_height, 10, 0};
  EXPECT_EQ(ground.clutterAt(with, 1), 15);
  EXPECT_EQ(ground.clutterAt(with, 2), 0);
  EXPECT_EQ(ground.clutterAt(with, 3), 20);
  EXPECT_EQ(ground.clutterAt(without, 3), 10);
}

}  // namespace
}  // namespace emscape::scenario
