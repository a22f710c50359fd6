#include "playback/pictures/clock.h"

#include <algorithm>

#include "base/event.h"

namespace emscape::playback {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

}  // namespace

SystemClock::SystemClock() : start_(std::chrono::steady_clock::now()) {}

double SystemClock::now_ms() const {
  return Milliseconds(std::chrono::steady_clock::now() - start_).count();
}

void SystemClock::waitUntil(double time_ms, Event& event) {
  constexpr double kForever_ms = 1e12;  // 30 years, for which the steady clock does not overflow
  const Milliseconds until(std::min(time_ms, kForever_ms));
  event.waitUntil(start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(until));
}

}  // namespace emscape::playback
