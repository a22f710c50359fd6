#include "base/text/display_units.h"

#include <gtest/gtest.h>

namespace emscape {
namespace {

TEST(DisplayUnits, LengthsAndSpeedsHaveThreeDigits) {
  EXPECT_EQ(distanceText(850, Units::metric), "850 m");
  EXPECT_EQ(distanceText(999.9, Units::metric), "1.00 km");
  EXPECT_EQ(distanceText(12345, Units::metric), "12.3 km");
  EXPECT_EQ(distanceText(160000, Units::metric), "160 km");
  EXPECT_EQ(distanceText(18520, Units::nautical), "10.0 NM");
  EXPECT_EQ(roundDistanceText(10000, Units::metric), "10 km");
  EXPECT_EQ(roundDistanceText(500, Units::metric), "500 m");
  EXPECT_EQ(roundDistanceText(926, Units::nautical), "0.5 NM");
  EXPECT_EQ(roundDistanceText(15000, Units::nautical), "8.1 NM");
  EXPECT_EQ(heightText(250, Units::metric), "250 m");
  EXPECT_EQ(heightText(250, Units::nautical), "820 ft");
}

}  // namespace
}  // namespace emscape
