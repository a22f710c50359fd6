/// Report of a real-time loop, as text and as JSON.
#pragma once

#include <string>

#include "playback/pictures/real_time_report.h"
#include "report/json.h"

namespace emscape::report {

using playback::RealTimeEvent;
using playback::RealTimeReport;

/// "1.240 s  BUSY  columns  540000 rays  field 22.1 ms  cast 38.2 ms ..."
std::string lineOf(const RealTimeEvent& event);
/// A summary in a few lines.
std::string summaryOf(const RealTimeReport& report);
/// Keys: frames_per_s {asked, held}, frames, due, late, dropped, patterns, restores {done, aborted}, settled,
/// settled_equal_full (null: not compared), abort_latency_ms {median, max} (null: none), ..., frames [...].
/// @param report  with its events
Json toJson(const RealTimeReport& report);

}  // namespace emscape::report
