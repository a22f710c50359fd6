/// The time of streams.
#pragma once

#include <chrono>
#include <cmath>
#include <string>

#include "base/text/utc.h"

namespace emscape::playback {

/// Seconds of a clock that only goes forwards.
inline double steadyTime_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// By this computer's clock, in s since 1970.
inline double unixTime_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// UTC, by this computer's clock, of a steadyTime_s() in the past: "2026-06-01T06:00:22Z".
inline std::string utcTextOf(double steady_s) {
  const double unix_s = unixTime_s() - (steadyTime_s() - steady_s);
  return utcText(static_cast<std::int64_t>(std::floor(unix_s)) * 1000).substr(0, 19) + "Z";
}

}  // namespace emscape::playback
