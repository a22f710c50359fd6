/// Dates and times as programs and people write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace emscape::interop {

/// Number of 1970-01-01 in spreadsheets, which count days from 1900.
constexpr double kSpreadsheetDayOf1970 = 25569;
constexpr double kSecondsPerDay = 86400;

/// Of dates in numbers whose year comes last: 6/1/2026 is the 6th of January, or the 1st of June.
enum class DateOrder { unknown, day_first, month_first };

/// Seconds from 1970-01-01T00:00:00Z to a date with or without a time of day: "2026-06-01T06:00:00.5Z",
/// "2026-06-01 08:00+02:00", "20260601T060000Z", "2026/06/01 6:00", "1 Jun 2026 06:00:00.000", "Jun 1, 2026",
/// "01.06.2026 06:00" (with dots the day is first), "6/1/2026 6:00:00 AM". A time without a zone is UTC.
/// @return none for another text, and for a date that is another one in the other order if that is not known
std::optional<double> utcSeconds(std::string_view text, DateOrder order = DateOrder::unknown);

/// True if a date with a time of day, or a time of day alone, says its zone.
bool hasZone(std::string_view text);

/// True if the text is a date of which the order is needed.
bool needsDateOrder(std::string_view text);

/// The date and time of seconds from 1970 as ISO 8601 with milliseconds.
std::string utcTextOf(double utc_s);

/// Seconds from 1970 to a UTC date. @param month  1..12
double secondsOfDate(int year, int month, int day);

}  // namespace emscape::interop
