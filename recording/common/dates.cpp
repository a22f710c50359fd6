#include "recording/common/dates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/utc.h"
#include "recording/common/text.h"

namespace emscape::interop {
namespace {

/// Number of a month by the first three letters of its English name, 1..12; 0 for another text.
int monthNumber(std::string_view name) {
  constexpr std::array kMonths{"jan", "feb", "mar", "apr", "may", "jun",
                               "jul", "aug", "sep", "oct", "nov", "dec"};
  const std::string begin = lowerCase(std::string(name.substr(0, 3)));
  const auto* const found = std::find(kMonths.begin(), kMonths.end(), begin);
  return found == kMonths.end() ? 0 : static_cast<int>(found - kMonths.begin()) + 1;
}

constexpr int kMaxDigits = 9;

/// Takes parts off the begin of a text.
class DateScanner {
 public:
  explicit DateScanner(std::string_view text) : rest_(trimmed(text)) {}

  bool isAtEnd() const { return rest_.empty(); }
  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool takeBlanks() {
    const std::size_t before = rest_.size();
    while (take(' ')) {
    }
    return rest_.size() != before;
  }
  /// @return none without a digit, and for too many
  std::optional<int> takeNumber(int* digits = nullptr) {
    int value = 0, count = 0;
    while (count < kMaxDigits && !rest_.empty() && isDigit(rest_.front())) {
      value = 10 * value + (rest_.front() - '0');
      rest_.remove_prefix(1);
      ++count;
    }
    if (digits != nullptr) *digits = count;
    const bool goes_on = !rest_.empty() && isDigit(rest_.front());
    return count > 0 && !goes_on ? std::optional(value) : std::nullopt;
  }
  std::string takeWord() {
    std::size_t size = 0;
    while (size < rest_.size() && ((rest_[size] | 0x20) >= 'a' && (rest_[size] | 0x20) <= 'z')) ++size;
    const std::string word = lowerCase(std::string(rest_.substr(0, size)));
    rest_.remove_prefix(size);
    return word;
  }
  /// The digits after a decimal sign as a part of a second.
  double takeFraction() {
    double value = 0, unit = 0.1;
    while (!rest_.empty() && isDigit(rest_.front())) {
      value += unit * (rest_.front() - '0');
      unit /= 10;
      rest_.remove_prefix(1);
    }
    return value;
  }
  bool beginsWithDigit() const { return !rest_.empty() && isDigit(rest_.front()); }

