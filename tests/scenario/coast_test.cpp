#include "scenario/map/coast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "base/geodesy/gdal_file.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

/// Writes the arrays of a file in the format of GMT.
class CoastWriter {
 public:
  explicit CoastWriter(const std::string& file) {
    gdal::prepare();
    dataset_.reset(GDALCreateMultiDimensional(GDALGetDriverByName("netCDF"), file.c_str(), nullptr, nullptr));
    group_.reset(GDALDatasetGetRootGroup(dataset_.get()));
  }
  void add(const char* name, const std::vector<int>& values) {
    const std::string dimension_name = std::string("size_of_") + name;
    const gdal::Dimension dimension(GDALGroupCreateDimension(group_.get(), dimension_name.c_str(), nullptr,
                                                             nullptr, values.size(), nullptr));
    GDALDimensionH dimensions[] = {dimension.get()};
    const gdal::ValueType type(GDALExtendedDataTypeCreate(GDT_Int32));
    const gdal::Array array(GDALGroupCreateMDArray(group_.get(), name, 1, dimensions, type.get(), nullptr));
    const GUInt64 begin = 0;
    const std::size_t count = values.size();
    EXPECT_TRUE(GDALMDArrayWrite(array.get(), &begin, &count, nullptr, nullptr, type.get(), values.data(),
                                 values.data(), count * sizeof(int)));
  }

 private:
  gdal::Dataset dataset_;
  gdal::Group group_;
};

/// Bins of 90 degrees; that of 0 to 90 north and east has an island of two lines, with a lake, and sea around
/// it.
std::string writeCoast(const test::TemporaryFolder& folder) {
  std::string file = folder / "binned_GSHHS_c.nc";
  CoastWriter writer(file);
  writer.add("N_bins_in_360_longitude_range", {4});
  writer.add("N_bins_in_180_degree_latitude_range", {2});
  // Of the south-western corner sea; the lower bits are of other corners.
  writer.add("Embedded_node_levels_in_a_bin", std::vector<int>(8, 0111));
  writer.add("N_segments_in_a_bin", {2, 0, 0, 0, 0, 0, 0, 0});
  writer.add("Id_of_first_segment_in_a_bin", std::vector<int>(8, 0));
  const auto packed = [](int points, int level) { return points << 9 | level << 6; };
  writer.add("Embedded_npts_levels_exit_entry_for_a_segment", {packed(5, 1), packed(5, 2)});
  writer.add("Id_of_first_point_in_a_segment", {0, 5});
  // In 1/65535 of 90 degrees: 20 to 70 degrees, and 40 to 50. As 16 bits with sign.
  const auto unit = [](double degrees) {
    return static_cast<int>(static_cast<short>(static_cast<int>(degrees / 90 * 65535 + 0.5)));
  };
  const int a = unit(20), b = unit(70), c = unit(40), d = unit(50);
  writer.add("Relative_longitude_from_SW_corner_of_bin", {a, b, b, a, a, c, d, d, c, c});
  writer.add("Relative_latitude_from_SW_corner_of_bin", {a, a, b, b, a, c, c, d, d, c});
  return file;
}

TEST(Coast, SeaAndLakesAreWaterAndIslandsLand) {
  const test::TemporaryFolder folder;
  const auto coast = Coast::read(writeCoast(folder), {10, 80, 10, 80});
  ASSERT_EQ(coast->lines().size(), 2U);
  EXPECT_EQ(coast->lines()[0].level, 1);
  EXPECT_EQ(coast->lines()[1].level, 2);
  EXPECT_NEAR(coast->lines()[0].points[1].longitude_deg, 70, 0.01);
  EXPECT_NEAR(coast->lines()[0].points[1].latitude_deg, 20, 0.01);
  EXPECT_TRUE(coast->isWater(5, 5));
  EXPECT_TRUE(coast->isWater(45, 10));
  EXPECT_TRUE(coast->isWater(45, 80));
  EXPECT_TRUE(coast->isWater(80, 45));
  EXPECT_FALSE(coast->isWater(30, 30));
  EXPECT_FALSE(coast->isWater(65, 65));
  EXPECT_TRUE(coast->isWater(45, 45)) << "the lake";
  EXPECT_FALSE(coast->isWater(-45, 45)) << "outside of the bins that were read";
}

TEST(Coast, WaterOnAGridIsThatOfItsPositions) {
  const test::TemporaryFolder folder;
  const auto coast = Coast::read(writeCoast(folder), {10, 80, 10, 80});
  constexpr int kColumns = 40, kRows = 30;  // from the north-west, 2 degrees apart, oblique
  const auto positionAt = [](int column, int row) {
    return GeodeticPosition{75.3 - 2 * row + 0.1 * column, 3.1 + 2 * column, 0};
  };
  const auto onGrid = [](const std::vector<GeodeticPosition>& line) {
    std::vector<GridPlace> places;
    for (const GeodeticPosition& at : line) {
      const double column = (at.longitude_deg - 3.1) / 2;
      places.push_back({column, (75.3 + 0.1 * column - at.latitude_deg) / 2});
    }
    return places;
  };
  const std::vector<std::uint8_t> water = waterOnGrid(*coast, kColumns, kRows, onGrid, positionAt);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const GeodeticPosition at = positionAt(column, row);
      EXPECT_EQ(water[static_cast<std::size_t>(row) * kColumns + column] != 0,
                coast->isWater(at.latitude_deg, at.longitude_deg))
          << at.latitude_deg << " " << at.longitude_deg;
    }
  }
}

TEST(Coast, FilesThatAreNotAsExpectedAreRefused) {
  const test::TemporaryFolder folder;
  const auto faultOf = [](const std::string& file) {
    return test::errorOf([&] { Coast::read(file, {10, 80, 10, 80}); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(faultOf(folder / "missing.nc"), HasSubstr("missing.nc"));
  EXPECT_THAT(faultOf(folder.write("text.nc", "no coast")), HasSubstr("cannot be read as netCDF"));
  CoastWriter(folder / "other.nc").add("other", {1});
  EXPECT_THAT(faultOf(folder / "other.nc"), HasSubstr("has no array N_bins_in_360_longitude_range"));
}

TEST(Coast, InstalledDataKnowsCitiesAndSeas) {
  struct Point {
    const char* name;
    double latitude_deg, longitude_deg;
    bool is_water;
  };
  if (Coast::installed({50, 53, 2, 5}) == nullptr) GTEST_SKIP() << "the coasts of GSHHG are not installed";
  for (const Point& point :
       {Point{"the North Sea", 54.0, 3.0, true}, Point{"Brussels", 50.85, 4.35, false},
        Point{"Puget Sound", 47.6, -122.42, true}, Point{"Seattle", 47.6, -122.3, false},
        Point{"Kansas City", 39.1, -94.6, false}, Point{"the Pacific Ocean", 0.0, -150.0, true},
        Point{"Fiji, at the antimeridian", -16.6, 179.25, false},
        Point{"the sea beyond it", -18, -179.9, true}, Point{"Lake Ontario", 43.6, -78, true},
        Point{"Sydney", -33.9, 150.9, false}, Point{"the Tasman Sea", -35, 160, true}}) {
    const GeoBox box{point.latitude_deg - 0.2, point.latitude_deg + 0.2, point.longitude_deg - 0.2,
                     point.longitude_deg + 0.2};
    EXPECT_EQ(Coast::installed(box)->isWater(point.latitude_deg, point.longitude_deg), point.is_water)
        << point.name;
  }
}

}  // namespace
}  // namespace emscape::scenario
