/// The scenario's time line.
#pragma once

#include <string>
#include <vector>

namespace emscape::scenario {

struct Clock {
  std::string epoch_utc;  ///< ISO 8601 with Z; empty if the scenario has no epoch
  double duration_s = 0;
  double step_s = 1;
};

/// Limit of the times of a scenario, before and after the epoch (s): 31 years.
constexpr double kMaxTime_s = 1e9;

/// @throws Error (usage) if a time is not within kMaxTime_s of t = 0, or in UTC outside the years 0001 to
/// 9999
void requireTime(const Clock& clock, double t_s);
/// The times begin + i * step up to end, inclusive; no error accumulates. If begin and step are decimal
/// numbers of up to 12 digits, each time is the double nearest to the decimal number, as a user writes it.
/// @param limit_s  limit of begin and end, before and after t = 0
/// @throws Error (usage) if begin or end is not within the limit, end < begin, step <= 0, or there are more
/// than 10^7 times
std::vector<double> timesOf(double begin_s, double end_s, double step_s, double limit_s = kMaxTime_s);
/// All times of the clock: 0, step, ... duration.
std::vector<double> timesOf(const Clock& clock);
/// Parses "BEGIN:END:STEP", "BEGIN:END" (the clock's step) or "T": seconds ("90"), numbers with a unit ("1.5
/// min") or, with an epoch, UTC ("2026-06-01T06:01:10Z"). @param limit_s  as for timesOf()
/// @throws Error (usage), as timesOf() and requireTime() too
std::vector<double> parseTimes(const std::string& text, const Clock& clock, double limit_s = kMaxTime_s);
/// A single time as parseTimes(), or M:SS, H:MM:SS. @throws Error (usage)
double parseTime(const std::string& text, const Clock& clock);
/// A warning about times before or after those of the clock; empty: there are none.
/// @param times_s  ascending
std::string outsideClockText(const std::vector<double>& times_s, const Clock& clock);
/// ISO 8601 time (UTC, milliseconds) at t_s; empty without an epoch, and at times that requireTime() refuses.
/// @throws Error (bad_input) if the epoch is not a valid time
std::string utcAt(const Clock& clock, double t_s);

}  // namespace emscape::scenario
