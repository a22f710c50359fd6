/// Wall-clock time of pieces of work.
#pragma once

#include <chrono>

namespace emscape {

class Stopwatch {
 public:
  /// Returns the milliseconds since the start or the last lap, and begins a new lap.
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - begin_).count();
    begin_ = now;
    return elapsed;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace emscape