 private:
  static bool isDigit(char c) { return c >= '0' && c <= '9'; }
  std::string_view rest_;
};

struct Date {
  int year = 0, month = 0, day = 0;
  bool needs_order = false;  ///< the other order is a date, too
};

bool isDate(int year, int month, int day) {
  constexpr std::array kDays{31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (year < 1 || year > 9999 || month < 1 || month > 12) return false;
  const bool is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  const int days = month == 2 && !is_leap ? 28 : kDays[static_cast<std::size_t>(month) - 1];
  return day >= 1 && day <= days;
}

/// "1 Jun 2026", "1-Jun-2026", "Jun 1, 2026"; the scanner is at the month or after the day.
std::optional<Date> namedMonth(DateScanner& scanner, std::optional<int> day) {
  const int month = monthNumber(scanner.takeWord());
  const auto skip = [&] {
    while (scanner.take(' ') || scanner.take('-') || scanner.take('.') || scanner.take(',')) {
    }
  };
  skip();
  if (!day) day = scanner.takeNumber();
  skip();
  int digits = 0;
  const auto year = scanner.takeNumber(&digits);
  if (month == 0 || !day || !year || digits != 4) return std::nullopt;
  return Date{*year, month, *day};
}

std::optional<Date> takeDate(DateScanner& scanner, DateOrder order) {
  if (!scanner.beginsWithDigit()) return namedMonth(scanner, std::nullopt);
  int digits = 0;
  const auto first = scanner.takeNumber(&digits);
  if (!first) return std::nullopt;
  if (digits == 8) return Date{*first / 10000, *first / 100 % 100, *first % 100};
  char sign = 0;
  for (const char c : {'-', '/', '.', ' '}) {
    if (scanner.take(c)) sign = c;
    if (sign != 0) break;
  }
  if (sign == 0) return std::nullopt;
  if (!scanner.beginsWithDigit() && digits <= 2) return namedMonth(scanner, first);
  const auto second = scanner.takeNumber();
  if (!second || sign == ' ' || !scanner.take(sign)) return std::nullopt;
  int last_digits = 0;
  const auto third = scanner.takeNumber(&last_digits);
  if (!third) return std::nullopt;
  if (digits == 4) return Date{*first, *second, *third};
  if (last_digits != 4 || digits > 2) return std::nullopt;
  if (sign == '.') order = DateOrder::day_first;
  const Date by_day{*third, *second, *first}, by_month{*third, *first, *second};
  if (order == DateOrder::day_first) return by_day;
  if (order == DateOrder::month_first) return by_month;
  const bool can_be_day = isDate(by_day.year, by_day.month, by_day.day),
             can_be_month = isDate(by_month.year, by_month.month, by_month.day);
  Date date = can_be_day ? by_day : by_month;
  date.needs_order = can_be_day && can_be_month && *first != *second;
  return date;
}

/// "06:00", "6:00:00.5 PM", "060000": seconds of the day.
std::optional<double> takeClock(DateScanner& scanner) {
  int digits = 0;
  auto hour = scanner.takeNumber(&digits);
  if (!hour) return std::nullopt;
  std::optional<int> minute = 0, second = 0;
  if (digits == 6 || digits == 4) {
    if (digits == 4) *hour *= 100;
    second = *hour % 100;
    minute = *hour / 100 % 100;
    hour = *hour / 10000;
  } else {
    if (digits > 2 || !scanner.take(':')) return std::nullopt;
    minute = scanner.takeNumber();
    if (scanner.take(':')) second = scanner.takeNumber();
  }
  if (!minute || !second) return std::nullopt;
  const double fraction = scanner.take('.') || scanner.take(',') ? scanner.takeFraction() : 0;
  DateScanner before = scanner;
  scanner.takeBlanks();
  const std::string half = scanner.takeWord();
  if (half == "am" || half == "pm") {
    if (*hour < 1 || *hour > 12) return std::nullopt;
    *hour = *hour % 12 + (half == "pm" ? 12 : 0);
  } else {
    scanner = before;
  }
  if (*hour > 24 || *minute > 59 || *second > 60) return std::nullopt;
  return 3600.0 * *hour + 60.0 * *minute + *second + fraction;
}

/// Offset from UTC (s) at the end of a text; none if something else stands there.
std::optional<double> takeZone(DateScanner& scanner) {
  scanner.takeBlanks();
  if (scanner.isAtEnd()) return 0;
  const std::string word = scanner.takeWord();
  if (!word.empty() && word != "z" && word != "utc" && word != "gmt") return std::nullopt;
  if (scanner.isAtEnd()) return 0;
  const bool is_west = scanner.take('-');
  if (!is_west && !scanner.take('+')) return std::nullopt;
  int digits = 0;
  auto hours = scanner.takeNumber(&digits);
  std::optional<int> minutes = 0;
  if (!hours) return std::nullopt;
  if (digits == 4) {
    minutes = *hours % 100;
    hours = *hours / 100;
  } else if (scanner.take(':')) {
    minutes = scanner.takeNumber();
  }
  if (!minutes || digits > 4 || *hours > 23 || *minutes > 59 || !scanner.isAtEnd()) return std::nullopt;
  const double offset_s = 3600.0 * *hours + 60.0 * *minutes;
  return is_west ? -offset_s : offset_s;
}

struct Told {
  double utc_s = 0;
  bool needs_order = false, has_zone = false;
};

std::optional<Told> timeTold(std::string_view text, DateOrder order) {
  DateScanner scanner(text);
  const auto date = takeDate(scanner, order);
  if (!date || !isDate(date->year, date->month, date->day)) return std::nullopt;
  double clock_s = 0, offset_s = 0;
  bool has_zone = false;
  if (!scanner.isAtEnd()) {
    scanner.take(',');
    const bool is_apart = scanner.takeBlanks() || scanner.take('T') || scanner.take('t');
    if (!is_apart) return std::nullopt;
    const auto clock = takeClock(scanner);
    scanner.takeBlanks();
    has_zone = !scanner.isAtEnd();
    const auto offset = clock ? takeZone(scanner) : std::nullopt;
    if (!offset) return std::nullopt;
    clock_s = *clock;
    offset_s = *offset;
  }
  return Told{secondsOfDate(date->year, date->month, date->day) + clock_s - offset_s, date->needs_order,
              has_zone};
}

}  // namespace

std::optional<double> utcSeconds(std::string_view text, DateOrder order) {
  const auto told = timeTold(text, order);
  return told && !told->needs_order ? std::optional(told->utc_s) : std::nullopt;
}

bool hasZone(std::string_view text) {
  auto told = timeTold(text, DateOrder::unknown);
  if (!told) told = timeTold("1970-01-01 " + std::string(text), DateOrder::unknown);
  return told && told->has_zone;
}

bool needsDateOrder(std::string_view text) {
  const auto told = timeTold(text, DateOrder::unknown);
  return told && told->needs_order;
}

std::string utcTextOf(double utc_s) {
  return utcText(std::llround(utc_s * 1000));
}

double secondsOfDate(int year, int month, int day) {
  // Days of the proleptic Gregorian calendar; years begin in March.
  const int y = year - (month <= 2 ? 1 : 0);
  const int era = (y >= 0 ? y : y - 399) / 400;
  const int year_of_era = y - era * 400;
  const int day_of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return 86400.0 * (static_cast<double>(era) * 146097 + day_of_era - 719468);
}

}  // namespace emscape::interop
