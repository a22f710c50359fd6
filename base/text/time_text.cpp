#include "base/text/time_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace emscape
