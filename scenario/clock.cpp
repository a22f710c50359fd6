#include "emscape/scenario/clock.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "base/utc.h"
#include "emscape/base/error.h"

namespace emscape::scenario {

namespace {

constexpr double kMaxTimes = 1e7;

double secondsOf(const std::string& text, const std::string& whole) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) {
    throw Error(
        ErrorCode::usage,
        fmt::format("times '{}': '{}' is not a number of seconds; write BEGIN:END:STEP, BEGIN:END or T",
                    whole, text));
  }
  return value;
}

}  // namespace

std::vector<double> timesOf(double begin_s, double end_s, double step_s) {
  if (!std::isfinite(begin_s) || !std::isfinite(end_s) || !(step_s > 0) || !std::isfinite(step_s) ||
      end_s < begin_s) {
    throw Error(ErrorCode::usage,
                fmt::format("times from {} s to {} s in steps of {} s: the end must not be before "
                            "the beginning and the step must be above 0 s",
                            begin_s, end_s, step_s));
  }
  // A step that reaches the end within rounding includes it.
  const double steps = std::floor((end_s - begin_s) / step_s * (1 + 1e-12) + 1e-9);
  if (steps >= kMaxTimes) {
    throw Error(ErrorCode::usage, fmt::format("{} times are more than the allowed {}", steps + 1, kMaxTimes));
  }
  std::vector<double> times(static_cast<std::size_t>(steps) + 1);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = begin_s + static_cast<double>(i) * step_s;
  return times;
}

std::vector<double> timesOf(const Clock& clock) {
  return timesOf(0, clock.duration_s, clock.step_s);
}

std::vector<double> parseTimes(const std::string& text, const Clock& clock) {
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    values.push_back(secondsOf(text.substr(begin, end - begin), text));
    begin = end + 1;
  }
  if (values.size() == 1) return {values[0]};
  if (values.size() > 3) {
    throw Error(ErrorCode::usage, fmt::format("times '{}': write BEGIN:END:STEP, BEGIN:END or T", text));
  }
  return timesOf(values[0], values[1], values.size() == 3 ? values[2] : clock.step_s);
}

std::string utcAt(const Clock& clock, double t_s) {
  if (clock.epoch_utc.empty()) return "";
  const auto epoch_ms = parseUtc_ms(clock.epoch_utc);
  if (!epoch_ms) {
    throw Error(ErrorCode::bad_input,
                fmt::format("epoch '{}' is not a UTC time such as 2026-06-01T06:00:00Z", clock.epoch_utc));
  }
  return utcText(*epoch_ms + std::llround(t_s * 1000));
}

}  // namespace emscape::scenario
