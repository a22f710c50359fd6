/// Vertical datum and unit of elevation files: stated, by format, by name, by key, assumed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/scenario/terrain/terrain.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr GeoBox kBox{49, 50, 10, 11};
const double kUndulation_m = geoidUndulation_m(49.5, 10.5);

class TerrainDatum : public testing::Test {
 protected:
  /// A file of 100 everywhere.
  std::string write(const std::string& name, const std::string& crs = "EPSG:4326",
                    const std::string& unit = "", bool is_geotiff_1_0 = false) const {
    test::DemFile file = test::geographicDem(10, 50, 0.1, 10, 10, [](double, double) { return 100; });
    file.crs = crs;
    file.unit = unit;
    file.is_geotiff_1_0 = is_geotiff_1_0;
    file.write(folder_ / name);
    return folder_ / name;
  }
  static TerrainPtr load(const std::string& file, const TerrainFileKeys& keys = {}) {
    TerrainSpec spec;
    spec.files = {file};
    spec.keys = {keys};
    return Terrain::load(spec, kBox);
  }
  static double heightOf(const std::string& file, const TerrainFileKeys& keys = {}) {
    return load(file, keys)->heightMsl_m(49.5, 10.5);
  }
  static TerrainFileKeys datum(VerticalDatum datum) {
    TerrainFileKeys keys;
    keys.vertical_datum = datum;
    return keys;
  }
  static TerrainFileKeys unit(HeightUnit unit) {
    TerrainFileKeys keys;
    keys.height_unit = unit;
    return keys;
  }

  test::TemporaryFolder folder_;
};

TEST_F(TerrainDatum, IsThatWhichTheFileStates) {
  for (const bool is_old : {false, true}) {
    EXPECT_EQ(heightOf(write("a.tif", "EPSG:4326+5773", "", is_old)), 100) << "EGM96";
    EXPECT_THAT(load(folder_ / "a.tif")->warnings(), IsEmpty());
    EXPECT_EQ(heightOf(write("b.tif", "EPSG:4326+5703", "", is_old)), 100) << "NAVD88";
    EXPECT_THAT(load(folder_ / "b.tif")->warnings(),
                ElementsAre(HasSubstr("above NAVD88 are taken as above EGM96")));
    EXPECT_THAT(Terrain::describe(write("c.tif", "EPSG:4326+3855", "", is_old)).vertical_datum,
                HasSubstr("EGM2008 (stated by the file: EGM2008 height)"));
  }
  EXPECT_NEAR(heightOf(write("d.tif", "EPSG:4979")), 100 - kUndulation_m, 0.01);
  EXPECT_THAT(load(folder_ / "d.tif")->warnings(), IsEmpty());
}

TEST_F(TerrainDatum, OfASystemOfACountryIsMeanSeaLevelWithAWarning) {
  EXPECT_EQ(heightOf(write("a.tif", "EPSG:4326+7837")), 100);
  EXPECT_THAT(load(folder_ / "a.tif")->warnings(),
              ElementsAre(HasSubstr("states heights of 'DHHN2016 height', which are taken as above EGM96")));
}

TEST_F(TerrainDatum, NotStatedIsAssumedWithItsEffect) {
  const std::string expected = fmt::format(
      "states no vertical datum and no unit: its heights are taken as metres above EGM96; if they are above "
      "the ellipsoid, the "
      "ground is "
      "{:.1f} m too high there. `vertical_datum: egm96`",
      kUndulation_m);
  EXPECT_THAT(load(write("a.tif"))->warnings(), ElementsAre(HasSubstr(expected)));
  EXPECT_THAT(Terrain::describe(folder_ / "a.tif").warnings, ElementsAre(HasSubstr(expected)));
  TerrainFileKeys keys = datum(VerticalDatum::egm96);
  EXPECT_THAT(load(folder_ / "a.tif", keys)->warnings(),
              ElementsAre(HasSubstr("states no unit: its heights are taken as metres; `height_unit: m`")));
  keys.height_unit = HeightUnit::m;
  EXPECT_THAT(load(folder_ / "a.tif", keys)->warnings(), IsEmpty());
  EXPECT_NEAR(heightOf(folder_ / "a.tif", datum(VerticalDatum::ellipsoid)), 100 - kUndulation_m, 0.01);
}

TEST_F(TerrainDatum, IsKnownByTheNameOfAProduct) {
  EXPECT_NEAR(heightOf(write("32_11_arcticdem_mosaic.tif")), 100 - kUndulation_m, 0.01);
  EXPECT_THAT(Terrain::describe(write("Copernicus_DSM_COG_10_N49_00_E010_00_DEM.tif")).vertical_datum,
              "EGM2008 (by its name: Copernicus DEM)");
  EXPECT_THAT(Terrain::describe(write("ASTGTMV003_N49E010_dem.tif")).vertical_datum,
              "EGM96 (by its name: ASTER GDEM)");
}

