#include "base/text/time_text.h"

#include <gtest/gtest.h>

namespace emscape::test {
namespace {

TEST(TimeText, IsInSecondsBelowAnHour) {
  EXPECT_EQ(timeText(12.5), "12.5 s");
  EXPECT_EQ(timeText(-3), "-3 s");
  EXPECT_EQ(timeText(90), "90 s");
}

TEST(TimeText, IsAClockFromAnHourOn) {
  EXPECT_EQ(timeText(3605), "1:00:05");
  EXPECT_EQ(timeText(3605.26), "1:00:05.3");
}

TEST(TimeText, HasDaysFromADayOn) {
  EXPECT_EQ(timeText(93600), "1 d 02:00:00");
  EXPECT_EQ(timeText(-93600), "−1 d 02:00:00");
}

TEST(TimeText, TheLongestTimeBesideItDecidesTheForm) {
  EXPECT_EQ(timeText(5, 7200), "0:00:05");
  EXPECT_EQ(timeText(5, 200000), "0 d 00:00:05");
}

}  // namespace
}  // namespace emscape::test
