#include "emscape/scenario/model/clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/text/quantity_text.h"
#include "base/text/time_text.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"

namespace emscape::scenario {

namespace {

constexpr double kMaxTimes = 1e7;

double secondsOf(const std::string& text, const std::string& whole, const Clock& clock) {
  if (const std::optional<double> seconds = parseQuantity(text, "s")) return *seconds;
  const auto time_ms = parseUtc_ms(text), epoch_ms = parseUtc_ms(clock.epoch_utc);
  if (time_ms && epoch_ms) return static_cast<double>(*time_ms - *epoch_ms) / 1000;
  const std::string fault = time_ms ? "the scenario has no epoch" : utcFault(text);
  throw Error(
      ErrorCode::usage,
      fmt::format("times '{}': '{}' is not a time in seconds or UTC{}; write BEGIN:END:STEP, BEGIN:END, "
                  "T or a list of them, such as 0:90:0.5, '1 min', 10,25,40 or 2026-06-01T06:01:10Z",
                  whole, text, fault.empty() ? "" : ": " + fault));
}

/// The end of a part of "BEGIN:END:STEP". The colons of a UTC time, which begins with its date, belong to it.
std::size_t partEnd(const std::string& text, std::size_t begin) {
  const std::size_t end = text.find(':', begin), date_end = text.find('T', begin);
  const bool is_utc = date_end < end;
  return std::min(text.size(),
                  is_utc ? text.find(':', std::min(text.size(), text.find('Z', date_end))) : end);
}

/// The double that is nearest to a decimal number of 12 digits, so that a third step of 0.1 is 0.3 and not
/// 0.30000000000000004; the value itself if they differ by more than its rounding errors.
/// @param largest  largest absolute value of the sequence; the 12 digits begin with its first
double nearestDecimal(double value, double largest) {
  constexpr int kDigits = 12;
  // Powers of ten up to this one are exact.
  constexpr double kMaxScale = 1e22;
  const double scale = std::pow(10, kDigits - 1 - std::floor(std::log10(largest)));
  if (!(scale <= kMaxScale)) return value;
  const double decimal = std::round(value * scale) / scale + 0.0;  // not -0
  // The errors of step, product and begin, each of half a unit of the last place, and of their sum.
  const double error = 4 * std::numeric_limits<double>::epsilon() * largest;
  return std::abs(decimal - value) <= error ? decimal : value;
}

/// As of the years 0001 to 9999, which parseUtc_ms() reads.
constexpr const char* kFirstUtc = "0001-01-01T00:00:00.000Z";
constexpr const char* kLastUtc = "9999-12-31T23:59:59.999Z";

/// Why a time cannot be used; empty: it can.
std::string timeFault(const Clock& clock, double t_s, double limit_s) {
  if (!(std::abs(t_s) <= limit_s)) {
    constexpr int kDigits = 13;  // limits are shown in full
    return fmt::format("{} s is outside the allowed range {}", t_s,
                       rangeText(-limit_s, limit_s, "s", kDigits));
  }
  if (!clock.epoch_utc.empty() && utcAt(clock, t_s).empty()) {
    return fmt::format("{} s after the epoch, {}, is outside the allowed range {} to {}", t_s,
                       clock.epoch_utc, kFirstUtc, kLastUtc);
  }
  return "";
}

void requireTime(const Clock& clock, double t_s, double limit_s) {
  const std::string fault = timeFault(clock, t_s, limit_s);
  if (!fault.empty()) throw Error(ErrorCode::usage, "time " + fault);
}

}  // namespace

void requireTime(const Clock& clock, double t_s) {
  requireTime(clock, t_s, kMaxTime_s);
}

std::vector<double> timesOf(double begin_s, double end_s, double step_s, double limit_s) {
  requireTime({}, begin_s, limit_s);
  requireTime({}, end_s, limit_s);
  if (!(step_s > 0) || !std::isfinite(step_s) || end_s < begin_s) {
    throw Error(ErrorCode::usage,
                fmt::format("times from {} s to {} s in steps of {} s: the end must not be before "
                            "the beginning and the step must be above 0 s",
                            begin_s, end_s, step_s));
  }
  // A step that reaches the end within rounding includes it.
  const double steps = std::floor((end_s - begin_s) / step_s * (1 + 1e-12) + 1e-9);
  if (steps >= kMaxTimes) {
    throw Error(ErrorCode::usage,
                fmt::format("{:.9g} times are more than the allowed {}", steps + 1, kMaxTimes));
  }
  const double largest_s = std::max(std::abs(begin_s), std::abs(end_s));
  std::vector<double> times(static_cast<std::size_t>(steps) + 1);
  for (std::size_t i = 0; i < times.size(); ++i)
    times[i] = nearestDecimal(begin_s + static_cast<double>(i) * step_s, largest_s);
  return times;
}

std::vector<double> timesOf(const Clock& clock) {
  return timesOf(0, clock.duration_s, clock.step_s);
}

std::vector<double> parseTimes(const std::string& text, const Clock& clock, double limit_s) {
  if (text.find(',') != std::string::npos) {
    std::vector<double> times_s;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::vector<double> part_s = parseTimes(text.substr(begin, end - begin), clock, limit_s);
      if (!times_s.empty() && !(part_s.front() > times_s.back())) {
        throw Error(ErrorCode::usage,
                    fmt::format("times '{}': {:.10g} s follows {:.10g} s; write them in ascending order",
                                text, part_s.front(), times_s.back()));
      }
      times_s.insert(times_s.end(), part_s.begin(), part_s.end());
      begin = end + 1;
    }
    return times_s;
  }
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = partEnd(text, begin);
    values.push_back(secondsOf(text.substr(begin, end - begin), text, clock));
    begin = end + 1;
  }
  if (values.size() > 3) {
    throw Error(ErrorCode::usage,
                fmt::format("times '{}': write BEGIN:END:STEP, BEGIN:END, T or a list A,B,C", text));
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 2); ++i) {
    const std::string fault = timeFault(clock, values[i], limit_s);
    if (!fault.empty()) throw Error(ErrorCode::usage, fmt::format("times '{}': {}", text, fault));
  }
  if (values.size() == 1) return {values[0]};
  return timesOf(values[0], values[1], values.size() == 3 ? values[2] : clock.step_s, limit_s);
}

