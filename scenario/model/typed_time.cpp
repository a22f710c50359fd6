#include "scenario/model/typed_time.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <regex>

#include "base/text/time_text.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"

namespace emscape::scenario {
namespace {

/// The time of day in seconds; none for another text.
std::optional<double> timeOfDay_s(const std::string& text) {
  static const std::regex form(R"( *(\d\d?):(\d\d)(?::(\d\d(?:\.\d{1,9})?))? *(?:Z|UTC)? *)");
  std::smatch parts;
  if (text.size() > 64 || !std::regex_match(text, parts, form)) return std::nullopt;
  const double hours = std::stod(parts[1]), minutes = std::stod(parts[2]),
               seconds = parts[3].matched ? std::stod(parts[3]) : 0;
  if (hours >= 24 || minutes >= 60 || seconds >= 60) return std::nullopt;
  return (hours * 60 + minutes) * 60 + seconds;
}

/// @param from_s  a time of day is the first one from this time on
std::optional<double> utcTime_s(const std::string& text, const Clock& clock, double from_s) {
  const std::optional<std::int64_t> epoch_ms = parseUtc_ms(clock.epoch_utc);
  if (!epoch_ms) return std::nullopt;
  if (const std::optional<std::int64_t> time_ms = parseUtc_ms(text))
    return static_cast<double>(*time_ms - *epoch_ms) / 1000;
  const std::optional<double> of_day_s = timeOfDay_s(text);
  if (!of_day_s) return std::nullopt;
  constexpr double kDay_s = 86400;
  const double epoch_of_day_s = std::fmod(static_cast<double>(*epoch_ms) / 1000, kDay_s);
  const double after_epoch_s = *of_day_s - epoch_of_day_s;
  constexpr double kRounding_s = 1e-6;
  return after_epoch_s + kDay_s * std::ceil((from_s - after_epoch_s - kRounding_s) / kDay_s);
}

}  // namespace

std::string shortUtcAt(const Clock& clock, double t_s) {
  static const std::regex zeros(R"(\.?0*Z$)"), fraction(R"(\.\d+Z$)");
  const std::string text = utcAt(clock, t_s);
  return std::regex_search(text, fraction) ? std::regex_replace(text, zeros, "Z") : text;
}

double parseTime_s(const std::string& text, const Clock& clock, const TimeInterval& allowed) {
  const auto isAllowed = [&](double t_s) { return t_s >= allowed.begin_s && t_s <= allowed.end_s; };
  const std::optional<double> of_clock_s = emscape::parseTime_s(text);
  if (of_clock_s && isAllowed(*of_clock_s)) return *of_clock_s;
  const std::optional<double> utc_s = utcTime_s(text, clock, allowed.begin_s);
  if (utc_s && isAllowed(*utc_s)) return *utc_s;
  const bool has_utc = !clock.epoch_utc.empty();
  if (!of_clock_s && !utc_s) {
    const std::string fault = utcFault(text);
    throw Error(
        ErrorCode::bad_input,
        fmt::format("time '{}'{}: expected seconds (12.5, 1.5 min), M:SS or H:MM:SS{}", text,
                    fault.empty() ? "" : ": " + fault,
                    has_utc ? fmt::format(", or UTC such as {}", shortUtcAt(clock, allowed.begin_s)) : ""));
  }
  std::string range = fmt::format("{} to {}", timeText(allowed.begin_s, allowed.end_s),
                                  timeText(allowed.end_s, allowed.end_s));
  if (has_utc && std::isfinite(allowed.begin_s) && std::isfinite(allowed.end_s)) {
    range += fmt::format(", {} to {}", shortUtcAt(clock, allowed.begin_s), shortUtcAt(clock, allowed.end_s));
  }
  throw Error(ErrorCode::bad_input, fmt::format("time '{}' is not allowed; allowed: {}", text, range));
}

}  // namespace emscape::scenario
