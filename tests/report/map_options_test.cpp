// Options of maps by their names.
#include "report/maps/map_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"

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

}  // namespace
}  // namespace emscape::report
