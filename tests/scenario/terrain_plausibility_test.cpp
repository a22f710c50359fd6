/// Heights that cannot be right: other byte orders, units and encodings; each remedy is tried.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>

#include "emscape/scenario/terrain/terrain.h"
#include "tests/scenario/dem_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr GeoBox kBox{49.2, 49.8, 10.2, 10.8};

class ImplausibleTerrain : public testing::Test {
 protected:
  static TerrainPtr load(const std::string& file, const TerrainFileKeys& keys = {}) {
    TerrainSpec spec;
    spec.files = {file};
    spec.keys = {keys};
    return Terrain::load(spec, kBox);
  }
  static std::string problemOf(const std::string& file, const TerrainFileKeys& keys = {}) {
    return test::errorOf([&] { load(file, keys); }, ErrorCode::bad_input);
  }
  /// 250 m in the west, 350 m in the east, in another byte order.
  std::string swappedTile() const {
    const std::string file = folder_ / "N49E010.hgt";
    test::writeHgt(file, 1201, [](int column, int) {
      const int height_m = 250 + column / 12;
      return static_cast<std::int16_t>(static_cast<std::uint16_t>(height_m << 8 | height_m >> 8));
    });
    return file;
  }
  /// A plain of these values, with a unit and a datum.
  std::string plain(const std::function<double(int column, int row)>& value,
                    const std::string& unit = "m") const {
    test::DemFile file = test::geographicDem(10, 50, 0.01, 100, 100, [](double, double) { return 0.0; });
    file.value = value;
    file.crs = unit.empty() ? "EPSG:4326" : "EPSG:4326+5773";
    file.unit = unit;
    file.write(folder_ / "a.tif");
    return folder_ / "a.tif";
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImplausibleTerrain, OtherByteOrderIsRefusedWithTheKeyThatReadsIt) {
  const std::string file = swappedTile();
  EXPECT_THAT(problemOf(file), AllOf(HasSubstr("in the other byte order"), HasSubstr("`swap_bytes: true`")));
  EXPECT_THAT(Terrain::describe(file).warnings, ElementsAre(HasSubstr("in the other byte order")));
  TerrainFileKeys keys;
  keys.swap_bytes = true;
  EXPECT_NEAR(load(file, keys)->heightMsl_m(49.5, 10.5), 300, 0.1);
  EXPECT_THAT(load(file, keys)->warnings(), IsEmpty());
  test::writeHgt(file, 1201, [](int column, int) { return 250 + column / 12; });
  EXPECT_THAT(problemOf(file, keys), HasSubstr("leave out `swap_bytes`"));
  EXPECT_NEAR(load(file)->heightMsl_m(49.5, 10.5), 300, 0.1);
}

TEST_F(ImplausibleTerrain, RealNumbersInTheOtherByteOrderAreRefusedWithTheKeyThatReadsThem) {
  std::string bytes;
  for (int n = 0; n < 121 * 121; ++n) {
    const auto height_m = static_cast<float>(250 + n % 121);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &height_m, sizeof bits);
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(bits >> shift & 0xFFU);
  }
  folder_.write("a.hdr",
                "ncols 121\nnrows 121\nxllcenter 10\nyllcenter 49\ncellsize 0.00833333333\nbyteorder "
                "LSBFIRST\n");
  folder_.write("a.prj",
                "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]");
  const std::string file = folder_.write("a.flt", bytes);
  EXPECT_THAT(problemOf(file), AllOf(HasSubstr("nearly 0"), HasSubstr("`swap_bytes: true`")));
  TerrainFileKeys keys;
  keys.swap_bytes = true;
  EXPECT_NEAR(load(file, keys)->heightMsl_m(49.5, 10.5), 310, 0.1);
}

TEST_F(ImplausibleTerrain, GridWhoseRowsAreLongerThanItsHeaderSaysIsRefused) {
  const auto grid = [&](int ncols) {
    std::string text = fmt::format(
        "ncols {}\nnrows 100\nxllcorner 10\nyllcorner 49\ncellsize 0.01\nNODATA_value -9999\n", ncols);
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 100; ++column) text += fmt::format("{} ", 100 + column);
      text += "\n";
    }
    return folder_.write("a.asc", text);
  };
  TerrainFileKeys keys;
  keys.crs = "EPSG:4326";
  EXPECT_THAT(problemOf(grid(93), keys),
              HasSubstr("has 10000 values, 100 in its first line, but 'ncols' 93 and 'nrows' 100 make 9300"));
  const std::string whole = grid(100);
  EXPECT_NEAR(load(whole, keys)->heightMsl_m(49.5, 10.505), 150, 0.1);
  std::string wrapped = test::readFile(whole);
  std::replace(wrapped.begin() + 90, wrapped.end(), '\n', ' ');
  for (std::size_t at = 90; at + 600 < wrapped.size(); at += 600) wrapped[wrapped.find(' ', at + 590)] = '\n';
  const std::string file = folder_.write("b.asc", wrapped);
  EXPECT_NEAR(load(file, keys)->heightMsl_m(49.5, 10.505), 150, 0.1) << "lines of 150 values";
  test::writeZip(folder_ / "c.zip", {{"c.asc", grid(93)}});
  EXPECT_THAT(problemOf(folder_ / "c.zip", keys), HasSubstr("'ncols' 93 and 'nrows' 100 make 9300"));
}