double parseTime(const std::string& text, const Clock& clock) {
  const auto time_ms = parseUtc_ms(text), epoch_ms = parseUtc_ms(clock.epoch_utc);
  std::optional<double> time_s = emscape::parseTime_s(text);
  if (time_ms && epoch_ms) time_s = static_cast<double>(*time_ms - *epoch_ms) / 1000;
  if (!time_s) {
    const std::string fault = time_ms ? "the scenario has no epoch" : utcFault(text);
    throw Error(ErrorCode::usage,
                fmt::format("time '{}': a single time is expected, such as 90, '1.5 min', 1:30 or "
                            "2026-06-01T06:01:10Z{}",
                            text, fault.empty() ? "" : "; " + fault));
  }
  requireTime(clock, *time_s);
  return *time_s;
}

std::string outsideClockText(const std::vector<double>& times_s, const Clock& clock) {
  if (!(clock.duration_s > 0)) return "";
  const auto isOutside = [&](double time_s) { return time_s < 0 || time_s > clock.duration_s; };
  const auto first = std::find_if(times_s.begin(), times_s.end(), isOutside);
  if (first == times_s.end()) return "";
  const auto count = std::count_if(times_s.begin(), times_s.end(), isOutside);
  const std::string which =
      count == 1 ? fmt::format("t = {:g} s is", *first)
                 : fmt::format("{} of {} times, first t = {:g} s, are", count, times_s.size(), *first);
  return fmt::format("{} outside the scenario's clock, 0 to {:g} s", which, clock.duration_s);
}

std::string utcAt(const Clock& clock, double t_s) {
  if (clock.epoch_utc.empty()) return "";
  const auto epoch_ms = parseUtc_ms(clock.epoch_utc);
  if (!epoch_ms) {
    throw Error(ErrorCode::bad_input,
                fmt::format("epoch '{}' is not a UTC time such as 2026-06-01T06:00:00Z", clock.epoch_utc));
  }
  if (!(std::abs(t_s) <= kMaxTime_s)) return "";
  static const std::int64_t first_ms = parseUtc_ms(kFirstUtc).value(),
                            last_ms = parseUtc_ms(kLastUtc).value();
  const std::int64_t time_ms = *epoch_ms + std::llround(t_s * 1000);
  return time_ms < first_ms || time_ms > last_ms ? "" : utcText(time_ms);
}

}  // namespace emscape::scenario
