#include "emscape/scenario/model/clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/text/utc.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/model/typed_time.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

TEST(Clock, TimesHoldBothEndsIfTheStepMeetsThem) {
  EXPECT_EQ(timesOf(0, 1, 0.5), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(timesOf(0, 1.2, 0.5), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(timesOf(2, 2, 1), (std::vector<double>{2}));
  EXPECT_EQ(timesOf(0, 0.3, 0.1).size(), 4u) << "0.3 / 0.1 is just below 3";
}

TEST(Clock, RoundingErrorsDoNotAccumulate) {
  const auto times = timesOf(0, 86400, 0.1);
  ASSERT_EQ(times.size(), 864001u);
  EXPECT_EQ(times.back(), 864000 * 0.1);
}

TEST(Clock, TimesEqualDecimalTextOfUser) {
  EXPECT_EQ(timesOf(0, 0.5, 0.1), (std::vector<double>{0, 0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(timesOf(-0.3, 0.3, 0.1), (std::vector<double>{-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3}));
  EXPECT_FALSE(std::signbit(timesOf(-0.3, 0, 0.1).back()));
  EXPECT_EQ(timesOf(999999.9, 1000000.3, 0.1),
            (std::vector<double>{999999.9, 1000000, 1000000.1, 1000000.2, 1000000.3}));
  const auto times = timesOf(1e-3, 10, 1e-3);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], static_cast<double>(i + 1) / 1000);
}

TEST(Clock, TimesThatAreNoShortDecimalNumbersAreLeft) {
  for (const double step_s : {1.0 / 3, 0.0009765625}) {
    const auto times = timesOf(0.5, 0.5 + 30 * step_s, step_s);
    ASSERT_EQ(times.size(), 31u);
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_EQ(times[i], 0.5 + static_cast<double>(i) * step_s) << step_s;
  }
  EXPECT_EQ(timesOf(1e9 - 1, 1e9, 0.125)[1], 999999999.125);
  EXPECT_EQ(timesOf(0, 0, 1), (std::vector<double>{0}));
}

TEST(Clock, TimesInUtcAreSecondsSinceTheEpoch) {
  const Clock clock{"2026-11-28T06:00:00Z", 600, 10};
  EXPECT_EQ(parseTimes("2026-11-28T06:05:00Z", clock), (std::vector<double>{300}));
  EXPECT_EQ(parseTimes("2026-11-28T05:59:59.5Z", clock), (std::vector<double>{-0.5}));
  EXPECT_EQ(parseTimes("2026-11-28T06:00:10Z:2026-11-28T06:00:30Z:10", clock),
            (std::vector<double>{10, 20, 30}));
  EXPECT_EQ(parseTimes("0:2026-11-28T06:00:20Z", clock), (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(parseTime("2026-11-28T06:01:00Z", clock), 60);
  const auto faultOf = [](const std::string& text, const Clock& of) {
    return test::errorOf([&] { parseTimes(text, of); }, ErrorCode::usage);
  };
  EXPECT_THAT(faultOf("2026-11-28T06:05:00", clock), HasSubstr("is not a time in seconds or UTC; write"));
  EXPECT_THAT(faultOf("2026-13-28T06:05:00Z", clock), HasSubstr("UTC: month 13 is outside 1 to 12"));
  EXPECT_THAT(faultOf("2026-11-28T06:05:00Z5", clock), HasSubstr("is not a time in seconds or UTC"));
  EXPECT_THAT(faultOf("2026-11-28T06:05:00Z", Clock{"", 600, 10}), HasSubstr("the scenario has no epoch"));
  EXPECT_THAT(test::errorOf([&] { parseTime("0:2026-11-28T06:05:00Z", clock); }, ErrorCode::usage),
              HasSubstr("a single time is expected"));
}

TEST(Clock, ParsesTimesInItsThreeForms) {
  const Clock clock{"", 10, 2};
  EXPECT_EQ(parseTimes("3.5", clock), (std::vector<double>{3.5}));
  EXPECT_EQ(parseTimes("0:4", clock), (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(parseTimes("1:2:0.5", clock), (std::vector<double>{1, 1.5, 2}));
}

TEST(Clock, TimesHaveUnitsToo) {
  const Clock clock{"2026-06-01T06:00:00Z", 120, 30};
  EXPECT_EQ(parseTimes("1 min", clock), (std::vector<double>{60}));
  EXPECT_EQ(parseTimes("0:2026-06-01T06:00:20Z:10 s", clock), (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(parseTime("1.5 min", clock), 90);
  EXPECT_EQ(parseTime("1:15", clock), 75) << "a single time has no BEGIN:END";
  EXPECT_THAT(test::errorOf([&] { parseTime("300000:00:00", clock); }, ErrorCode::usage),
              testing::HasSubstr("is outside the allowed range"));
}

TEST(Clock, TypedTimesAreOfTheClockFirstAndThenInUtc) {
  const Clock clock{"2026-06-01T23:59:00Z", 120, 1};
  const auto read = [&](const char* text) { return parseTime_s(text, clock, {0, 120}); };
  EXPECT_EQ(read("49.5"), 49.5);
  EXPECT_EQ(read(" 1.5 min "), 90);
  EXPECT_EQ(read("1:15"), 75);
  EXPECT_EQ(read("0:00:30"), 30);
  EXPECT_EQ(read("00:00:01"), 1) << "of the clock";
  EXPECT_EQ(read("00:00:01 UTC"), 61) << "the next day";
  EXPECT_EQ(read("00:00:01Z"), 61);
  EXPECT_EQ(read("23:59"), 0) << "outside of the clock";
  EXPECT_EQ(read("23:59:12.5"), 12.5);
  EXPECT_EQ(read("2026-06-02T00:00:01.5Z"), 61.5);
  const auto refusal = [&](const char* text) {
    return test::errorOf([&] { read(text); }, ErrorCode::bad_input);
  };
  for (const char* wrong : {"", "now", "24:00:60", "12:", "12:00:01 s", "nan", "1:2:3:4", "1 d"}) {
    EXPECT_THAT(refusal(wrong),
                testing::HasSubstr("expected seconds (12.5, 1.5 min), M:SS or H:MM:SS, or UTC such "
                                   "as 2026-06-01T23:59:00Z"))
        << wrong;
  }
  for (const char* outside : {"500", "-1", "-0:05", "2:01", "12:00", "2026-06-01T23:58:00Z"}) {
    EXPECT_THAT(refusal(outside),
                testing::HasSubstr("allowed: 0 s to 120 s, 2026-06-01T23:59:00Z to 2026-06-02T00:01:00Z"))
        << outside;
  }
  EXPECT_THAT(refusal("2026-06-31T00:00:00Z"), testing::HasSubstr("day of the month 31 is outside 1 to 30"));
  EXPECT_EQ(parseTime_s("1 d 02:00:00", {"", 0, 1}, {0, 1e6}), 93600) << "as the window writes it";
}

TEST(Clock, ListOfTimesIsTakenAsItIs) {
  const Clock clock{"2026-06-01T06:00:00Z", 120, 2};
  EXPECT_EQ(parseTimes("100,110,130", clock), (std::vector<double>{100, 110, 130}));
  EXPECT_EQ(parseTimes("0:4,7,2026-06-01T06:00:10Z", clock), (std::vector<double>{0, 2, 4, 7, 10}));
  for (const char* wrong : {"110,100", "1,1", "0:4,3"}) {
    EXPECT_THAT(test::errorOf([&] { parseTimes(wrong, clock); }, ErrorCode::usage),
                testing::HasSubstr("write them in ascending order"))
        << wrong;
  }
  for (const char* wrong : {"1,", ",1", "1,,2", "1,x"})
    EXPECT_THAT(test::errorOf([&] { parseTimes(wrong, clock); }, ErrorCode::usage),
                testing::HasSubstr("is not a time"))
        << wrong;
}

TEST(Clock, RefusesTextThatIsNoTime) {
  const Clock clock{"", 10, 2};
  for (const char* text : {"", ":", "a", "1:", "1:2:3:4", "2:1", "0:1:0", "0:1:-1", "nan", "0:inf",
                           "0:1e9:1e-3", "1 m", "2026-06-01T06:00:00Z"}) {
    EXPECT_THAT(test::errorOf([&] { parseTimes(text, clock); }, ErrorCode::usage),
                testing::HasSubstr("times"))
        << text;
  }
}

TEST(Clock, UtcCountsFromTheEpoch) {
  const Clock clock{"2026-06-01T06:00:00Z", 10, 2};
  EXPECT_EQ(utcAt(clock, 0), "2026-06-01T06:00:00.000Z");
  EXPECT_EQ(utcAt(clock, 12.3456), "2026-06-01T06:00:12.346Z");
  EXPECT_EQ(utcAt(clock, -0.5), "2026-06-01T05:59:59.500Z");
  EXPECT_EQ(utcAt(clock, 30 * 86400.0), "2026-07-01T06:00:00.000Z");
  EXPECT_EQ(utcAt({"2024-02-28T23:59:59.25Z", 0, 1}, 1), "2024-02-29T00:00:00.250Z");
  EXPECT_EQ(utcAt({"1900-03-01T00:00:00Z", 0, 1}, -1), "1900-02-28T23:59:59.000Z");
  EXPECT_EQ(utcAt({"", 0, 1}, 1), "");
}

TEST(Clock, RefusesTimesOutsideTheLimits) {
  const Clock clock{"2026-06-01T06:00:00Z", 10, 2};
  EXPECT_EQ(parseTimes("1e9", clock), (std::vector<double>{1e9}));
  const auto errorAt = [](const char* text, const Clock& of) {
    return test::errorOf([&] { parseTimes(text, of); }, ErrorCode::usage);
  };
  const std::string range = "is outside the allowed range -1000000000 to 1000000000 s";
  EXPECT_EQ(errorAt("1e308", clock), "times '1e308': 1e+308 s " + range);
  EXPECT_EQ(errorAt("-1e11", {}), "times '-1e11': -100000000000 s " + range);
  EXPECT_EQ(errorAt("0:1e10:1e9", clock), "times '0:1e10:1e9': 10000000000 s " + range);
  EXPECT_EQ(test::errorOf([] { timesOf(-2e9, 0, 1e9); }, ErrorCode::usage), "time -2000000000 s " + range);
  constexpr double kLimit_s = 1e12;
  EXPECT_EQ(parseTimes("1780000001:1780000003", {"", 0, 1}, kLimit_s),
            (std::vector<double>{1780000001, 1780000002, 1780000003}));
  EXPECT_EQ(test::errorOf([&] { parseTimes("2e12", {}, kLimit_s); }, ErrorCode::usage),
            "times '2e12': 2000000000000 s is outside the allowed range -1000000000000 to 1000000000000 s");
  const Clock last{"9999-12-31T23:59:59Z", 0, 1}, first{"0001-01-01T00:00:00Z", 0, 1};
  EXPECT_EQ(errorAt("0:1", last),
            "times '0:1': 1 s after the epoch, 9999-12-31T23:59:59Z, is outside the allowed range "
            "0001-01-01T00:00:00.000Z to 9999-12-31T23:59:59.999Z");
  EXPECT_THAT(errorAt("-1", first), testing::HasSubstr("-1 s after the epoch, 0001-01-01T00:00:00Z"));
  EXPECT_EQ(utcAt(last, 0.999), "9999-12-31T23:59:59.999Z");
  EXPECT_EQ(utcAt(last, 1), "");
  EXPECT_EQ(utcAt(first, -0.001), "");
  EXPECT_EQ(utcAt(clock, 1e308), "");
  EXPECT_EQ(utcAt(clock, std::nan("")), "");
}

TEST(Clock, UtcOfTheUnixEpochIsZero) {
  EXPECT_EQ(parseUtc_ms("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parseUtc_ms("2000-03-01T00:00:00.001Z"), 951868800001);
  EXPECT_EQ(parseUtc_ms("1969-12-31T23:59:59.9996Z"), -1);
}

TEST(Clock, TimesWithAnOffsetAreUtc) {
  const auto six_ms = parseUtc_ms("2026-06-01T06:00:00Z");
  for (const char* text : {"2026-06-01 06:00:00+00:00", "2026-06-01T08:00:00.000+02:00",
                           "2026-06-01T01:30:00-0430", "2026-06-01 07:00:00+01", "2026-06-01 06:00:00Z"})
    EXPECT_EQ(parseUtc_ms(text), six_ms) << text;
  EXPECT_FALSE(parseUtc_ms("2026-06-01 06:00:00")) << "which zone?";
  EXPECT_EQ(utcFault("2026-06-01T06:00:00+25:00"), "hours of the zone 25 is outside 0 to 23");
  const Scenario scenario =
      *loadScenario(test::shippedScenario("quick.yaml"), {{"epoch", "2026-06-01 08:00:00+02:00"}});
  EXPECT_EQ(scenario.clock.epoch_utc, "2026-06-01T06:00:00.000Z");
}

TEST(Clock, SaysWhichNumberOfAUtcTimeIsOutOfRange) {
  EXPECT_EQ(utcFault("2026-13-01T06:00:00Z"), "month 13 is outside 1 to 12");
  EXPECT_EQ(utcFault("2026-02-29T06:00:00Z"), "day of the month 29 is outside 1 to 28");
  EXPECT_EQ(utcFault("2026-06-01T24:00:00Z"), "hour 24 is outside 0 to 23");
  EXPECT_EQ(utcFault("2026-06-01T06:60:00Z"), "minute 60 is outside 0 to 59");
  EXPECT_EQ(utcFault("0000-06-01T06:00:00Z"), "year 0000 is outside 0001 to 9999");
  EXPECT_EQ(utcFault("2026-06-01T06:00:00Z"), "");
  EXPECT_EQ(utcFault("2026-06-01"), "");
}

TEST(Clock, TimesOutsideAreNamedInOneLine) {
  const Clock clock{"", 120, 0.5};
  EXPECT_EQ(outsideClockText({0, 60, 120}, clock), "");
  EXPECT_EQ(outsideClockText({200}, clock), "t = 200 s is outside the scenario's clock, 0 to 120 s");
  EXPECT_EQ(outsideClockText({-5, 0, 130}, clock),
            "2 of 3 times, first t = -5 s, are outside the scenario's clock, 0 to 120 s");
  EXPECT_EQ(outsideClockText({5}, Clock{}), "") << "a scenario without a clock has no such times";
}

TEST(Clock, RefusesInvalidUtcTime) {
  for (const char* text : {"", "2026-06-01", "2026-06-01T06:00:00", "2026-06-01 06:00:00",
                           "2026-13-01T06:00:00Z", "2026-02-29T06:00:00Z", "2026-06-01T24:00:00Z",
                           "2026-06-01T06:00:60Z", "2026-06-01T06:00:00.Z", "2026-06-01T06:00:00.5xZ",
                           "2026-06-01T06:00:00+2:00", "0000-06-01T06:00:00Z", "20260-06-01T06:00:00Z"}) {
    EXPECT_FALSE(parseUtc_ms(text)) << text;
  }
}

}  // namespace
}  // namespace emscape::scenario
