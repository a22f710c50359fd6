// Options of maps by their names.
#include "report/maps/map_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::report {
namespace {

using ::testing::HasSubstr;

TEST(MapOptions, MessageNamesTheOptionAsItWasGiven) {
  MapOptions options;
  options.products = {"covered", "covered"};
  EXPECT_THAT(test::errorOf([&] { productsOf(options); }), HasSubstr("products: 'covered' is given twice"));
  options.prefix = "--";
  EXPECT_THAT(test::errorOf([&] { productsOf(options); }), HasSubstr("--products: 'covered' is given twice"));
}

TEST(MapOptions, ThresholdIsRequiredForAnAreaOfAQuantityWithoutADefault) {
  MapOptions options;
  options.quantity = "power_density_dbwm2";
  EXPECT_THAT(
      test::errorOf([&] { requestOf(options, {}); }),
      HasSubstr("threshold: quantity 'power_density_dbwm2' has no default threshold; give one in dBW/m2"));
  options.products = {"value"};
  EXPECT_EQ(requestOf(options, {}).threshold, 0);
}

TEST(MapOptions, NumbersOfTimesReplaceTheirText) {
  MapOptions options;
  options.times = "0:10:5";
  EXPECT_EQ(requestOf(options, {}).times_s, (std::vector<double>{0, 5, 10}));
  options.times_s = {1, 7};
  EXPECT_EQ(requestOf(options, {}).times_s, (std::vector<double>{1, 7}));
}

TEST(AreaOfMaps, WithExchangedOrWrongSignedCoordinatesIsRefusedWithTheMistake) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("jacksboro.yaml"));
  const auto fault = [&](const std::string& area) {
    MapOptions options;
    options.prefix = "--";
    options.area = area;
    return test::errorOf([&] { areaOf(options, *scenario); });
  };
  EXPECT_THAT(fault("-84.2,36.3,5000"),
              HasSubstr("--area '-84.2,36.3,5000': of its middle, its position is "));
  EXPECT_THAT(fault("-84.2,36.3,5000"), HasSubstr("perhaps latitude and longitude are exchanged"));
  EXPECT_THAT(fault("36.3,84.2,5000"), HasSubstr("perhaps longitude has the other sign"));
  EXPECT_THAT(fault("bbox:36.2,-84.3,36.4,-84.1"), HasSubstr("exchanged"));
  EXPECT_EQ(fault("36.3,-84.2,5000"), "");
}

}  // namespace
}  // namespace emscape::report
