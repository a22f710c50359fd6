/// Times as people read them.
#pragma once

#include <optional>
#include <string>

namespace emscape {

/// "12.5 s", "90 s"; from an hour on "1:30:00", from a day on "1 d 02:00:00", with tenths only where they are
/// not 0. @param span_s  the longest time it stands beside, which decides the form; 0: the time itself
std::string timeText(double time_s, double span_s = 0);

/// Reads a time in one of the forms of timeText(), in seconds without a unit, or in another unit: "12.5",
/// "1.5 min", "1:15" (minutes and seconds), "1:30:00.5", "1 d 02:00:00". Negative with a sign before it.
/// @return seconds; none for another text
std::optional<double> parseTime_s(const std::string& text);

}  // namespace emscape
