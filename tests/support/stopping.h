/// Stopping of work in the middle.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <thread>

#include "emscape/base/work.h"
#include "tests/support/sanitizers.h"

namespace emscape::test {

/// Time (ms) from the stop of some work to its end: the least of some tries,
/// because other programs may run. The work is stopped some time after its begin.
/// @return infinity if the work always ended before it was stopped
inline double stoppedWithin_ms(const std::function<void()>& work, double after_ms, int tries = 3) {
  using Clock = std::chrono::steady_clock;
  double best_ms = std::numeric_limits<double>::infinity();
  for (int n = 0; n < tries; ++n) {
    Work stoppable;
    std::atomic<bool> has_ended{false};
    Clock::time_point stopped_at;
    std::thread thread([&] {
      const WorkScope scope(&stoppable);
      try {
        work();
      } catch (const Stopped&) {
        best_ms =
            std::min(best_ms, std::chrono::duration<double, std::milli>(Clock::now() - stopped_at).count());
      }
      has_ended = true;
    });
    const Clock::time_point begin = Clock::now();
    while (!has_ended && Clock::now() - begin < std::chrono::duration<double, std::milli>(after_ms))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    stopped_at = Clock::now();
    stoppable.stop();
    thread.join();
  }
  return best_ms;
}

/// Expects that some work, stopped some time after its begin, ends within the second that
/// docs/command-line.md promises.
inline void expectStopsWithinASecond(const std::function<void()>& work, double after_ms) {
  const double ends_ms = stoppedWithin_ms(work, after_ms);
  if (!kIsSanitized) {
    EXPECT_LT(ends_ms, 1000);
  }
}

}  // namespace emscape::test
