#include "base/text/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "base/text/quantity_text.h"

namespace emscape {

std::string timeText(double time_s, double span_s) {
  constexpr double kHour_s = 3600, kDay_s = 86400;
  // Above, tenths of a second are lost in the number.
  constexpr double kMax_s = 1e14;
  const double longest_s = std::max(std::abs(time_s), span_s);
  if (longest_s < kHour_s || !(longest_s < kMax_s)) return fmt::format("{:g} s", time_s);
  const auto tenths = static_cast<long long>(std::llround(std::abs(time_s) * 10));
  const long long seconds = tenths / 10, days = seconds / 86400;
  const bool has_days = longest_s >= kDay_s;
  std::string text = time_s < 0 ? "−" : "";
  if (has_days) text += fmt::format("{} d ", days);
  text += fmt::format(has_days ? "{:02}:{:02}:{:02}" : "{}:{:02}:{:02}", seconds / 3600 % 24,
                      seconds / 60 % 60, seconds % 60);
  return tenths % 10 == 0 ? text : fmt::format("{}.{}", text, tenths % 10);
}

std::optional<double> parseTime_s(const std::string& text) {
  if (const std::optional<double> seconds = parseQuantity(text, "s")) return seconds;
  static const std::regex form(
      R"( *(-|−|\+)?(?:(\d{1,6}) d )?(?:(\d{1,7}):)?(\d{1,9}):(\d\d(?:\.\d{1,9})?) *)");
  std::smatch parts;
  if (text.size() > 64 || !std::regex_match(text, parts, form)) return std::nullopt;
  const auto number = [&](int part) { return parts[part].matched ? std::stod(parts[part].str()) : 0.0; };
  const double days = number(2), hours = number(3), minutes = number(4), seconds = number(5);
  const bool has_hours = parts[3].matched, has_days = parts[2].matched;
  if (seconds >= 60 || (has_hours && minutes >= 60) || (has_days && (!has_hours || hours >= 24)))
    return std::nullopt;
  const double time_s = ((days * 24 + hours) * 60 + minutes) * 60 + seconds;
  return parts[1].matched && parts[1] != "+" ? -time_s : time_s;
}

}  // namespace emscape
