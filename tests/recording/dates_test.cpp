// Dates and times of recordings.
#include "recording/common/dates.h"

#include <gtest/gtest.h>

namespace emscape::interop {
namespace {

constexpr double kSix_s = 1780293600;  // 2026-06-01T06:00:00Z

TEST(Dates, UsualFormsAreTheSameTime) {
  for (const char* text :
       {"2026-06-01T06:00:00Z", "2026-06-01 06:00:00", "2026-06-01T08:00:00.000+02:00",
        "2026-06-01 08:00:00 +0200", "2026-06-01T06:00", "20260601T060000Z", "2026/06/01 6:00:00",
        "1 Jun 2026 06:00:00.000", "01-Jun-2026 06:00", "Jun 1, 2026 6:00:00 AM", "June 1 2026 06:00:00",
        "01.06.2026 06:00:00", "2026-06-01 06:00:00 UTC", "  2026-06-01T03:00:00-03 ", "2026-06-01, 06:00"})
    EXPECT_EQ(utcSeconds(text), kSix_s) << text;
  EXPECT_EQ(utcSeconds("2026-06-01T06:00:00.25Z"), kSix_s + 0.25);
  EXPECT_EQ(utcSeconds("6/13/2026 12:30:00 AM"), kSix_s + 12 * 86400 - 5.5 * 3600);
  EXPECT_EQ(utcSeconds("2026-06-01"), kSix_s - 6 * 3600);
  EXPECT_EQ(utcSeconds("2026-05-31T24:00:00Z"), kSix_s - 6 * 3600);
}

TEST(Dates, HaveAZoneOrNot) {
  for (const char* text : {"2026-06-01T06:00:00Z", "2026-06-01 06:00:00 +02:00 ", "06:00:00 UTC"})
    EXPECT_TRUE(hasZone(text)) << text;
  for (const char* text : {"2026-06-01 06:00:00", "2026-06-01 06:00:00  ", "06:00:00 "})
    EXPECT_FALSE(hasZone(text)) << text;
}

TEST(Dates, WhoseDayAndMonthMayBeExchangedNeedTheirOrder) {
  EXPECT_TRUE(needsDateOrder("1/6/2026 06:00:00"));
  EXPECT_FALSE(utcSeconds("1/6/2026 06:00:00"));
  EXPECT_EQ(utcSeconds("1/6/2026 06:00:00", DateOrder::day_first), kSix_s);
  EXPECT_EQ(utcSeconds("6/1/2026 06:00:00", DateOrder::month_first), kSix_s);
  EXPECT_FALSE(needsDateOrder("13/6/2026"));
  EXPECT_FALSE(needsDateOrder("6/6/2026"));
}

TEST(Dates, OtherTextsAreNone) {
  for (const char* text : {"", "yesterday", "2026-02-30", "2026-06-01T25:00:00Z", "2026-06-01T06:61", "12",
                           "2026-06", "2026-06-01T06:00:00 CET", "2026-06-01Tx", "99999999999-1-1", "1/2/26"})
    EXPECT_FALSE(utcSeconds(text)) << text;
}

}  // namespace
}  // namespace emscape::interop
