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

TEST(ParseTime, TakesEveryFormThatIsWrittenAndUnits) {
  EXPECT_EQ(parseTime_s("12.5"), 12.5);
  EXPECT_EQ(parseTime_s("1.5 min"), 90);
  EXPECT_EQ(parseTime_s("2 h"), 7200);
  EXPECT_EQ(parseTime_s("1:15"), 75);
  EXPECT_EQ(parseTime_s("90:00"), 5400);
  EXPECT_EQ(parseTime_s("-0:05.5"), -5.5);
  for (const double time_s : {12.5, -3.0, 3605.0, 93600.0, -93600.0})
    EXPECT_EQ(parseTime_s(timeText(time_s)), time_s) << timeText(time_s);
  EXPECT_EQ(parseTime_s(timeText(5, 200000)), 5);
  for (const char* text :
       {"", "now", "1:60", "1:75:00", "1:2", "1:", ":15", "1 d", "1 d 25:00:00", "5 km", "nan"})
    EXPECT_FALSE(parseTime_s(text)) << text;
}

}  // namespace
}  // namespace emscape::test
