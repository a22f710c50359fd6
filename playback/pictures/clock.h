/// An abstract clock for playback, so that tests can use simulated time.
#pragma once

#include <chrono>

namespace emscape {
class Event;
}

namespace emscape::playback {

/// Threads may share a clock.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Milliseconds since any fixed instant; does not go back.
  virtual double now_ms() const = 0;
  /// Returns at `time_ms`, or as soon as `event` is set; the event is then reset.
  virtual void waitUntil(double time_ms, Event& event) = 0;
};

/// The machine's steady clock, from 0 at construction.
class SystemClock : public Clock {
 public:
  SystemClock();
  double now_ms() const override;
  void waitUntil(double time_ms, Event& event) override;

 private:
  const std::chrono::steady_clock::time_point start_;
};

}  // namespace emscape::playback
