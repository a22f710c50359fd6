#include "base/text/utc.h"

#include <fmt/format.h>

#include <cstdlib>

namespace emscape {

namespace {

constexpr std::int64_t kMillisecondsPerDay = 86400000;

/// Days from 1970-01-01 to a date of the proleptic Gregorian calendar; the year begins in March, so that the
/// leap day is last.
std::int64_t daysFromDate(std::int64_t year, int month, int day) {
  if (month <= 2) --year;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const std::int64_t year_of_era = year - era * 400;
  const std::int64_t day_of_year = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719468;
}

bool isLeapYear(int year) {
  return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
}

int daysInMonth(int year, int month) {
  static constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && isLeapYear(year) ? 29 : kDays[month - 1];
}

/// The inverse of daysFromDate().
std::string dateText(std::int64_t days) {
  const std::int64_t shifted = days + 719468;
  const std::int64_t era = (shifted >= 0 ? shifted : shifted - 146096) / 146097;
  const std::int64_t day_of_era = shifted - era * 146097;
  const std::int64_t year_of_era =
      (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t march_month = (5 * day_of_year + 2) / 153;
  const std::int64_t day = day_of_year - (153 * march_month + 2) / 5 + 1;
  const std::int64_t month = march_month < 10 ? march_month + 3 : march_month - 9;
  return fmt::format("{:04}-{:02}-{:02}", year_of_era + era * 400 + (month <= 2), month, day);
}

/// The numbers of a text of the form of a time with its zone; they may be out of range.
struct Fields {
  int year, month, day, hour, minute, second, millisecond;
  int zone_hour, zone_minute;  ///< ahead of UTC
};

/// The zone of a time, "Z", "+02:00", "-0530" or "+02" at the end of a text, with its first character; empty
/// if the text has none.
struct Zone {
  std::size_t begin;
  int hour, minute;
};
std::optional<Zone> zoneOf(const std::string& text) {
  if (!text.empty() && text.back() == 'Z') return Zone{text.size() - 1, 0, 0};
  for (const std::string form : {"+dd:dd", "+dddd", "+dd"}) {
    if (text.size() <= form.size()) continue;
    const std::size_t begin = text.size() - form.size();
    bool fits = true;
    std::string digits;
    for (std::size_t i = 0; i < form.size(); ++i) {
      const char c = text[begin + i];
      const bool is_digit = c >= '0' && c <= '9';
      fits = fits && (form[i] == 'd' ? is_digit : form[i] == '+' ? c == '+' || c == '-' : c == form[i]);
      if (is_digit) digits += c;
    }
    if (!fits) continue;
    const int sign = text[begin] == '-' ? -1 : 1;
    return Zone{begin, sign * std::stoi(digits.substr(0, 2)),
                digits.size() == 4 ? sign * std::stoi(digits.substr(2)) : 0};
  }
  return std::nullopt;
}

std::optional<Fields> fieldsOf(const std::string& text) {
  static const std::string kForm = "dddd-dd-ddTdd:dd:dd";
  const auto isDigit = [&](std::size_t i) { return text[i] >= '0' && text[i] <= '9'; };
  const std::optional<Zone> zone = text.size() > kForm.size() ? zoneOf(text) : std::nullopt;
  if (!zone || zone->begin < kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool fits =
        kForm[i] == 'd' ? isDigit(i) : text[i] == kForm[i] || (kForm[i] == 'T' && text[i] == ' ');
    if (!fits) return std::nullopt;
  }
  int milliseconds = 0;
  const std::size_t last = zone->begin;
  if (last > kForm.size()) {
    if (text[kForm.size()] != '.' || last == kForm.size() + 1) return std::nullopt;
    int weight = 100;
    for (std::size_t i = kForm.size() + 1; i < last; ++i, weight /= 10) {
      if (!isDigit(i)) return std::nullopt;
      milliseconds += weight * (text[i] - '0');
    }
  }
  const auto field = [&](std::size_t begin, std::size_t length) {
    return std::stoi(text.substr(begin, length));
  };
  return Fields{field(0, 4),  field(5, 2),  field(8, 2), field(11, 2), field(14, 2),
                field(17, 2), milliseconds, zone->hour,  zone->minute};
}

/// The first number that is out of range, with the range; empty if there is none.
std::string faultOf(const Fields& at) {
  const auto outside = [](const char* what, int value, int first, int last) {
    return fmt::format("{} {:02} is outside {} to {}", what, value, first, last);
  };
  if (at.year < 1) return "year 0000 is outside 0001 to 9999";
  if (at.month < 1 || at.month > 12) return outside("month", at.month, 1, 12);
  const int days = daysInMonth(at.year, at.month);
  if (at.day < 1 || at.day > days) return outside("day of the month", at.day, 1, days);
  if (at.hour > 23) return outside("hour", at.hour, 0, 23);
  if (at.minute > 59) return outside("minute", at.minute, 0, 59);
  if (at.second > 59) return outside("second", at.second, 0, 59) + "; there are no leap seconds";
  if (std::abs(at.zone_hour) > 23) return outside("hours of the zone", std::abs(at.zone_hour), 0, 23);
  if (std::abs(at.zone_minute) > 59) return outside("minutes of the zone", std::abs(at.zone_minute), 0, 59);
  return "";
}

}  // namespace

std::optional<std::int64_t> parseUtc_ms(const std::string& text) {
  const std::optional<Fields> at = fieldsOf(text);
  if (!at || !faultOf(*at).empty()) return std::nullopt;
  return daysFromDate(at->year, at->month, at->day) * kMillisecondsPerDay +
         (((at->hour - at->zone_hour) * 60LL + at->minute - at->zone_minute) * 60 + at->second) * 1000 +
         at->millisecond;
}

std::string utcFault(const std::string& text) {
  const std::optional<Fields> at = fieldsOf(text);
  return at ? faultOf(*at) : "";
}

std::string utcText(std::int64_t time_ms) {
  std::int64_t days = time_ms / kMillisecondsPerDay, rest_ms = time_ms % kMillisecondsPerDay;
  if (rest_ms < 0) {
    rest_ms += kMillisecondsPerDay;
    --days;
  }
  return fmt::format("{}T{:02}:{:02}:{:02}.{:03}Z", dateText(days), rest_ms / 3600000, rest_ms / 60000 % 60,
                     rest_ms / 1000 % 60, rest_ms % 1000);
}

}  // namespace emscape