TEST_F(ImplausibleTerrain, NumbersThatAreNearlyZeroByThemselvesAreHeights) {
  const std::string file = plain([](int column, int row) {
    return column < 60 ? 1e-24 * std::exp(-0.1 * column) * (1 + row) : 300.0;  // tails of a filter
  });
  EXPECT_EQ(load(file)->heightMsl_m(49.5, 10.75), 300);
  EXPECT_NEAR(load(file)->heightMsl_m(49.5, 10.3), 0, 1e-6);
}

TEST_F(ImplausibleTerrain, UnitOfHeightsInAProjectionFileOfArcInfoIsUsed) {
  const std::string file = folder_.write(
      "a.asc", "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 49\ncellsize 0.5\n1000 1000\n1000 1000\n");
  folder_.write("a.prj",
                "Projection GEOGRAPHIC\nDatum WGS84\nSpheroid WGS84\nUnits DD\nZunits FEET\nParameters\n");
  EXPECT_NEAR(load(file)->heightMsl_m(49.5, 10.5), 304.8, 0.1);
}

TEST_F(ImplausibleTerrain, HeightsThatAreNotOnEarthAreRefusedWithTheUnitsThatFit) {
  const std::string file = plain([](int column, int) { return 25000 + 10 * column; }, "");
  EXPECT_THAT(problemOf(file),
              AllOf(HasSubstr("(100 %) are not on earth (-11500 to 9000 m)"), HasSubstr("the highest 25"),
                    HasSubstr("`height_unit: cm` or dm or ft"), HasSubstr("`implausible: void`")));
  TerrainFileKeys keys;
  keys.height_unit = HeightUnit::cm;
  EXPECT_NEAR(load(file, keys)->heightMsl_m(49.5, 10.505), 255, 0.1);
  keys.height_unit.reset();
  keys.implausible = ImplausibleHeights::as_void;
  EXPECT_TRUE(std::isnan(load(file, keys)->heightMsl_m(49.5, 10.505)));
}

TEST_F(ImplausibleTerrain, FewHeightsThatAreNotOnEarthAreVoidWithAWarning) {
  const std::string spikes = plain([](int column, int row) {
    return column == 50 && row >= 40 && row < 45 ? 12000.0 + 500 * row : 100.0;
  });
  EXPECT_THAT(load(spikes)->warnings(),
              ElementsAre(AllOf(HasSubstr("5 of"), HasSubstr("not on earth"), HasSubstr("; void"))));
  const std::string fill = plain([](int column, int) { return column < 50 ? 100.0 : 32767.0; });
  EXPECT_THAT(load(fill)->warnings(),
              ElementsAre(HasSubstr("of 32767 m are not on earth (-11500 to 9000 m): a fill value")));
  EXPECT_EQ(load(fill)->heightMsl_m(49.5, 10.3), 100);
  EXPECT_TRUE(std::isnan(load(fill)->heightMsl_m(49.5, 10.7)));
}

TEST_F(ImplausibleTerrain, TheHighestAndLowestGroundOfTheEarthIsPlausible) {
  for (const double base_m : {-430.0, 0.0, 8700.0}) {
    const std::string file = plain([&](int column, int row) { return base_m + column + 0.5 * row; });
    EXPECT_THAT(load(file)->warnings(), IsEmpty()) << base_m;
  }
  // Flat and steep ground of whole metres has its bytes in order.
  for (const int step : {1, 40}) {
    test::writeHgt(folder_ / "N49E010.hgt", 1201, [&](int column, int row) {
      return step * static_cast<int>(10 + 9 * std::sin(column / 60.0) * std::cos(row / 50.0));
    });
    EXPECT_THAT(load(folder_ / "N49E010.hgt")->warnings(), IsEmpty()) << step;
  }
}

TEST_F(ImplausibleTerrain, TheBedOfASeaIsTold) {
  const std::string file = plain([](int column, int) { return 200 - 20.0 * column; });
  EXPECT_THAT(load(file)->warnings(), ElementsAre(AllOf(HasSubstr("are below -500 m, the lowest at -"),
                                                        HasSubstr("the bed of a sea"))));
}

}  // namespace
}  // namespace emscape::scenario
