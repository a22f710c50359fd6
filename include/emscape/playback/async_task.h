/// One piece of work at a time on a thread of its own, and a bell that says when it is done.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace emscape::app {

/// Wakes the one thread that waits for several others.
class Bell {
 public:
  void ring() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      rung_ = true;
    }
    changed_.notify_one();
  }
  /// Returns when it was rung since the last wait, or at `until`.
  void wait(std::chrono::steady_clock::time_point until) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, until, [this] { return rung_; });
    rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool rung_ = false;
};

/// The owner starts work, asks whether it is done, and takes the result.
template <class Result>
class Background {
 public:
  /// @param bell  rung at the end of the work; outlives this
  explicit Background(Bell& bell) : bell_(bell) {}
  /// Waits for the end of the work.
  ~Background() {
    if (thread_.joinable()) thread_.join();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Only when the last result was taken.
  void start(std::function<Result()> work) {
    done_ = false;
    thread_ = std::thread([this, work = std::move(work)] {
      try {
        result_ = work();
      } catch (...) {
        failure_ = std::current_exception();
      }
      done_ = true;
      bell_.ring();
    });
  }
  /// Whether there is work that runs, or a result that was not taken.
  bool active() const { return thread_.joinable(); }
  bool done() const { return active() && done_; }
  /// Waits for the end. Rethrows what the work threw.
  Result take() {
    thread_.join();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    Result result = std::move(*result_);
    result_.reset();
    return result;
  }

 private:
  Bell& bell_;
  std::thread thread_;
  std::atomic<bool> done_{false};
  std::optional<Result> result_;
  std::exception_ptr failure_;
};

}  // namespace emscape::app
