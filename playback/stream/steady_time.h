/// The time of streams.
#pragma once

#include <chrono>

namespace emscape::playback {

/// Seconds of a clock that only goes forwards.
inline double steadyTime_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace emscape::playback