TEST_F(TerrainDatum, Egm2008WithoutItsGridIsEgm96WithAWarningUnlessAKeyAsksForIt) {
  const std::string file = write("Copernicus_DSM_COG_10_N49_00_E010_00_DEM.tif");
  const TerrainPtr terrain = load(file);
  EXPECT_NEAR(terrain->heightMsl_m(49.5, 10.5), 100, 2);
  if (terrain->heightMsl_m(49.5, 10.5) != 100) GTEST_SKIP() << "the grid of EGM2008 is installed";
  EXPECT_THAT(terrain->warnings(), ElementsAre(HasSubstr("are taken as above EGM96, since the grid")));
  EXPECT_THAT(test::errorOf([&] { load(file, datum(VerticalDatum::egm2008)); }, ErrorCode::bad_input),
              HasSubstr("geoid grid, which was not found"));
}

TEST_F(TerrainDatum, AKeyThatContradictsTheFileIsAnErrorThatNamesBoth) {
  EXPECT_THAT(test::errorOf([&] { load(write("a.tif", "EPSG:4979"), datum(VerticalDatum::egm96)); },
                            ErrorCode::bad_input),
              AllOf(HasSubstr("a.tif: 'vertical_datum: egm96' of the scenario contradicts the file"),
                    HasSubstr("the ellipsoid ('ellipsoidal height of WGS 84')")));
  TerrainSpec spec;
  spec.files = {write("b.tif", "EPSG:4326+5773")};
  spec.locations = {{"s.yaml", 7, 12}};
  spec.vertical_datum = VerticalDatum::ellipsoid;
  EXPECT_THAT(test::errorOf([&] { Terrain::load(spec, kBox); }, ErrorCode::bad_input),
              AllOf(HasSubstr("s.yaml:7:12"), HasSubstr("EGM96 ('EGM96 height')")));
}

TEST_F(TerrainDatum, OfSeveralFilesMayDiffer) {
  test::DemFile west = test::geographicDem(10, 50, 0.1, 5, 10, [](double, double) { return 100; });
  test::DemFile east =
      test::geographicDem(10.5, 50, 0.1, 5, 10, [](double latitude_deg, double longitude_deg) {
        return 100 + geoidUndulation_m(latitude_deg, longitude_deg);
      });
  west.crs = "EPSG:4326+5773";
  east.crs = "EPSG:4979";
  west.write(folder_ / "west.tif");
  east.write(folder_ / "east.tif");
  TerrainSpec spec;
  spec.files = {folder_ / "west.tif", folder_ / "east.tif"};
  const TerrainPtr terrain = Terrain::load(spec, kBox);
  for (const double longitude_deg : {10.05, 10.3, 10.47, 10.5, 10.53, 10.8})
    EXPECT_NEAR(terrain->heightMsl_m(49.5, longitude_deg), 100, 0.02) << longitude_deg;
  EXPECT_EQ(terrain->uncoveredFraction(), 0);
}

TEST_F(TerrainDatum, DepthsAreRefused) {
  EXPECT_THAT(test::errorOf([&] { load(write("a.tif", "EPSG:4326+5715")); }, ErrorCode::bad_input),
              HasSubstr("states depths, downwards ('MSL depth')"));
}

TEST_F(TerrainDatum, UnitIsThatOfTheKeyWhereTheFileHasNone) {
  EXPECT_NEAR(heightOf(write("a.tif"), unit(HeightUnit::ft)), 30.48, 1e-4);
  EXPECT_NEAR(heightOf(folder_ / "a.tif", unit(HeightUnit::us_ft)), 100 * 1200 / 3937.0, 1e-4);
  EXPECT_EQ(heightOf(folder_ / "a.tif", unit(HeightUnit::m)), 100);
}

TEST_F(TerrainDatum, UnitThatContradictsTheFileIsAnError) {
  EXPECT_THAT(test::errorOf([&] { load(write("a.tif", "EPSG:4326", "m"), unit(HeightUnit::ft)); },
                            ErrorCode::bad_input),
              HasSubstr("'height_unit: ft' of the scenario contradicts the file, which states 'm'"));
  EXPECT_NEAR(heightOf(write("b.tif", "EPSG:4326", "ft"), unit(HeightUnit::ft)), 30.48, 1e-4);
}

TEST_F(TerrainDatum, UnitOfTheVerticalSystemIsUsed) {
  EXPECT_NEAR(heightOf(write("a.tif", "EPSG:4326+6360")), 100 * 1200 / 3937.0, 1e-3);
}

TEST_F(TerrainDatum, FeetOfTheCoordinatesDoNotWarnIfTheUnitIsStated) {
  test::DemFile file;
  file.crs = "EPSG:2231";  // NAD83 / Colorado North (ftUS)
  file.columns = file.rows = 10;
  file.transform = {3000000, 1000, 0, 1300000, 0, -1000};
  file.value = [](int, int) { return 5000; };
  file.write(folder_ / "a.tif");
  EXPECT_THAT(Terrain::describe(folder_ / "a.tif").warnings,
              Contains(HasSubstr("`height_unit: us_ft` of the file in the scenario states it")));
  const TerrainFileInfo info = Terrain::describe(folder_ / "a.tif", true, unit(HeightUnit::us_ft));
  EXPECT_NEAR(info.highest_m, 5000 * 1200 / 3937.0, 1e-2);
  EXPECT_THAT(info.warnings, testing::Not(Contains(HasSubstr("height_unit"))));
}

}  // namespace
}  // namespace emscape::scenario
