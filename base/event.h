/// An event on which one thread waits for others.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace emscape {

/// An auto-reset event: one thread waits, any thread may set it.
class Event {
 public:
  void set() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      set_ = true;
    }
    changed_.notify_one();
  }
  /// Waits until it is set; returns at once if it was set since the last wait.
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return set_; });
    set_ = false;
  }
  /// The same, at most until `time`.
  void waitUntil(std::chrono::steady_clock::time_point time) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, time, [this] { return set_; });
    set_ = false;
  }

  /// Reports the beginning of work that ends with finish(), so that a simulated clock knows whether work is
  /// in progress.
  void begin() { ++begun_; }
  /// set(), at the end of work.
  void finish() {
    --begun_;
    set();
  }
  bool hasWork() const { return begun_ > 0; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool set_ = false;
  std::atomic<int> begun_{0};
};

}  // namespace emscape
