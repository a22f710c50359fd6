// Text files of AREPS.
#include "report/maps/areps_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/errors.h"

namespace emscape::report {
namespace {

using testing::HasSubstr;

const std::string kHead =
    "Bearing angle = 30.0\r\nFreq = 3000 MHz\r\nHmin = 0 m\r\nHmax = 100\r\nNzout = 2\r\nRmax = "
    "3000\r\nNrout = 3\r\n";

TEST(ArepsTable, HasARowMoreThanItSaysAndValuesBetweenThePoints) {
  const ArepsTable table = parseAreps(
      "a.txt",
      kHead +
          "[Apm Factor Data]\r\n1 2 3\r\n[Apm Loss Data]\r\nGroundValue = -9\r\nHeight(m), range\r\n"
          "-9 1010 1020\r\n\r\n1100 1110 1120\r\n1200 1210 1220\r\n[Clutter to noise ratio]\r\n7\r\n");
  EXPECT_EQ(table.ranges, 3);
  EXPECT_EQ(table.heights, 3);
  EXPECT_EQ(table.bearing_deg, 30);
  EXPECT_FLOAT_EQ(table.at_db(1000, 50), 110) << "the first range is Rmax / Nrout";
  EXPECT_FLOAT_EQ(table.at_db(2500, 75), 116.5);
  EXPECT_FLOAT_EQ(table.at_db(3000, 100), 122);
  EXPECT_TRUE(std::isnan(table.at_db(1000, 0)));
  EXPECT_TRUE(std::isnan(table.at_db(1500, 25))) << "a corner below the ground";
  EXPECT_FLOAT_EQ(table.at_db(2000, 0), 101) << "no part of it";
  EXPECT_TRUE(std::isnan(table.at_db(500, 50)));
  EXPECT_TRUE(std::isnan(table.at_db(1000, 101)));
}

TEST(ArepsTable, WhatIsMissingIsNamed) {
  const auto errorOf = [](const std::string& text) {
    return test::errorOf([&] { parseAreps("a.txt", text); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(errorOf("hello\n"), HasSubstr("a.txt:1: Nrout is missing: this is no text file of AREPS"));
  EXPECT_THAT(errorOf(kHead), HasSubstr("the section [Apm Loss Data] is missing"));
  EXPECT_THAT(errorOf(kHead + "[Apm Loss Data]\n1 2 3\n4 5\n"),
              HasSubstr("5 losses are not Nrout x (Nzout + 1) = 3 x 3"));
  EXPECT_THAT(errorOf("Nrout = 1e9\n"),
              HasSubstr("a.txt:1: 'nrout' is 1e+09, not a whole number of 1 to 10000"));
}

}  // namespace
}  // namespace emscape::report
