/// A time of a scenario as people write it: of its clock or in UTC.
#pragma once

#include <string>

#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/emitter.h"

namespace emscape::scenario {

/// Reads a time in one of the forms of emscape::parseTime_s() or, with an epoch, in UTC:
/// "2026-06-01T06:01:10Z", and the time of day "06:01", "06:01:10.5", also with " UTC" or "Z" behind it: the
/// first one from the beginning on. A text of both kinds, "1:15", is a time of the clock if that is allowed,
/// else UTC.
/// @return seconds, within `allowed`
/// @throws Error (bad_input) that names the forms, or the allowed times in seconds and in UTC
double parseTime_s(const std::string& text, const Clock& clock, const TimeInterval& allowed);

/// "2026-06-01T06:01:10Z", with a fraction only where it is not 0; empty as utcAt().
std::string shortUtcAt(const Clock& clock, double t_s);

}  // namespace emscape::scenario
