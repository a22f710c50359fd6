// Tables of measured paths: columns, conditions, groups, statistics, faults.
#include "emfield/check/measured_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::emfield {
namespace {

using propagation::PropagationModel;
using ::testing::HasSubstr;

constexpr const char* kHeader =
    "transmitter_latitude_deg,transmitter_longitude_deg,transmitter_height_msl_m,receiver_latitude_deg,"
    "receiver_longitude_deg,receiver_height_msl_m,frequency_mhz,loss_db,site\n";

class MeasuredPaths : public ::testing::Test {
 protected:
  MeasuredCheck check(const std::string& table, const MeasuredOptions& options) const {
    return checkMeasuredPaths(folder_.write("t.csv", table), scenario::Scenario{}, scenario::Emitter{},
                              options);
  }
  std::string faultOf(const std::string& table, const MeasuredOptions& options,
                      ErrorCode code = ErrorCode::bad_input) const {
    return test::errorOf([&] { check(table, options); }, code);
  }
  static MeasuredOptions freeSpace() {
    MeasuredOptions options;
    options.models = {PropagationModel::free_space};
    return options;
  }

  test::TemporaryFolder folder_;
};

TEST_F(MeasuredPaths, ComparesWithTheLossOfFreeSpace) {
  const MeasuredCheck found = check(std::string(kHeader) +
                                        "45,5,1000,45.1,5,1000,1000,126,a\n"
                                        "45,5,1000,45.1,5,1000,1000,122,a\n"
                                        "45,5,10,45.1,5,2,1000,130,b\n",
                                    freeSpace());
  ASSERT_EQ(found.paths.size(), 3U);
  const MeasuredPath& path = found.paths[0];
  EXPECT_NEAR(path.distance_m, 11.11e3, 20);
  const double free_space_db = 20 * std::log10(4 * kPi * path.distance_m / wavelength_m(1e9));
  EXPECT_NEAR(path.computed_db[0], free_space_db, 1e-6);
  EXPECT_EQ(path.terrain, PathTerrain::clear);
  EXPECT_EQ(found.paths[2].terrain, PathTerrain::grazing) << "ground within 0.6 Fresnel radii";
  const ErrorStatistics& all = found.models[0].all;
  EXPECT_EQ(all.paths, 3);
  EXPECT_NEAR(all.mean_db, free_space_db - 126, 0.01);
  EXPECT_NEAR(all.sd_db, std::sqrt((0 + 16 + 16) / 3.0), 0.01);
  EXPECT_NEAR(all.rms_db * all.rms_db, all.mean_db * all.mean_db + all.sd_db * all.sd_db, 1e-9);
  EXPECT_EQ(found.models[0].by_terrain[0].paths, 2);
  EXPECT_EQ(found.models[0].by_terrain[1].paths, 1);
}

TEST_F(MeasuredPaths, AreSelectedGroupedAndMappedFromOtherColumns) {
  MeasuredOptions options = freeSpace();
  options.columns = {{"transmitter_latitude_deg", "lat"}, {"transmitter_longitude_deg", "5"},
                     {"transmitter_height_msl_m", "500"}, {"receiver_latitude_deg", "45"},
                     {"receiver_longitude_deg", "5"},     {"receiver_height_agl_m", "2"},
                     {"frequency_hz", "2.4e9"},           {"loss_db", "pl"}};
  const std::string table = "lat;pl;who\n45.1;100;x\n45.1001;110;x\n45.2;120;x\n45.1;130;y\n";
  EXPECT_EQ(check(table, options).paths.size(), 4U);
  options.conditions = {PathCondition::parse("who=x"), PathCondition::parse("distance_m<15000")};
  EXPECT_EQ(check(table, options).paths.size(), 2U);
  options.group_deg = 0.001;
  const MeasuredCheck grouped = check(table, options);
  ASSERT_EQ(grouped.paths.size(), 1U);
  EXPECT_EQ(grouped.selected, 2) << "rows of paths that meet all conditions, also those on the distance";
  EXPECT_EQ(grouped.paths[0].rows, 2);
  EXPECT_NEAR(grouped.paths[0].measured_db, 105, 1e-9);
  EXPECT_NEAR(grouped.paths[0].transmitter.position.latitude_deg, 45.10005, 1e-9);
}

TEST_F(MeasuredPaths, ModelsWithoutAFieldAndRefusalsAreCounted) {
  MeasuredOptions options;
  options.models = {PropagationModel::horizon, PropagationModel::p1812};
  const MeasuredCheck found = check(std::string(kHeader) + "45,5,2,46,5,2,1000,180,a\n", options);
  EXPECT_EQ(found.paths[0].terrain, PathTerrain::blocked) << "by the earth's bulge";
  EXPECT_EQ(found.models[0].all.paths, 0);
  EXPECT_EQ(found.models[0].all.without, 1) << "no field behind the horizon";
  EXPECT_EQ(found.models[1].all.paths, 1);
}

TEST_F(MeasuredPaths, FaultsNameFileLineAndRemedy) {
  EXPECT_THAT(faultOf("a,b\n1,2\n", freeSpace()),
              HasSubstr("t.csv:1: column 'transmitter_latitude_deg' is missing; --columns "
                        "transmitter_latitude_deg=COLUMN (or =NUMBER) names another; the table has a, b"));
  EXPECT_THAT(faultOf(std::string(kHeader) + "95,5,1,45,5,1,100,100,a\n", freeSpace()),
              HasSubstr("t.csv:2: transmitter_latitude_deg: 95 is not within -90 to 90"));
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45.1,5,x,100,100,a\n", freeSpace()),
              HasSubstr("t.csv:2: receiver_height_msl_m: 'x' is not a finite number"));
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45,5,1,100,100,a\n", freeSpace()),
              HasSubstr("t.csv:2: the path is 0 km long"));
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,-3,45.1,5,1,100,100,a\n", freeSpace()),
              HasSubstr("t.csv:2: -3 m above mean sea level is 3.0 m below the ground"));
  MeasuredOptions options = freeSpace();
  options.columns = {{"loss_db", "pathloss"}};
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45.1,5,1,100,100,a\n", options),
              HasSubstr("column 'pathloss' is missing"));
  options.columns = {{"loss", "loss_db"}};
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45.1,5,1,100,100,a\n", options, ErrorCode::usage),
              HasSubstr("--columns: no value is called 'loss'"));
  options = freeSpace();
  options.conditions = {PathCondition::parse("where=1")};
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45.1,5,1,100,100,a\n", options, ErrorCode::usage),
              HasSubstr("the table has no column 'where'"));
  options.conditions = {PathCondition::parse("site=b")};
  EXPECT_THAT(faultOf(std::string(kHeader) + "45,5,1,45.1,5,1,100,100,a\n", options),
              HasSubstr("no row meets the conditions of --where"));
  for (const char* text : {"", "a", "=1", "a=", "a<b", "distance_m=far", "a<="})
    EXPECT_THAT(test::errorOf([&] { PathCondition::parse(text); }, ErrorCode::usage),
                HasSubstr("is no condition"))
        << text;
}

}  // namespace
}  // namespace emscape::emfield
